"""./scripts/variables in a small checkout, where a stand-in builds: it writes all numbers and tables, or nothing."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from support.paths import ROOT, build_folder

KEPT = ("scripts/variables", "scripts/help", "cmake/description", "tools/publishing", "tools/diagrams")
KEPT += ("examples/python", "docs/results/data")
PAGES = ("docs/variables.md", "fmu-src/archive/documentation/index.html")
DESCRIPTION = (ROOT / "modelDescription.xml").read_text(encoding="utf-8")
# A variable without its number, as if it were new; unknowns without dependencies; another GUID.
STALE = re.sub(r'(name="mu_max") valueReference="\d+"', r"\1", DESCRIPTION)
STALE = re.sub(r'(index="\d+") dependencies="[\d ]*"', r"\1", STALE).replace('guid="{', 'guid="{0')
TABLE = re.compile(r"<!-- variables -->.*<!-- end of variables -->", re.DOTALL)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """With a description and two pages that are stale; what builds puts the built FMU where it belongs."""
    for name in (*KEPT, *PAGES):
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        copy(ROOT / name, tmp_path / name)
    (tmp_path / "modelDescription.xml").write_text(STALE, encoding="utf-8")
    for name in PAGES:
        text = (tmp_path / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(TABLE.sub("<!-- variables --><!-- end of variables -->", text), encoding="utf-8")
    stand_in(tmp_path / "scripts" / "setup", "")
    fmu = shlex.quote(str(build_folder() / "wheel.fmu"))
    stand_in(tmp_path / "scripts" / "build", f"mkdir -p build/release && cp {fmu} build/release")
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    return tmp_path


def stand_in(path: Path, does: str) -> None:
    path.write_text(f"#!/bin/sh\n{does}\n", encoding="utf-8")
    path.chmod(0o755)


def texts(place: Path) -> dict[str, str]:
    return {name: (place / name).read_text(encoding="utf-8") for name in ("modelDescription.xml", *PAGES)}


def variables(place: Path, *words: str) -> int:
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    command = ["bash", place / "scripts" / "variables", *words]
    return subprocess.run(command, cwd=place, env=environment, capture_output=True, check=False).returncode


def test_numbers_dependencies_and_tables_are_written(checkout: Path) -> None:
    assert variables(checkout, "--check") != 0 == variables(checkout)
    assert texts(checkout) == texts(ROOT)
    assert variables(checkout, "--check") == 0


def no_library(place: Path) -> None:
    stand_in(place / "scripts" / "build", "exit 1")


def no_second_library(place: Path) -> None:
    build = place / "scripts" / "build"
    stand_in(build, f"! [ -e build ] || exit 1; {build.read_text(encoding='utf-8').splitlines()[1]}")


def no_fmu(place: Path) -> None:
    stand_in(place / "scripts" / "build", "")


@pytest.mark.parametrize("fault", [no_library, no_second_library, no_fmu])
def test_where_a_step_fails_nothing_is_written(checkout: Path, fault) -> None:
    before = texts(checkout)
    fault(checkout)
    assert variables(checkout) != 0
    assert texts(checkout) == before
