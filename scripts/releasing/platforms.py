"""Runs ten scenes on every platform that this machine can run and writes docs/results/platforms.md.

The driver (driver.c) is compiled by zig for each platform; Windows runs under wine, arm under qemu. macOS is only
built. Scenes of the paper, SI units.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path
from typing import NamedTuple

import page

ROOT = Path(__file__).resolve().parent.parent.parent
HEADERS = Path(importlib.util.find_spec("fmpy").origin).parent / "c-code"
LINUX, ARM, WINDOWS = "x86_64-linux-gnu.2.17", "aarch64-linux-gnu.2.17", "x86_64-windows-gnu"


class Place(NamedTuple):
    """Where a library runs: the driver's target, the command in front of the driver, the library."""

    name: str
    target: str
    runner: list[str]
    library: Path


def guid() -> str:
    return xml.parse(ROOT / "modelDescription.xml").getroot().attrib["guid"]


def build_driver(zig: Path, target: str, folder: Path) -> Path:
    rows = [ROOT / "scripts" / "variable_rows.py", ROOT / "modelDescription.xml", folder / "variables.inc"]
    subprocess.run([sys.executable, *map(str, rows)], check=True)
    driver = folder / target / ("driver.exe" if target == WINDOWS else "driver")
    source = Path(__file__).parent / "driver.c"
    command = [
        str(zig / "zig"),
        "cc",
        "-target",
        target,
        "-O1",
        f"-I{HEADERS}",
        f"-I{folder}",
        str(source),
        "-o",
        str(driver),
    ]
    subprocess.run([*command, *([] if target == WINDOWS else ["-ldl"])], check=True)
    return driver


def run_scenes(place: Place, driver: Path) -> dict[str, page.Row]:
    command = [*place.runner, str(driver), str(place.library), guid()]
    quiet = os.environ | {"WINEDEBUG": "-all"}
    result = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False, env=quiet)
    if result.returncode:
        raise SystemExit(f"{place.name}: {' '.join(command)} failed: {result.stderr[-500:]}")
    rows = {}
    for line in result.stdout.splitlines():
        scene, digest, *values = line.strip().split("\t")
        rows[scene] = page.Row(digest, [float(value) for value in values])
    return rows


def places(arguments: argparse.Namespace) -> list[Place]:
    folder = arguments.folder
    found = [
        Place("linux64", LINUX, [], folder / LINUX / "wheel.so"),
        Place("win64, wine", WINDOWS, [arguments.wine], folder / WINDOWS / "wheel.dll"),
        Place("aarch64-linux, qemu", ARM, ["qemu-aarch64", "-L", arguments.arm_root], folder / ARM / "wheel.so"),
    ]
    if arguments.old_glibc:
        name, libc = arguments.old_glibc
        start = [str(Path(libc) / "ld-linux-x86-64.so.2"), "--library-path", libc]
        found.insert(1, Place(f"linux64, {name}", LINUX, start, folder / LINUX / "wheel.so"))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, required=True, help="of the release, as scripts/releasing/build left it")
    parser.add_argument("--zig", type=Path, required=True)
    parser.add_argument("--wine", required=True)
    parser.add_argument("--arm-root", required=True, help="folder of the arm C library")
    parser.add_argument(
        "--old-glibc", nargs=2, metavar=("NAME", "FOLDER"), help="an older C library than this machine's"
    )
    parser.add_argument("--own", action="append", nargs=2, default=[], metavar=("NAME", "LIBRARY"))
    parser.add_argument("--report", type=Path, required=True)
    arguments = parser.parse_args()
    folder = arguments.folder
    drivers = {target: build_driver(arguments.zig, target, folder) for target in (LINUX, ARM, WINDOWS)}
    released = {place.name: run_scenes(place, drivers[place.target]) for place in places(arguments)}
    own = {name: run_scenes(Place(name, LINUX, [], Path(path)), drivers[LINUX]) for name, path in arguments.own}
    parts = {name: (folder / f"{name}.md").read_text() for name in ("libraries", "fmpy", "twice")}
    arguments.report.write_text(page.write(parts, released, own, (folder / "wheel.fmu").stat().st_size, arguments.wine))
    if page.different(released):
        raise SystemExit(
            f"The trajectories differ between platforms: {page.different(released)}; see {arguments.report}"
        )


if __name__ == "__main__":
    main()
