"""Runs ten scenes on every platform that this machine can run and writes docs/results/platforms.md.

The driver (driver.c) is compiled by zig for each platform; Windows runs under wine, arm under qemu, WebAssembly
in wasmtime. macOS is only built. Scenes of the paper, SI units.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import fmpy

from publishing import markdown

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).parent
DESCRIPTION = fmpy.read_model_description(str(ROOT), validate=False)
WASM = "wasm32-wasi"
LINUX, ARM, WINDOWS = "x86_64-linux-gnu.2.17", "aarch64-linux-gnu.2.17", "x86_64-windows-gnu"


class Place(NamedTuple):
    """Where a library runs: the driver's target, the command in front of the driver, the library."""

    name: str
    target: str
    runner: list[str]
    library: Path


Scenes = dict[str, str]  # the digest of each scene's trajectory, all bits


def build_driver(zig: Path, target: str, folder: Path) -> Path:
    rows = [ROOT / "cmake" / "variable_rows.py", ROOT / "modelDescription.xml", folder / "variables.inc"]
    subprocess.run([sys.executable, *map(str, rows)], check=True)
    driver = folder / target / ("driver.exe" if target == WINDOWS else "driver")
    headers = (Path(fmpy.__file__).parent / "c-code", ROOT / "tests" / "support", folder)
    command = [zig / "zig", "cc", "-target", target, "-O1", *(f"-I{path}" for path in headers), HERE / "driver.c"]
    system = [] if target == WINDOWS else ["-ldl"]
    subprocess.run([*map(str, command), "-o", str(driver), *system], check=True)
    return driver


def run_scenes(place: Place, driver: Path) -> Scenes:
    command = [*place.runner, str(driver), str(place.library), DESCRIPTION.guid]
    quiet = os.environ | {"WINEDEBUG": "-all"}
    result = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False, env=quiet)
    if result.returncode:
        raise SystemExit(f"{place.name}: {' '.join(command)} failed: {result.stderr[-500:]}")
    return dict(line.split("\t") for line in result.stdout.splitlines())


def places(arguments: argparse.Namespace) -> list[Place]:
    folder = arguments.folder
    found = [
        Place("linux64", LINUX, [], folder / LINUX / "wheel.so"),
        Place("this machine's compiler", LINUX, [], arguments.own),
        Place("win64, wine", WINDOWS, [arguments.wine], folder / WINDOWS / "wheel.dll"),
        Place("aarch64-linux, qemu", ARM, ["qemu-aarch64", "-L", arguments.arm_root], folder / ARM / "wheel.so"),
    ]
    wasm = [arguments.wasm_python, str(HERE / "run_wasm.py")]
    found.append(Place("wasm32, wasmtime", WASM, wasm, Path("linked in")))
    if arguments.old_glibc:
        name, libc = arguments.old_glibc
        start = [str(Path(libc) / "ld-linux-x86-64.so.2"), "--library-path", libc]
        found.insert(2, Place(f"linux64, {name}", LINUX, start, folder / LINUX / "wheel.so"))
    return found


def table(run: dict[str, Scenes]) -> str:
    """A row for each scene; the digest on the first platform, and on each other one whether it is equal."""
    first, *others = run.values()
    rows = []
    for scene, digest in first.items():
        rows.append([scene, digest, *("equal" if other[scene] == digest else other[scene] for other in others)])
    return markdown.table(["scene", *run], rows)


def write(arguments: argparse.Namespace, run: dict[str, Scenes], **found: object) -> None:
    folder = arguments.folder
    text = markdown.page(
        "platforms.md.j2",
        commit=markdown.said("git", "describe", "--always", "--dirty"),
        size=(folder / "wheel.fmu").stat().st_size / 1e3,
        outputs=sum(v.causality == "output" for v in DESCRIPTION.modelVariables),
        compiler=markdown.said("c++", "--version"),
        old=arguments.old_glibc and arguments.old_glibc[0],
        wine=markdown.said(arguments.wine, "--version"),
        qemu=markdown.said("qemu-aarch64", "--version").replace("qemu-aarch64 version", "qemu"),
        run=table(run),
        **{name: (folder / f"{name}.md").read_text(encoding="utf-8") for name in ("libraries", "fmpy", "twice")},
        **found,
    )
    arguments.report.write_text(text, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, required=True, help="of the release, as tools/release/build left it")
    parser.add_argument("--zig", type=Path, required=True)
    parser.add_argument("--wine", required=True)
    parser.add_argument("--arm-root", required=True, help="folder of the arm C library")
    parser.add_argument("--wasm", type=Path, required=True, help="the driver with the wheel linked in")
    parser.add_argument("--wasm-python", required=True, help="a Python with wasmtime")
    parser.add_argument(
        "--old-glibc", nargs=2, metavar=("NAME", "FOLDER"), help="an older C library than this machine's"
    )
    parser.add_argument("--own", type=Path, required=True, help="the library that this machine's own compiler made")
    parser.add_argument("--report", type=Path, required=True)
    arguments = parser.parse_args()
    folder = arguments.folder
    drivers = {target: build_driver(arguments.zig, target, folder) for target in (LINUX, ARM, WINDOWS)}
    drivers[WASM] = arguments.wasm
    run = {place.name: run_scenes(place, drivers[place.target]) for place in places(arguments)}
    different = [scene for scene in run["linux64"] if len({scenes[scene] for scenes in run.values()}) > 1]
    write(arguments, run, different=different)
    if different:
        raise SystemExit(f"The trajectories differ between platforms: {different}; see {arguments.report}")


if __name__ == "__main__":
    main()
