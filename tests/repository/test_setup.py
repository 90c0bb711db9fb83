"""Set-up on a machine that lacks everything, and beside another set-up. `.ci/run` tries it on empty machines."""

import fcntl
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from support.paths import ROOT

SETUP = (ROOT / "scripts" / "setup").read_text()


@pytest.fixture
def bare_path(tmp_path: Path) -> Path:
    """A PATH with what every Debian has and nothing else, of a user without root."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for tool in ("bash", "basename", "dirname", "env", "flock", "grep", "mkdir", "nproc", "sed", "test", "tr", "uname"):
        (folder / tool).symlink_to(shutil.which(tool))
    (folder / "id").write_text("#!/bin/sh\necho 1000\n")
    (folder / "id").chmod(0o755)
    return folder


def checkout(place: Path) -> Path:
    """The scripts alone, with one small Python package."""
    for name in ("scripts", "cmake"):
        shutil.copytree(ROOT / name, place / name)
    (place / "tools" / "page").mkdir(parents=True)
    shutil.copy(ROOT / "CMakePresets.json", place)
    uv = re.search(r'"uv==.*"', (ROOT / "pyproject.toml").read_text())[0]
    (place / "pyproject.toml").write_text(f'[dependency-groups]\ninstaller = [{uv}]\ncore = ["pip"]\npage = ["pip"]\n')
    return place


def start(place: Path, command: str, path: Path | str) -> subprocess.Popen:
    environment = {"PATH": str(path), "WHEEL_SUNDIALS_SOURCE": "", "HOME": os.environ.get("HOME", "/")}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(["bash", "scripts/" + command], cwd=place, env=environment, text=True, **pipes)


def listed(text: str) -> list[str]:
    (line,) = re.findall(r"^ *sudo apt-get update && sudo apt-get install --no-install-recommends (.*)$", text, re.M)
    return line.split()


def test_a_user_without_root_gets_one_list_of_every_package_that_both_commands_need(tmp_path, bare_path):
    place = checkout(tmp_path / "checkout")
    said = {}
    for name in ("run", "test"):
        process = start(place, name, bare_path)
        said[name] = process.communicate(timeout=60)[1]
        assert process.returncode == 1
    assert said["run"] == said["test"]
    asked = set(re.findall(r"\bneed ([a-z][\w+.-]*)", SETUP)) | {"make", "cmake", "git"}
    of_release = set(re.findall(r"\bneed (\S+)", SETUP.split("release) #")[1].split(";;")[0]))
    files = {"ca-certificates", "libeigen3-dev", "newlib-source"}  # looked up by their files, which may be here
    packages = listed(said["run"])
    assert len(packages) == len(set(packages))
    assert asked - of_release - files <= set(packages) <= asked - of_release
    assert len(of_release) == 3 and len(packages) >= 9  # the partner: both sets hold something


def test_a_second_set_up_waits_for_the_first(tmp_path):
    place = checkout(tmp_path / "checkout")
    (place / "build" / "sundials").mkdir(parents=True)
    crate = re.search(r"set\(sundials_crate (.*)\)", (place / "cmake" / "sundials.cmake").read_text())[1]
    (place / "build" / "sundials" / crate).mkdir()
    with (place / "build" / "setup.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        both = [start(place, "setup", os.environ["PATH"]) for _ in range(2)]
        for process in both:
            assert process.stderr.readline() == "Waiting for another process: setup.\n"
            assert process.poll() is None
        assert not (place / ".venv").exists()
    for process in both:
        assert process.communicate(timeout=200)[1] == "" and process.returncode == 0
    assert (
        subprocess.run([place / ".venv" / "bin" / "pip", "--version"], capture_output=True, check=False).returncode == 0
    )
