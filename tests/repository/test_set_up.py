"""What stands in the way of a set-up has one sentence, and what may be deleted is not needed."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from support.checkout import copy_checkout


def refused(command: list[str | Path], folder: Path, **variables: str) -> str:
    """The only line that a command prints before it fails."""
    done = subprocess.run(command, cwd=folder, env=os.environ | variables, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and not done.stdout and done.stderr.count("\n") == 1, done
    return done.stderr


def test_an_older_python_is_named(checkout: Path, tmp_path: Path) -> None:
    old = tmp_path / "python3"
    old.write_text('#!/bin/sh\n[ "$1" = --version ] && echo Python 3.10.12 && exit\nexit 1\n')
    old.chmod(0o755)
    said = refused(["bash", "scripts/run"], checkout, PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert said.startswith("run: Python 3.11 or later is needed; Python 3.10.12 is the first")


def test_an_environment_that_does_not_fit_is_refused_and_keeps_its_files(checkout: Path, tmp_path: Path) -> None:
    """Of another Python, of another place, a link to somebody's folder: none is emptied."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "venv"], check=True)
    (tmp_path / "venv" / "bin" / "pip").touch()
    (checkout / ".venv").symlink_to(tmp_path / "venv")
    python = f"Python {sys.version_info.major}.{sys.version_info.minor}"
    for made in (f"{checkout} Python 3.10.12", f"/elsewhere {python}"):
        (tmp_path / "venv" / "place").write_text(made)
        said = refused(["bash", "scripts/run"], checkout)
        assert said == (
            f"run: .venv was made for {made}, and this is {checkout} {python}. "
            "Delete it (rm -r .venv), and the next command makes it anew.\n"
        )
    (tmp_path / "venv" / "bin" / "python").unlink()
    assert refused(["bash", "scripts/run"], checkout).startswith("run: .venv has no Python that runs. Delete it (rm -r")
    (checkout / ".venv").unlink()
    assert (tmp_path / "venv" / "place").exists()


def test_a_place_that_cannot_be_written_is_named(checkout: Path) -> None:
    shutil.rmtree(checkout / "build", ignore_errors=True)
    (checkout / "build").touch()
    said = refused(["bash", "scripts/run"], checkout)
    (checkout / "build").unlink()
    assert said == f"run: {checkout / 'build'}: File exists.\n"


def test_pip_alone_installs_the_lock_file_where_uv_cannot_be_installed(tmp_path: Path) -> None:
    """Partner: the second set-up would fail, were anything installed again, though another Python comes first in PATH.
    The third finds what a killed one leaves: a package without its end."""
    copy, constraint = tmp_path / "copy", tmp_path / "no_uv.txt"
    copy.mkdir()
    copy_checkout(copy)
    lock = copy / "requirements.lock"
    lock.write_text("".join(re.findall(r"^(?:psutil|tabulate|uv)==.*\n(?: .*\n)+", lock.read_text(), re.MULTILINE)))
    constraint.write_text("uv<0\n")
    other = tmp_path / "bin" / "python3"
    other.parent.mkdir()
    other.write_text("#!/bin/sh\necho Python 3.10.12\nexit 1\n")
    other.chmod(0o755)

    def set_up(**more: str) -> str:
        environment = os.environ | {"PIP_CONSTRAINT": str(constraint)} | more
        done = subprocess.run(["bash", "scripts/setup"], cwd=copy, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    later = {"PIP_NO_INDEX": "1", "PATH": f"{other.parent}:{os.environ['PATH']}"}
    assert (set_up(), set_up(**later)) == ("Installing Python packages into .venv\n", "")
    programs = {path.name for path in (copy / ".venv" / "bin").iterdir()}
    assert "tabulate" in programs and "uv" not in programs
    packages = "lib/*/site-packages"
    for left in ("installed.lock", f"{packages}/tabulate-*/INSTALLER", f"{packages}/tabulate/__init__.py"):
        (path,) = (copy / ".venv").glob(left)
        path.unlink()
    set_up()
    assert path.exists()


def test_lint_without_git_is_refused(checkout: Path) -> None:
    lines = "from pathlib import Path", "from wheelfmu.commands import lint"
    program = "\n".join([*lines, f"lint.ROOT = Path({str(checkout)!r})", "lint.main(None)"])
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.stderr.rstrip().endswith("the files are those that git knows, and this folder is not a git checkout.")


DELETABLE = {
    "examples/importer": (),
    "lab/lesson": ("figures", "page", "view"),
    "lab/notebook": ("notebook",),
    "lab/reports": ("report",),
    "lab/site": ("site",),
    "lab/studies": ("study",),
    "lab/vehicles": ("example",),
    "lab": ("example", "figures", "notebook", "page", "report", "site", "study", "view"),
}


# Names the commands whose help fails. Each has a process, which has the standard library from this one.
HELP_OF_ALL = """
import argparse, json, os, runpy, secrets, shutil, subprocess, sys, tempfile, tomllib
for name in sys.argv[1:]:
    if not (child := os.fork()):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(1, 2)
        sys.argv = ["tools", name, "--help"]
        runpy.run_path("tools", run_name="__main__")
        os._exit(1)  # help ends the program
    if os.waitpid(child, 0)[1]:
        print(name, flush=True)
"""


@pytest.mark.parametrize("folder", DELETABLE)
def test_a_folder_that_can_be_deleted_is_needed_by_its_own_commands_alone(tmp_path: Path, folder: str) -> None:
    copy_checkout(tmp_path)
    shutil.rmtree(tmp_path / folder)
    names = sorted(path.name for path in (tmp_path / "scripts").iterdir())
    command = [sys.executable, "-S", "-c", HELP_OF_ALL, *names]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    assert {*done.stdout.split()} == {*DELETABLE[folder]}
