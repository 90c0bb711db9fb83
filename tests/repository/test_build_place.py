"""The build takes what a system has, and refuses what would change results: options of the compiler by what they do,
cargo and Eigen of any age that serves. No paper equation."""

import os
import shutil
import subprocess
from itertools import pairwise
from pathlib import Path

import pytest

from wheelfmu.fmu.paths import ROOT

CRATE = "sundials-sys-0.6.2"


def configured(place: Path, text: str, *options: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """A project of these lines."""
    lines = ["cmake_minimum_required(VERSION 3.25)", "project(place C CXX)", text]
    place.mkdir(exist_ok=True)
    (place / "CMakeLists.txt").write_text("\n".join(lines))
    words = [
        "cmake",
        "-G",
        "Unix Makefiles",
        "-S",
        place,
        "-B",
        place / "build",
        "-DCMAKE_BUILD_TYPE=Release",
        *options,
    ]
    return subprocess.run(words, env=os.environ | variables, capture_output=True, text=True, check=False)


REFUSED = ("-ffast-math", "-funsafe-math-optimizations", "-fassociative-math -fno-signed-zeros -fno-trapping-math")
REFUSED += ("-freciprocal-math", "-ffinite-math-only", "-fno-signed-zeros")
TAKEN = ("", "-O2 -fno-math-errno", "-ffp-contract=fast")  # the last is set back by the project's own


@pytest.mark.parametrize("flags", [*REFUSED, *TAKEN])
@pytest.mark.parametrize("variable", ["CFLAGS", "CXXFLAGS"])
def test_options_that_break_ieee_754_are_refused_by_their_effect(tmp_path: Path, variable: str, flags: str) -> None:
    done = configured(tmp_path / "place", f'include("{ROOT}/cmake/arithmetic.cmake")', **{variable: flags})
    assert (done.returncode != 0) == (flags in REFUSED), done.stderr
    assert (" ".join(flags.split()[:1]) in done.stderr and "bit-identical" in done.stderr) or flags in TAKEN


def test_cargo_fetches_sundials_by_no_other_word_than_fetch(tmp_path: Path) -> None:
    """As cargo of any age does; `cargo info` came with version 1.82."""
    cargo = shutil.which("cargo")
    if not cargo:
        pytest.skip("cargo is not here: SUNDIALS has been given or fetched.")
    old = tmp_path / "cargo"
    old.write_text(
        f'#!/bin/sh\n[ "$1" = fetch ] && exec {cargo} "$@"\necho "error: no such subcommand: $1"\nexit 101\n'
    )
    old.chmod(0o755)
    text = f'include("{ROOT}/cmake/patterns.cmake")\ninclude("{ROOT}/cmake/sundials.cmake")\nfetch_sundials(found)'
    done = configured(tmp_path / "place", text, f"-DCARGO={old}")
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.glob(f"place/**/{CRATE}/vendor")] == ["vendor"]


EIGEN = """
set(Eigen3_VERSION {version})
if(NOT TARGET Eigen3::Eigen)
  add_library(Eigen3::Eigen INTERFACE IMPORTED)
endif()
"""


@pytest.mark.parametrize(("version", "taken"), [("3.3.9", False), ("3.4.0", True), ("5.0.1", True)])
def test_eigen_is_taken_from_3_4_on(tmp_path: Path, version: str, taken: bool) -> None:
    (tmp_path / "Eigen3Config.cmake").write_text(EIGEN.format(version=version))
    same_major = (
        f'if(PACKAGE_FIND_VERSION_MAJOR STREQUAL "{version[0]}")\n  set(PACKAGE_VERSION_COMPATIBLE TRUE)\nendif()\n'
    )
    (tmp_path / "Eigen3ConfigVersion.cmake").write_text(f"set(PACKAGE_VERSION {version})\n{same_major}")
    lines = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8").split("find_package(Eigen3", 1)[1].split("\n\n")[0]
    done = configured(tmp_path / "place", f"find_package(Eigen3{lines}", f"-DEigen3_DIR={tmp_path}")
    assert (done.returncode == 0) == taken, done.stderr
    assert taken or f"has {version}." in " ".join(done.stderr.split())


def makers(build: Path) -> dict[str, set[str]]:
    """By file that a rule of the build makes: the targets that have the rule."""
    found: dict[str, set[str]] = {}
    for rules in build.glob("CMakeFiles/*.dir/build.make"):
        lines = rules.read_text(encoding="utf-8").splitlines()
        for line, recipe in pairwise(lines):
            if ": " in line and recipe.startswith("\t"):
                found.setdefault(line.split(": ")[0], set()).add(rules.parent.stem)
    return found


@pytest.mark.parametrize(
    ("source", "made"), [(ROOT, "wheel.fmu"), (ROOT / "examples" / "vehicles", "car.ssp")], ids=["wheel", "examples"]
)
def test_one_target_makes_each_file(tmp_path: Path, source: Path, made: str, fmu_path: Path) -> None:
    """`make -j` would make one twice at once where two targets have its rule. Where one waits for the other, CMake
    leaves the rule to one."""
    words = ["cmake", "-G", "Unix Makefiles", "-S", source, "-B", tmp_path, "-D", f"WHEEL={fmu_path}"]
    subprocess.run(words, check=True, capture_output=True)
    files = makers(tmp_path)
    assert made in files and {file: by for file, by in files.items() if len(by) > 1} == {}
