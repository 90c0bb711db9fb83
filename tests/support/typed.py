"""What a user types after a command, as its reader takes it; for the tests of every folder's commands."""

import os
import subprocess
import sys
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from types import MappingProxyType

import pytest

from wheelfmu.fmu.paths import ROOT

# By the standard library alone; nothing is installed or carried out.
READ = f"import sys; sys.path[:0] = {[str(ROOT / 'tools'), str(ROOT)]}; from wheelfmu.__main__ import needs; "
READS = [sys.executable, "-S", "-B", "-P", "-c", READ + "needs(*sys.argv[1:])"]


def asked(folder: Path, line: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """What the command's reader, by the standard library alone, makes of a line."""
    how = {"cwd": folder, "env": os.environ | environment, "capture_output": True, "text": True}
    return subprocess.run([*READS, *line.split()], **how)


def typing_tests(
    refused: Mapping[str, str], taken: Collection[str], files: Mapping[str, str] = MappingProxyType({})
) -> tuple[Callable[..., None], Callable[..., None]]:
    """The two tests of what is typed, in a folder with these files. refused: lines, and words of the sentence."""

    def filled(folder: Path) -> dict[Path, bytes]:
        for name, text in files.items():
            (folder / name).write_text(text)
        return contents(folder)

    def contents(folder: Path) -> dict[Path, bytes]:
        return {path: path.read_bytes() for path in folder.iterdir() if path.is_file()}

    @pytest.mark.parametrize(("line", "words"), refused.items())
    def a_fault_is_refused(tmp_path: Path, line: str, words: str) -> None:
        """In one sentence with these words, with status 2; no file is touched."""
        before, done = filled(tmp_path), asked(tmp_path, line)
        assert (done.returncode, done.stdout) == (2, ""), done.stderr
        assert words in done.stderr and done.stderr.count("\n") == 1, done.stderr
        assert contents(tmp_path) == before

    @pytest.mark.parametrize("line", taken)
    def what_is_meant_is_taken(tmp_path: Path, line: str) -> None:
        filled(tmp_path)
        done = asked(tmp_path, line, PYTHONOPTIMIZE="2")
        assert (done.returncode, done.stderr) == (0, "")

    return a_fault_is_refused, what_is_meant_is_taken
