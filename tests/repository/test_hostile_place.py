"""The commands in a hostile place: a folder of any name, the user's modules in it, variables that mean something else
elsewhere, a checkout by Git for Windows, without execute bits. No paper equation."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from support.checkout import copy_checkout

from wheelfmu.fmu.paths import ROOT
from wheelfmu.release.compiling import compiler

pytestmark = pytest.mark.xdist_group("hostile place")
NAME = "it's (1) [x] & $y"
MODULES = ("numpy", "random", "select", "study")  # of a package, of the standard library, of a user's study
VARIABLES = {
    **dict.fromkeys(("part", "takes", "reads", "stays", "needs"), "absent"),
    "CDPATH": "/tmp",
    "CMAKE_GENERATOR": "Ninja Multi-Config",
    "CMAKE_BUILD_TYPE": "Debug",
    "MPLBACKEND": "module://matplotlib_inline.backend_inline",  # of a notebook
    "PYTHONOPTIMIZE": "2",
    "PYTHONPATH": ".",  # of ROS or `module load`: another numpy
}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A clone with the settings of Git for Windows, and in it the user's modules."""
    copy, clone = tmp_path_factory.mktemp("copy"), tmp_path_factory.mktemp("hostile") / NAME
    copy_checkout(copy)
    git = ["git", "-c", "user.name=a", "-c", "user.email=a@b", "-c", "core.autocrlf=true"]
    for words in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "all"], ["clone", "-q", ".", clone]):
        subprocess.run([*git, *words], cwd=copy, check=True)
    for file in clone.rglob("*"):
        if file.is_file():
            file.chmod(0o644)
    for name in MODULES:
        (clone / f"{name}.py").write_text(f'raise SystemExit("{name}.py of the user was run")\n', encoding="utf-8")
    if (ROOT / "build" / "sundials").exists():  # else it is fetched
        shutil.copytree(ROOT / "build" / "sundials", clone / "build" / "sundials")
    return clone


def ran(place: Path, *words: str | Path, status: int = 0, **variables: str) -> str:
    """What a program in the place prints."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("PYTEST_", "WHEEL_BUILD"))}
    how = {"cwd": place, "env": kept | VARIABLES | variables, "capture_output": True, "text": True}
    done = subprocess.run(words, **how, check=False)
    said = done.stdout + done.stderr
    assert done.returncode == status, said[-5000:]
    assert "Debian packages" not in said
    return said


def door(place: Path, name: str, *words: str, **how) -> str:
    return ran(place, "bash", f"scripts/{name}", *words, **how)


def test_a_build_is_what_its_preset_says(place: Path) -> None:
    # as the tests build it, to which the folder then stays
    assert "Built preset release." in door(place, "build", "release", "-DCMAKE_COMPILE_WARNING_AS_ERROR=ON")
    cache = (place / "build" / "release" / "CMakeCache.txt").read_text(encoding="utf-8")
    assert "CMAKE_BUILD_TYPE:STRING=Release\n" in cache and "CMAKE_GENERATOR:INTERNAL=Unix Makefiles\n" in cache
    assert "-ffast-math" in door(place, "build", "dev", status=1, CXXFLAGS="-ffast-math")


def test_a_run_simulates_and_draws(place: Path) -> None:
    """With other words: tests/diagrams/test_start_values.py."""
    said = door(place, "run")
    assert "wheel.fmu is ready." in said and " computing time " in said
    assert {"free.csv", "friction.csv", "wheel.html", "fig_6.png"} <= {x.name for x in (place / "results").iterdir()}


def test_a_study_runs_that_of_a_file_too(place: Path) -> None:
    assert "2 reached" in door(place, "study", "--vary", "s=0,0.03", "--stop-time", "0.1", "--out", "two.zarr")
    mine = 'from lab.studies import Study\n\nstudy = Study(grid={"s": [0.01]}, stop_time=0.1)\n'
    (place / "study.py").write_text(mine, encoding="utf-8")
    assert "1 reached" in door(place, "study", "study.py", "--out", "mine.zarr")


def test_an_example_is_built_and_run(place: Path) -> None:
    assert "lateral force of the front axle" in door(place, "example", "car", "step")
    assert "CMAKE_BUILD_TYPE:STRING=Release\n" in (place / "build" / "examples" / "CMakeCache.txt").read_text()


def test_the_lesson_is_compiled(place: Path) -> None:
    """With zig's own libraries where the tests of the lesson have them compiled."""
    door(place, "page", ZIG_LIB_DIR=str(compiler() / "lib"))
    assert (place / "results" / "wheel_lesson.html").stat().st_size > 1e6


def test_the_quick_tests_pass_and_a_direct_one_tests_the_sources_as_they_are(place: Path) -> None:
    one = "test_the_communication_grid_changes_no_bit"
    plain = "--assert=plain"  # for one test the assertions of all are not rewritten
    assert " passed" in door(place, "test", "quick", PYTEST_ADDOPTS=f"-k {one} {plain}")
    with (place / "fmu-src" / "wheel" / "setup.cpp").open("a", encoding="utf-8") as source:
        source.write("#error a change that does not compile\n")
    pytest = ("-P", "-m", "pytest", "tests/contract/test_stepping.py", "-k", one)
    python = place / ".venv" / "bin" / "python"  # not through a command, which alone ignores PYTHONPATH
    assert "a change that does not compile" in ran(place, python, *pytest, status=1, PYTHONPATH="")
