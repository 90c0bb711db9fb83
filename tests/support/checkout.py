"""A copy of the project, as a fresh checkout has it."""

import subprocess
from pathlib import Path

from wheelfmu.fmu.paths import ROOT


def copy_checkout(place: Path) -> None:
    """The files of the project, without anything that is built or installed."""
    copy = 'git ls-files -coz --exclude-standard | xargs -0 cp --parents -t "$0"'
    subprocess.run(["bash", "-c", copy, place], cwd=ROOT, check=False)  # a file may be deleted
