"""Prints the software bill of materials of wheel.fmu (CycloneDX): what is linked in, or gave headers.

.venv/bin/python tools/release/sbom.py >fmu-src/archive/extra/org.fmi-standard.fmi-ls-ref/sbom.cdx.json
A test makes it again and compares. Every version is read where the build has it from: the pins, or the headers
themselves.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

import fmpy
from jinja2 import Template

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref" / "sbom.cdx.json"
TEMPLATE = Path(__file__).parent / "templates" / "sbom.cdx.json.j2"
# CMake finds Eigen in Eigen3_DIR, PREFIX/share/eigen3/cmake, or as Debian has it.
EIGEN = "../../../include/eigen3/Eigen/src/Core/util/Macros.h"


def found(file: str | Path, pattern: str) -> str:
    """A version, or its parts, where the build has it from; `file` is in this project unless it is absolute."""
    parts = re.findall(pattern, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    if not parts:
        raise ValueError(f"{file} holds no {pattern}.")
    return ".".join(parts)


def bill() -> str:
    eigen = Path(os.environ.get("Eigen3_DIR", "/usr/share/eigen3/cmake"), EIGEN)  # noqa: SIM112 (CMake names it so)
    versions = {
        "wheel": found("CMakeLists.txt", r"^project\(wheel VERSION ([\d.]+)"),
        "sundials": found("cmake/sundials.cmake", r"a SUNDIALS ([\d.]+) source tree"),
        "eigen": found(os.path.normpath(eigen), r"^#define EIGEN_(?:WORLD|MAJOR|MINOR)_VERSION (\d+)"),
        "fmi_headers": found(Path(fmpy.__file__).parent / "c-code" / "fmi2Functions.h", r"FMI (2[\d.]+\d) "),
        "newlib": found("cmake/libm.cmake", r"# (\d[\d.]+), Debian 12"),
        "ziglang": found("pyproject.toml", r'"ziglang==([\d.]+)"'),
    }
    return Template(TEMPLATE.read_text(encoding="utf-8"), keep_trailing_newline=True).render(versions)


if __name__ == "__main__":
    print(bill(), end="")
