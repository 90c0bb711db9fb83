"""The FMUs of the examples: those in C++ by CMake (../CMakeLists.txt), balance.fmu from Python by pythonfmu."""

import subprocess
import sys
from pathlib import Path

from pythonfmu.builder import FmuBuilder
from support.paths import ROOT, build_folder

from .options import EXAMPLES


def build_c(folder: Path) -> dict[str, Path]:
    """The FMUs in C++, by name."""
    cache = folder / "CMakeCache.txt"  # it holds absolute paths: of a folder that was moved it is made anew
    moved = cache.exists() and f"CMAKE_HOME_DIRECTORY:INTERNAL={EXAMPLES}\n" not in cache.read_text()
    configure = ["cmake", *["--fresh"] * moved, "-S", EXAMPLES, "-B", folder, f"-DPython3_EXECUTABLE={sys.executable}"]
    for command in (configure, ["cmake", "--build", folder]):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return {fmu.stem: fmu for fmu in folder.glob("*.fmu")}


def build_all(folder: Path = ROOT / "build" / "examples") -> dict[str, Path]:
    """Every FMU of the examples by name; balance.fmu needs a host with a Python interpreter."""
    folder.mkdir(parents=True, exist_ok=True)
    script = EXAMPLES / "balance" / "balance.py"
    how = {"project_files": [script.with_suffix(".csv")], "needsExecutionTool": "false"}
    FmuBuilder.build_FMU(script, dest=folder / "balance.fmu", **how)
    return {**build_c(folder), "wheel": build_folder() / "wheel.fmu"}
