"""The release: notes of the version; the bill of materials."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path

import fmpy
import pytest

from wheelfmu.fmu.paths import ROOT
from wheelfmu.release import folder

CHANGES = "# Changes\n\nWords.\n\n## 2.1.0, 2026-12-01\n\n- New.\n\n## 2.0.0\n\n- Old.\n"


def test_the_files_name_one_version_which_is_that_of_the_newest_changes() -> None:
    assert folder.notes(CHANGES, "2.1.0") == ("# wheel.fmu 2.1.0\n\n- New.\n", False)
    assert folder.notes(CHANGES.replace("2.1.0, 2026-12-01", "Unreleased"), "2.1.0")[1]
    with pytest.raises(SystemExit, match="not with one of version 3"):
        folder.notes(CHANGES, "3.0.0")
    assert folder.notes((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), folder.version())[0].count("\n- ") > 0


BILL = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref" / "sbom.cdx.json"
# Where the build has each version from. CMake finds Eigen in Eigen3_DIR, or as Debian has it.
EIGEN = Path(os.environ.get("Eigen3_DIR", "/usr/share/eigen3/cmake"), "../../../include/eigen3/Eigen/src/Core/util")  # noqa: SIM112
PINS = {
    "wheel.fmu": (ROOT / "CMakeLists.txt", r"^project\(wheel VERSION ([\d.]+)"),
    "sundials": (ROOT / "cmake" / "sundials.cmake", r"^# CVODE ([\d.]+) from source"),
    "eigen": (EIGEN.resolve() / "Macros.h", r"^#define EIGEN_(?:WORLD|MAJOR|MINOR)_VERSION (\d+)"),
    "fmi-headers": (Path(fmpy.__file__).parent / "c-code" / "fmi2Functions.h", r"FMI (2[\d.]+\d) "),
    "newlib": (ROOT / "cmake" / "libm.cmake", r"# (\d[\d.]+), Debian 12"),
    "ziglang": (ROOT / "pyproject.toml", r'"ziglang==([\d.]+)"'),
}


def test_the_bill_of_materials_has_the_versions_of_the_build_throughout() -> None:
    text = BILL.read_text(encoding="utf-8")
    pins = {name: ".".join(re.findall(of, file.read_text(), re.MULTILINE)) for name, (file, of) in PINS.items()}
    assert {*re.findall(r"pkg:generic/([\w.-]+)@([\d.]+)", text)} == {*pins.items()}
    bill = json.loads(text)
    for part in (*bill["components"], bill["metadata"]["component"]):
        assert part["purl"] == part["bom-ref"] and part["purl"].endswith(f"@{part['version']}")
