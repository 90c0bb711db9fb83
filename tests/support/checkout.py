"""A copy of the project, as a fresh checkout has it; and the reader of what is typed behind a command."""

import subprocess
import sys
from pathlib import Path

from wheelfmu.fmu.paths import ROOT

# By the standard library alone; nothing is installed or carried out.
READ = f"import sys; sys.path[:0] = {[str(ROOT / 'tools'), str(ROOT)]}; from wheelfmu.__main__ import needs; "
READS = [sys.executable, "-S", "-B", "-P", "-c", READ + "needs(*sys.argv[1:])"]


def copy_checkout(place: Path) -> None:
    """The files of the project, without anything that is built or installed."""
    copy = 'git ls-files -coz --exclude-standard | xargs -0 cp --parents -t "$0"'
    subprocess.run(["bash", "-c", copy, place], cwd=ROOT, check=False)  # a file may be deleted
