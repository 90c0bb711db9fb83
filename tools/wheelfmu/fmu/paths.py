"""Where the project and its build are."""

import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def build_folder() -> Path:
    """The build under test: WHEEL_BUILD, or that of the preset release."""
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release"))


def copy_checkout(place: Path) -> None:
    """The files of the project, without anything that is built or installed."""
    copy = 'git ls-files -coz --exclude-standard | xargs -0 cp --parents -t "$0"'
    subprocess.run(["bash", "-c", copy, place], cwd=ROOT, check=False)  # a file may be deleted
