"""What the report runs, built in build/work_precision: the driver, the C++ peers, the library out of wheel.fmu."""

from __future__ import annotations

import re
import subprocess
import zipfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import fmpy
from scipy.integrate._ivp import dop853_coefficients as dop853

ROOT = Path(__file__).resolve().parents[2]
BENCH = ROOT / "scripts" / "bench"
EQUATIONS = ROOT / "fmu-src" / "equations"
WARNINGS = ("-Wall", "-Wextra")


@dataclass(frozen=True)
class Build:
    """The things to run. missing: program name -> why it could not be built."""

    folder: Path  # CMake's
    work: Path
    fmu: Path
    library: Path
    guid: str
    references: dict[str, tuple[str, int]]  # variable -> (kind r, i or b; value reference)
    methods: dict[str, int]
    missing: dict[str, str]
    compilers: dict[str, str]

    def program(self, name: str) -> Path:
        return self.work / name


def write_tableau(path: Path) -> None:
    """The coefficients of DOP853 as C++, from SciPy's tables."""

    def row(name: str, numbers: object) -> str:
        values = ", ".join(float(x).hex() for x in numbers)  # type: ignore[attr-defined]
        return f"inline constexpr std::array<double, {len(numbers)}> {name} = {{{values}}};\n"  # type: ignore[arg-type]

    text = "// Written by scripts/precision/builds.py from SciPy's tables.\n#pragma once\n#include <array>\n"
    text += "namespace tableau {\n"
    for stage in (*range(1, 12), 13, 14, 15):
        text += row(f"A{stage}", dop853.A[stage, :stage])
    text += row("B", dop853.B) + row("E5", dop853.E5) + row("E3", dop853.E3)
    for i in range(4):
        text += row(f"D{i}", dop853.D[i])
    path.write_text(text + "}\n")


def cache_value(folder: Path, name: str) -> str:
    for line in (folder / "CMakeCache.txt").read_text().splitlines():
        if line.startswith(f"{name}:"):
            return line.split("=", 1)[1]
    return ""


def compile_all(folder: Path, work: Path, compilers: dict[str, str]) -> dict[str, str]:
    headers = Path(fmpy.__file__).parent / "c-code"
    equations = ["-L", folder, f"-Wl,-rpath,{folder}", "-lwheel_equations"]
    cxx = [compilers["CXX"], "-std=c++20", "-O3", "-fno-math-errno", *WARNINGS, "-I", work, "-I", EQUATIONS]
    c = [compilers["C"], "-std=gnu11", "-O2", *WARNINGS, "-I", headers, "-I", EQUATIONS]
    scene = BENCH / "scene.cpp"
    commands = {
        "master": [*c, *(BENCH / f for f in ("master.c", "fmu.c", "many.c")), "-ldl", "-lpthread"],
        "rhs.so": [*c, "-shared", "-fPIC", BENCH / "rhs.c"],
        "dop853": [*cxx, BENCH / "dop853.cpp", scene, *equations],
        "dop853_native": [*cxx, "-march=native", BENCH / "dop853.cpp", scene, *equations],
        "odeint": [*cxx, BENCH / "odeint.cpp", scene, *equations],
    }
    missing = {}
    for name, command in commands.items():
        result = subprocess.run([*map(str, command), "-o", str(work / f"{name}.new")], capture_output=True, text=True)
        if result.returncode == 0:
            (work / f"{name}.new").replace(work / name)  # whoever runs the old one keeps it
        else:
            errors = [line for line in result.stderr.splitlines() if "error" in line]
            reason = (errors or ["see the compiler"])[0].rsplit("error:", 1)[-1].strip()
            missing[name] = f"does not compile: {reason}"
    return missing


def read_description(fmu: Path) -> tuple[str, dict[str, tuple[str, int]], dict[str, int]]:
    with zipfile.ZipFile(fmu) as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    kinds = {"Real": "r", "Integer": "i", "Boolean": "b"}
    variables = {v.attrib["name"]: v for v in root.iter("ScalarVariable")}
    references = {name: (kinds[v[0].tag], int(v.attrib["valueReference"])) for name, v in variables.items()}
    methods = re.findall(r"\b(\d) (\w+)", variables["method"].attrib["description"])
    return root.attrib["guid"], references, {name: int(number) for number, name in methods}


def build(folder: Path) -> Build:
    """From CMake's build folder (wheel.fmu, libwheel_equations.so)."""
    work = folder.parent / "work_precision"
    work.mkdir(exist_ok=True)
    fmu = folder / "wheel.fmu"
    with zipfile.ZipFile(fmu) as archive:
        binary = next(n for n in archive.namelist() if n.startswith("binaries/") and n.endswith(".so"))
        library, fresh = work / "wheel.so", work / "wheel.so.new"
        fresh.write_bytes(archive.read(binary))
        fresh.replace(library)
    write_tableau(work / "dop853_tableau.h")
    compilers = {language: cache_value(folder, f"CMAKE_{language}_COMPILER") for language in ("C", "CXX")}
    missing = compile_all(folder, work, compilers)
    if "master" in missing:
        raise SystemExit(f"The driver did not compile: {missing['master']}")
    guid, references, methods = read_description(fmu)
    return Build(folder, work, fmu, library, guid, references, methods, missing, compilers)
