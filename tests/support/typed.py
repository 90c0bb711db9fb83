"""What a user types after a command, as its reader takes it; for the tests of every folder's commands."""

import os
import subprocess
import sys
from pathlib import Path

from wheelfmu.fmu.paths import ROOT


def asked(folder: Path, line: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """What the command's reader, by the standard library alone, makes of a line."""
    reads = [sys.executable, "-S", "-B", str(ROOT / "tools"), *line.split()]
    return subprocess.run(reads, cwd=folder, env=os.environ | environment, capture_output=True, text=True)


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
