"""Runs ten scenes on every platform that this machine can run and writes docs/results/platforms.md.

The driver (driver.c) is compiled by zig for each platform; Windows under wine,
arm under qemu. macOS is only built.
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
HEADERS = subprocess.run(
    [sys.executable, "-c", "import importlib.util as u; print(u.find_spec('fmpy').submodule_search_locations[0])"],
    capture_output=True, text=True, check=True,
).stdout.strip()  # fmt: skip
WINE = ["/usr/lib/wine/wine64"]
QEMU = ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"]
GLIBC_FLOOR = (2, 17)
GLIBC_PLATFORMS = ("linux64", "aarch64-linux")

# platform: (zig's target, library, how it runs here; None: it does not)
PLATFORMS: dict[str, tuple[str, str, list[str] | None]] = {
    "linux64": ("x86_64-linux-gnu.2.17", "wheel.so", []),
    "win64": ("x86_64-windows-gnu", "wheel.dll", WINE),
    "aarch64-linux": ("aarch64-linux-gnu.2.17", "wheel.so", QEMU),
    "darwin64 (x86_64)": ("x86_64-macos.11.0", "wheel.dylib", None),
    "darwin64, aarch64-darwin (arm64)": ("aarch64-macos.11.0", "wheel.dylib", None),
}
Row = tuple[str, list[float]]  # hash of the trajectory, the four headline outputs at the end


def guid() -> str:
    return xml.parse(ROOT / "modelDescription.xml").getroot().attrib["guid"]


def run_scenes(command: list[str], library: Path) -> dict[str, Row]:
    result = subprocess.run([*command, str(library), guid()], capture_output=True, text=True, timeout=900, check=False)
    if result.returncode:
        raise SystemExit(f"{' '.join(command)} failed: {result.stderr[-500:]}")
    rows = {}
    for line in result.stdout.splitlines():
        name, digest, *values = line.strip().split("\t")
        rows[name] = (digest, [float(value) for value in values])
    return rows


def build_driver(compiler: list[str], output: Path, flags: list[str]) -> Path:
    source = Path(__file__).parent / "driver.c"
    subprocess.run([*compiler, "-O1", f"-I{HEADERS}/c-code", str(source), "-o", str(output), *flags], check=True)
    return output


def run_platform(zig: str, target: str, folder: Path, library: str, runner: list[str]) -> dict[str, Row] | None:
    if runner and not shutil.which(runner[0]):
        return None
    windows = "windows" in target
    driver = folder / target / ("driver.exe" if windows else "driver")
    build_driver([zig, "cc", "-target", target], driver, [] if windows else ["-ldl"])
    return run_scenes([*runner, str(driver)], folder / target / library)


def needed_glibc(library: Path) -> tuple[int, ...]:
    """The newest version of a glibc symbol that the library asks for."""
    text = subprocess.run(["readelf", "-V", str(library)], capture_output=True, text=True, check=True).stdout
    return max(tuple(int(part) for part in found.split(".")) for found in re.findall(r"GLIBC_([0-9.]+)", text))


def foreign_exports(library: Path) -> list[str]:
    text = subprocess.run(["nm", "-D", "--defined-only", str(library)], capture_output=True, text=True, check=True)
    return [line.split()[-1] for line in text.stdout.splitlines() if not line.split()[-1].startswith("fmi2")]


def hash_table(results: dict[str, dict[str, Row] | None]) -> list[str]:
    ran = {platform: rows for platform, rows in results.items() if rows}
    lines = ["| scene | " + " | ".join(ran) + " | equal |", "|---" * (len(ran) + 2) + "|"]
    for scene in next(iter(ran.values())):
        digests = [rows[scene][0] for rows in ran.values()]
        lines.append(f"| {scene} | " + " | ".join(digests) + f" | {'yes' if len(set(digests)) == 1 else 'no'} |")
    return lines


def largest_difference(a: dict[str, Row], b: dict[str, Row]) -> dict[str, float]:
    """Largest relative difference of the four headline outputs at the end of each scene."""
    return {
        scene: max(abs(x - y) / max(abs(x), 1e-3) for x, y in zip(a[scene][1], b[scene][1], strict=True)) for scene in a
    }


HOW = {"linux64": "run", "win64": "run under wine", "aarch64-linux": "run under qemu"}
HEAD = """# The release on every platform

Made by `scripts/release`.

| platform | size | tested here |
|---|---|---|"""
TRAJECTORIES = """
## Hash of the trajectory of ten scenes

16 outputs at 500 communication points of 0.02 s, all bits.
"""
AGAINST = """
## Against the build of `scripts/build release` (this machine's compiler and libm)

Largest relative difference of the four headline outputs at t = 10 s.

| scene | difference |
|---|---|"""


def report(folder: Path, results: dict[str, dict[str, Row] | None], own: dict[str, Row] | None) -> str:
    lines = [HEAD]
    for platform, (target, library, _) in PLATFORMS.items():
        tested = HOW.get(platform, "") if results[platform] else "**only built**, not run"
        lines.append(f"| {platform} | {(folder / target / library).stat().st_size / 1e3:.0f} kB | {tested} |")
    lines += ["", f"The archive has {(folder / 'wheel.fmu').stat().st_size / 1e3:.0f} kB.", ""]
    for platform in GLIBC_PLATFORMS:
        version = ".".join(map(str, needed_glibc(folder / PLATFORMS[platform][0] / "wheel.so")))
        lines.append(f"- {platform} asks for glibc {version} or later and exports fmi2 functions only.")
    lines += [TRAJECTORIES, *hash_table(results)]
    if own and results["linux64"]:
        differences = largest_difference(results["linux64"], own)
        lines += [AGAINST, *(f"| {scene} | {value:.1e} |" for scene, value in differences.items())]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, required=True)
    parser.add_argument("--zig", required=True)
    parser.add_argument("--report", type=Path, required=True)
    arguments = parser.parse_args()
    folder = arguments.folder
    results = {}
    for platform, (target, library, runner) in PLATFORMS.items():
        results[platform] = None if runner is None else run_platform(arguments.zig, target, folder, library, runner)
    for platform in GLIBC_PLATFORMS:
        library = folder / PLATFORMS[platform][0] / "wheel.so"
        if needed_glibc(library) > GLIBC_FLOOR or foreign_exports(library):
            raise SystemExit(f"{library}: needs glibc {needed_glibc(library)}, exports {foreign_exports(library)}")
    native = ROOT / "build" / "release" / "wheel.so"
    own = run_scenes([str(folder / PLATFORMS["linux64"][0] / "driver")], native) if native.exists() else None
    arguments.report.parent.mkdir(parents=True, exist_ok=True)
    arguments.report.write_text(report(folder, results, own))
    ran = [rows for rows in results.values() if rows]
    if any({s: row[0] for s, row in rows.items()} != {s: row[0] for s, row in ran[0].items()} for rows in ran):
        print("The trajectories differ between platforms: see the report.", file=sys.stderr)


if __name__ == "__main__":
    main()
