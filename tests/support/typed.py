"""What a user types after a command, as its reader takes it; for the tests of every folder's commands."""

import os
import subprocess
import sys
from pathlib import Path

from wheelfmu.fmu.paths import ROOT

# By the standard library alone; nothing is installed or carried out.
READ = f"import sys; sys.path[:0] = {[str(ROOT / 'tools'), str(ROOT)]}; from wheelfmu.__main__ import needs; "
READS = [sys.executable, "-S", "-B", "-P", "-c", READ + "needs(*sys.argv[1:])"]


def asked(folder: Path, line: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """What the command's reader, by the standard library alone, makes of a line."""
    how = {"cwd": folder, "env": os.environ | environment, "capture_output": True, "text": True}
    return subprocess.run([*READS, *line.split()], **how)


def check_refused(folder: Path, line: str, words: str) -> None:
    """In one sentence with these words, with status 2; no file is touched."""
    before = {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    done = asked(folder, line)
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    assert words in done.stderr and done.stderr.count("\n") == 1, done.stderr
    assert {path: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before


def check_taken(folder: Path, line: str) -> None:
    done = asked(folder, line, PYTHONOPTIMIZE="2")
    assert (done.returncode, done.stderr) == (0, "")
