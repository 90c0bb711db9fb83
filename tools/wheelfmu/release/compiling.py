"""The project's sources compiled for another platform by PyPI's ziglang: clang, every target's libc, the linkers."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

from wheelfmu.fmu.paths import CMAKE, ROOT, without_stale_cache

WASM = "wasm32-wasi"


def compiler() -> Path:
    """The folder of ziglang, which has the licences too."""
    return Path(str(files("ziglang")))


def build(
    out: Path, platform: str, target: str, sources: Path = ROOT, zig: Path | None = None, sundials: str = ""
) -> None:
    """One CMake target for one platform of zig's; sundials: its source tree, fetched if it is not given."""
    program = (zig or compiler()) / "zig"
    without_stale_cache(out, sources, f"={program}\n")
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
    log = out / "build.log"
    with log.open("w", encoding="utf-8") as file:
        for command in (
            [*CMAKE, "-Wno-dev", "-S", sources, "-B", out, *given],
            ["cmake", "--build", out, "--target", target, "--parallel", str(os.cpu_count())],
        ):
            if subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode:
                print(*log.read_text(encoding="utf-8").splitlines()[-40:], sep="\n", file=sys.stderr)
                raise SystemExit(f"The build for {platform} failed; the whole log is {log}.")


def wasm(folder: Path, made: str) -> Path:
    """A module in a build folder, made anew only where a source has changed: wheel_page, of the live page, or
    wheel_driver, the release's scenes."""
    build(folder, WASM, made)
    return folder / f"{made}.wasm"
