"""The project's sources compiled for another platform by PyPI's ziglang: clang, every target's libc, the linkers."""

from __future__ import annotations

import os
import sys
from importlib.resources import files
from pathlib import Path

from wheelfmu.fmu import building
from wheelfmu.fmu.paths import ROOT

WASM = "wasm32-wasi"


def compiler() -> Path:
    """The folder of ziglang, which has the licences too."""
    return Path(str(files("ziglang")))


def build(
    out: Path, platform: str, target: str, sources: Path = ROOT, zig: Path | None = None, sundials: str = ""
) -> None:
    """One CMake target for one platform of zig's; sundials: its source tree, fetched if it is not given."""
    program = (zig or compiler()) / "zig"
    options = {
        "CMAKE_BUILD_TYPE": "Release",
        "CMAKE_UNITY_BUILD": platform == WASM,
        "CMAKE_TOOLCHAIN_FILE": sources / "cmake" / "zig.cmake",
        "CMAKE_MODULE_LINKER_FLAGS_RELEASE": "-s",
        "CMAKE_SHARED_LINKER_FLAGS_RELEASE": "-s",
        "Python3_EXECUTABLE": sys.executable,
        "WHEEL_ZIG": program,
        "WHEEL_ZIG_TARGET": platform,
        "WHEEL_SUNDIALS_SOURCE": sundials or os.environ.get("WHEEL_SUNDIALS_SOURCE", ""),
    }
    given = [f"-D{name}={value}" for name, value in options.items()]
    building.build(platform, out, sources, ["-Wno-dev", *given], [out, "--target", target], f"={program}\n")
