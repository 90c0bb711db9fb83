"""The FMUs of the examples: those in C++ by CMake (../CMakeLists.txt), balance.fmu from Python by pythonfmu."""

import os
import subprocess
import sys
from pathlib import Path

from pythonfmu.builder import FmuBuilder

from .options import EXAMPLES

ROOT = EXAMPLES.parents[1]


def wheel_fmu() -> Path:
    """The built wheel: in the folder WHEEL_BUILD, else in build/release."""
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release")) / "wheel.fmu"


def build_c(folder: Path) -> dict[str, Path]:
    """The FMUs in C++, by name; also the C master, folder/master."""
    cache = folder / "CMakeCache.txt"  # it holds absolute paths: of a folder that was moved it is made anew
    moved = cache.exists() and f"CMAKE_HOME_DIRECTORY:INTERNAL={EXAMPLES}\n" not in cache.read_text()
    fresh = ["--fresh"] if moved else []
    configure = ["cmake", *fresh, "-S", EXAMPLES, "-B", folder, f"-DPython3_EXECUTABLE={sys.executable}"]
    for command in (configure, ["cmake", "--build", folder]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"cmake failed:\n{done.stdout}\n{done.stderr}")
    return {fmu.stem: fmu for fmu in folder.glob("*.fmu")}


def build_all(folder: Path) -> dict[str, Path]:
    """Every FMU of the examples by name; balance.fmu needs a host with a Python interpreter."""
    folder.mkdir(parents=True, exist_ok=True)
    script = EXAMPLES / "balance" / "balance.py"
    how = {"project_files": [script.with_suffix(".csv")], "needsExecutionTool": "false"}
    FmuBuilder.build_FMU(script, dest=folder / "balance.fmu", **how)
    return {**build_c(folder), "wheel": wheel_fmu()}
