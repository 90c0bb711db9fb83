"""Prints the software bill of materials of wheel.fmu (CycloneDX): what is linked in, or gave headers.

.venv/bin/python tools/release/sbom.py >fmu-src/archive/extra/org.fmi-standard.fmi-ls-ref/sbom.cdx.json
A test makes it again and compares. Every version is read where the build has it from: the pins, or the headers
themselves.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from uuid import UUID

import fmpy
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output.json import JsonV1Dot6
from packageurl import PackageURL

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref" / "sbom.cdx.json"


def found(file: str | Path, pattern: str) -> str:
    """A version, where the build has it from; `file` is in this project unless it is absolute."""
    match = re.search(pattern, (ROOT / file).read_text(encoding="utf-8"), re.MULTILINE)
    if match is None:
        raise ValueError(f"{file} holds no {pattern}.")
    return match[1]


def component(
    name: str, version: str, licence: str, text: str, kind: ComponentType = ComponentType.LIBRARY
) -> Component:
    url = PackageURL("generic", name=name.lower().replace(" ", "-"), version=version)
    licences = [LicenseExpression(licence)]
    return Component(
        name=name, version=version, type=kind, licenses=licences, description=text, purl=url, bom_ref=str(url)
    )


def eigen() -> str:
    """CMake finds Eigen in Eigen3_DIR, PREFIX/share/eigen3/cmake, or as Debian has it."""
    prefix = Path(os.environ.get("Eigen3_DIR", "/usr/share/eigen3/cmake")).parents[2]  # noqa: SIM112 (CMake names it so)
    macros = prefix / "include" / "eigen3" / "Eigen" / "src" / "Core" / "util" / "Macros.h"
    return ".".join(found(macros, rf"^#define EIGEN_{part}_VERSION (\d+)") for part in ("WORLD", "MAJOR", "MINOR"))


def bill() -> str:
    headers = Path(fmpy.__file__).parent / "c-code" / "fmi2Functions.h"
    wheel = component(
        "wheel.fmu", found("CMakeLists.txt", r"^project\(wheel VERSION ([\d.]+)"), "BSD-3-Clause", "The FMU"
    )
    parts = [
        component("SUNDIALS", found("cmake/sundials.cmake", r"(\d+\.\d+\.\d+)"), "BSD-3-Clause", "CVODE, linked in"),
        component("Eigen", eigen(), "MPL-2.0", "Headers, of Debian's libeigen3-dev"),
        component("FMI headers", found(headers, r"FMI (2[\d.]+\d) "), "BSD-2-Clause", "As FMPy carries them"),
        component(
            "newlib",
            found("cmake/libm.cmake", r"# (\d[\d.]+), Debian"),
            "SunPro AND BSD-3-Clause",
            "Mathematical functions (FDLIBM and Arm's), of Debian's newlib-source, linked in",
        ),
        component("ziglang", found("pyproject.toml", r'"ziglang==([\d.]+)"'), "MIT", "Run-time, in the release"),
    ]
    bom = Bom(components=parts, serial_number=UUID(int=0x2F0C5A4E9B7D4E0C8D1A6B3F5E7C9D02))
    bom.metadata.component = wheel
    bom.register_dependency(wheel, parts)
    text = JsonV1Dot6(bom).output_as_string(indent=2)
    return re.sub(r'\n *"timestamp": "[^"]*",?', "", text) + "\n"


if __name__ == "__main__":
    print(bill(), end="")
