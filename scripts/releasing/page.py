"""The text of docs/results/platforms.md out of what scripts/release measured; no part of the paper."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent.parent


class Row(NamedTuple):
    digest: str  # of the trajectory, all bits
    last: list[float]  # the four headline outputs at the end


Scenes = dict[str, Row]

TEXT = """# The release on every platform

Made by `scripts/release` from commit {commit}. The archive has {size:.0f} kB. Which folder serves which machine:
[platform_folders.md](../decisions/platform_folders.md).

## The libraries

{libraries}
Checked on each: processor, needed libraries, oldest system, size below 1 MiB; exported are the 44 functions of FMI 2.0
and nothing else; of the system's mathematics only what is exact is used. The arm library for macOS carries a signature
that fits its pages, without which Apple's processors load nothing.

## What was run and what was only built

| platform | |
|---|---|
| linux64 | run here{old}; passes the contract's tests (`tests/contract`) |
| win64 | run under {wine}, by the driver and by FMPy |
| aarch64-linux | run under {qemu} |
| wasm32 | no library of the archive: the wheel of the live page ([page.md](../page.md)), run in wasmtime |
| darwin64, aarch64-darwin | **only built**, and checked as a file. Never loaded by a Mac |

The floor of glibc 2.17 is read off the versions of the symbols. On glibc 2.17 itself the library was not run.

{fmpy}
## Trajectories, to the bit

Hash of 16 outputs at 500 communication points of 0.02 s, all bits (`scripts/releasing/driver.c`).

{released}

{verdict} What it takes: no contraction to fused multiply-add, no vector code of Eigen, and one libm (musl's sources)
compiled in everywhere ([libm.cmake](../../cmake/libm.cmake)).

## Against the build of this machine's own compiler

`scripts/build release` takes this machine's compiler, its libm and Eigen's vector code; the second column has musl's
libm and no vector code, as the releases. Compiler: {compiler}. Largest relative difference of the four headline
outputs at t = 10 s from the released linux64; "equal" means all bits of the trajectory.

{own}

So the compiler changes no bit; libm and vector code do, within what a scene errs anyway (the slope: 1.1e-5 at its
tolerance of 1e-6, measured once against 1e-12).

## Two builds in two folders

{twice}"""


def version_of(*command: str) -> str:
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()[0].strip()
    except (OSError, subprocess.CalledProcessError):
        return command[0]


def different(released: dict[str, Scenes]) -> list[str]:
    """The scenes whose trajectories are not the same on all platforms."""
    first = next(iter(released.values()))
    return [scene for scene in first if len({scenes[scene].digest for scenes in released.values()}) > 1]


def hash_table(released: dict[str, Scenes]) -> str:
    reference, *others = released
    lines = [f"| scene | {' | '.join(released)} |", "|---" * (len(released) + 1) + "|"]
    for scene, row in released[reference].items():
        cells = [released[other][scene].digest for other in others]
        shown = ["equal" if cell == row.digest else cell for cell in cells]
        lines.append(f"| {scene} | {' | '.join([row.digest, *shown])} |")
    return "\n".join(lines)


def own_table(reference: Scenes, own: dict[str, Scenes]) -> str:
    def cell(a: Row, b: Row) -> str:
        if a.digest == b.digest:
            return "equal"
        return f"{max(abs(x - y) / max(abs(x), 1e-3) for x, y in zip(a.last, b.last, strict=True)):.1e}"

    lines = [f"| scene | {' | '.join(own)} |", "|---" * (len(own) + 1) + "|"]
    for scene, row in reference.items():
        lines.append(f"| {scene} | {' | '.join(cell(row, scenes[scene]) for scenes in own.values())} |")
    return "\n".join(lines)


def write(parts: dict[str, str], released: dict[str, Scenes], own: dict[str, Scenes], size: int, wine: str) -> str:
    others = different(released)
    old = [name.split(", ")[1] for name in released if name.startswith("linux64, ")]
    return TEXT.format(
        commit=version_of("git", "-C", str(ROOT), "describe", "--always", "--dirty"),
        size=size / 1e3,
        compiler=version_of("c++", "--version"),
        old=f", and with {old[0]}" if old else "",
        wine=version_of(wine, "--version"),
        qemu=version_of("qemu-aarch64", "--version").replace("qemu-aarch64 version", "qemu"),
        released=hash_table(released),
        verdict=f"Not equal: {', '.join(others)}." if others else "All equal.",
        own=own_table(released["linux64"], own),
        **parts,
    )
