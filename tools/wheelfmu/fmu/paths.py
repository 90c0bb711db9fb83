"""Where the project and its build are."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
LAB = sorted(path.parent.name for path in (ROOT / "lab").glob("*/commands"))  # its folders that have commands


def build_folder() -> Path:
    """The build under test: WHEEL_BUILD, or that of the preset release."""
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release"))
