"""The FMUs of the examples: those in C++ by CMake (../CMakeLists.txt), balance.fmu from Python by pythonfmu."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from pythonfmu.builder import FmuBuilder

from .options import EXAMPLES

ROOT = EXAMPLES.parents[1]
COMPILED = ("quarter_car", "axle", "chassis", "driver")


def wheel_fmu() -> Path:
    """The built wheel: in the folder WHEEL_BUILD, else in build/release."""
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release")) / "wheel.fmu"


def _quietly(*command: str | Path) -> None:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{command[0]} failed:\n{done.stdout}\n{done.stderr}")


def build_c(folder: Path) -> dict[str, Path]:
    """The FMUs in C++, by name; also the C master, folder/master."""
    cache = folder / "CMakeCache.txt"  # it holds absolute paths: of a folder that was moved it is made anew
    moved = cache.exists() and f"CMAKE_HOME_DIRECTORY:INTERNAL={EXAMPLES}\n" not in cache.read_text()
    fresh = ["--fresh"] if moved else []
    _quietly("cmake", *fresh, "-S", EXAMPLES, "-B", folder, f"-DPython3_EXECUTABLE={sys.executable}")
    _quietly("cmake", "--build", folder)
    return {name: folder / f"{name}.fmu" for name in COMPILED}


def build_all(folder: Path) -> dict[str, Path]:
    """Every FMU of the examples by name; balance.fmu needs a host with a Python interpreter."""
    folder.mkdir(parents=True, exist_ok=True)
    balance = folder / "balance.fmu"
    FmuBuilder.build_FMU(EXAMPLES / "balance" / "balance.py", dest=balance, needsExecutionTool="false")
    return {"wheel": wheel_fmu(), **build_c(folder), "balance": balance}
