"""Where the project and its build are."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def build_folder() -> Path:
    """The build under test: WHEEL_BUILD, or that of the preset release."""
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release"))
