"""The steps of ./scripts/release; what it runs and finds goes into docs/results/platforms.md."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from wheelfmu.fmu.files import step
from wheelfmu.fmu.paths import ROOT
from wheelfmu.publishing.markdown import page, said
from wheelfmu.release import assembly, compiling, folder, libraries, platforms

OUT = ROOT / "build" / "wheel-release"
REPORT = ROOT / "docs" / "results" / "platforms.md"


def build_elsewhere(first: Path, scratch: Path) -> str:
    """The same again, from sources, SUNDIALS and compiler in other folders: the two FMUs must be identical.

    Returns how their SHA-256 begins.
    """
    own = shutil.ignore_patterns(".*", "build", "results")
    sources = shutil.copytree(ROOT, scratch / "sources", ignore=own)
    sundials = os.environ.get("WHEEL_SUNDIALS_SOURCE") or next((ROOT / "build" / "sundials").glob("*/vendor"))
    sundials = shutil.copytree(sundials, scratch / "sundials")
    second = assembly.write(
        scratch / "out", sources, shutil.copytree(compiling.compiler(), scratch / "zig"), str(sundials)
    )
    if first.read_bytes() != second.read_bytes():
        other = shutil.copy(second, OUT / "other.fmu")
        raise SystemExit(f"Two builds in two folders differ: {first} and {other}.")
    return folder.sum_of(first)[:16]


def write_report(released: Path, **found: object) -> None:
    text = page(
        "platforms.md.j2",
        commit=said("git", "describe", "--always", "--dirty"),
        size=released.stat().st_size / 1e3,
        outputs=len(platforms.OUTPUTS),
        compiler=said("c++", "--version"),
        wine=said(platforms.WINE, "--version"),
        qemu=said("qemu-aarch64", "--version").replace("qemu-aarch64 version", "qemu"),
        **found,
    )
    REPORT.write_text(text, encoding="utf-8")
    if found["different"]:
        raise SystemExit(f"The trajectories differ between platforms: {found['different']}; see {REPORT}")


def main() -> None:
    number, notes, draft = folder.described()
    source = folder.commit()
    with tempfile.TemporaryDirectory() as place:
        scratch = Path(place)
        step("the libraries of all platforms")
        released = assembly.write(OUT)
        step("the libraries as files")
        table = libraries.table(OUT)
        step("the contract's tests on the released Linux library")
        subprocess.run(["bash", "scripts/build", "release"], check=True)
        for equations in (ROOT / "build" / "release").glob("libwheel_equations.*"):  # which the tests' references read
            shutil.copy(equations, OUT)
        tests = ["-q", "-n", "auto", "-m", "not local", "tests/contract", "tests/robustness/test_allocations.py"]
        subprocess.run([sys.executable, "-m", "pytest", *tests], env=os.environ | {"WHEEL_BUILD": str(OUT)}, check=True)
        step("the same again in another folder")
        twice = build_elsewhere(released, scratch)
        step("the scenes on every platform that runs here")
        scenes = platforms.scenes(OUT)
    write_report(released, libraries=table, twice=twice, **scenes)
    step("the site, dist/ and the folder")
    subprocess.run(["bash", "scripts/site"], check=True)
    folder.distribute(released, source, number, draft=draft)
    step("done")
    print("What was run and what was only built: docs/results/platforms.md.")
    folder.publish(released, ROOT / "build" / "site", number, notes)
