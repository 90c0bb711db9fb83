"""Builds the partner FMUs: quarter_car.fmu compiled from C by CMake, balance.fmu made from Python by pythonfmu."""

from __future__ import annotations

import os
import subprocess
import zipfile
from importlib.util import find_spec
from pathlib import Path

from pythonfmu.builder import FmuBuilder

EXAMPLES = Path(__file__).resolve().parent.parent
ROOT = EXAMPLES.parent.parent


def wheel_fmu() -> Path:
    """The built wheel: in the folder WHEEL_BUILD, else in build/release."""
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release")) / "wheel.fmu"


def fmi_headers() -> Path:
    """The folder of fmi2Functions.h, which comes with fmpy."""
    return Path(find_spec("fmpy").origin).parent / "c-code"


def _quietly(*command: str | Path) -> None:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{command[0]} failed:\n{done.stdout}\n{done.stderr}")


def build_quarter_car(folder: Path) -> Path:
    """quarter_car.fmu in `folder`, compiled by CMake."""
    binary = folder / "cmake"
    _quietly("cmake", "-S", EXAMPLES, "-B", binary, f"-DFMI2_INCLUDE_DIR={fmi_headers()}")
    _quietly("cmake", "--build", binary)
    fmu = folder / "quarter_car.fmu"
    with zipfile.ZipFile(fmu, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(EXAMPLES / "quarter_car" / "modelDescription.xml", "modelDescription.xml")
        archive.write(binary / "quarter_car.so", "binaries/linux64/quarter_car.so")
    return fmu


def build_balance(folder: Path) -> Path:
    """balance.fmu in `folder`, by pythonfmu; it runs in hosts that have a Python interpreter."""
    fmu = folder / "balance.fmu"
    FmuBuilder.build_FMU(EXAMPLES / "balance" / "balance.py", dest=fmu, needsExecutionTool="false")
    return fmu


def build_all(folder: Path) -> dict[str, Path]:
    """Every FMU of the examples by name."""
    folder.mkdir(parents=True, exist_ok=True)
    return {
        "wheel": wheel_fmu(),
        "quarter_car": build_quarter_car(folder),
        "balance": build_balance(folder),
    }
