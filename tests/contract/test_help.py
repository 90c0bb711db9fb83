"""Every command under scripts/ explains itself with --help, at once, in a checkout where nothing is installed."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from support.paths import ROOT

SHELL = "#!/usr/bin/env bash\n"
COMMANDS = sorted(p.name for p in (ROOT / "scripts").iterdir() if p.is_file() and p.read_text().startswith(SHELL))


@pytest.fixture
def bare(tmp_path: Path) -> Path:
    """The commands, what `run` lists its values with, and the description; nothing else."""
    for folder in ("scripts", "diagrams"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "modelDescription.xml", tmp_path)
    return tmp_path


def files(folder: Path) -> set[Path]:
    return {p for p in folder.rglob("*") if "__pycache__" not in p.parts}


@pytest.mark.parametrize("option", ["--help", "-h"])
@pytest.mark.parametrize("name", COMMANDS)
def test_help_tells_what_a_command_does_and_does_nothing(bare: Path, name: str, option: str) -> None:
    before = files(bare)
    done = subprocess.run([bare / "scripts" / name, option], cwd=bare, capture_output=True, text=True, timeout=20)
    assert done.returncode == 0 and not done.stderr
    assert len(done.stdout.split()) >= 10
    assert files(bare) == before


def test_the_commands_are_those_that_newcomers_are_told_of() -> None:
    assert {"run", "test", "build", "setup", "lint", "release", "report", "example", "study", "view"} <= set(COMMANDS)
