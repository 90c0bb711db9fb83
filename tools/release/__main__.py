"""The steps of ./scripts/release; what it runs and finds goes into docs/results/platforms.md."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
import time
from pathlib import Path

from publishing import markdown
from publishing.markdown import ROOT, said
from release import compiling, fmu, folder, libraries, platforms

BEGIN = time.monotonic()
OUT = ROOT / "build" / "wheel-release"
FETCHED = ROOT / "build" / "sundials"
# FMPy's server ends itself when it can write to its lock file, as root always can: it is started without one.
WINE = '#!/bin/sh\nexec {wine} "$1" "$2"\n'


def step(text: str) -> None:
    print(f"\n== {text} ({time.monotonic() - BEGIN:.0f} s)", flush=True)


def wrapped(text: str) -> str:
    return textwrap.fill(text, 119, break_on_hyphens=False)


def test_contract() -> None:
    words = [
        "-q",
        "-n",
        str(os.cpu_count()),
        "-m",
        "not local",
        "tests/contract",
        "tests/robustness/test_allocations.py",
    ]
    subprocess.run([sys.executable, "-m", "pytest", *words], env=os.environ | {"WHEEL_BUILD": str(OUT)}, check=True)


def build_elsewhere(first: Path, scratch: Path) -> str:
    """The same again, from sources, SUNDIALS and compiler in other folders: the two FMUs must be identical."""
    listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    for name in subprocess.run(listed, capture_output=True, text=True, check=True).stdout.split("\0"):
        if Path(name).is_file():
            (scratch / "sources" / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(name, scratch / "sources" / name)
    sundials = os.environ.get("WHEEL_SUNDIALS_SOURCE") or next(FETCHED.glob("*/vendor"))
    zig = shutil.copytree(compiling.compiler(), scratch / "zig")
    shutil.copytree(sundials, scratch / "sundials")
    second = fmu.write(scratch / "out", scratch / "sources", zig, str(scratch / "sundials"))
    if first.read_bytes() != second.read_bytes():
        other = shutil.copy(second, OUT / "other.fmu")
        raise SystemExit(f"Two builds in two folders differ: {first} and {other}.")
    return wrapped(
        "All five libraries were built twice, from sources, SUNDIALS and compiler in other folders: the two FMUs are "
        f"identical, SHA-256 `{hashlib.sha256(first.read_bytes()).hexdigest()[:16]}…`."
    )


def simulate_by_fmpy(released: Path, wine: str, scratch: Path) -> str:
    os.environ |= {"WINEPREFIX": str(OUT / "wine"), "WINEDEBUG": "-all"}
    # Its first start makes a folder, which takes a while.
    subprocess.run([wine, "wineboot", "--init"], capture_output=True, check=False)
    start = scratch / "wine64"
    start.write_text(WINE.format(wine=wine))
    start.chmod(0o755)
    path = os.environ | {"PATH": f"{scratch}:{os.environ['PATH']}"}
    command = [sys.executable, "-m", "release.by_fmpy", released]
    done = subprocess.run(command, env=path, stdout=subprocess.PIPE, text=True, timeout=600, check=True)
    return wrapped(done.stdout)


def old_libc(scratch: Path) -> tuple[str, Path] | None:
    """Name and folder of the C library of an older Debian, if it can be had."""
    command = [ROOT / "tools" / "release" / "old_glibc", "bullseye", scratch]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"No older C library could be had: {done.stderr}")
        return None
    (package,) = scratch.glob("libc6_*.deb")
    return f"glibc {re.match(r'libc6_([0-9.]*)', package.name)[1]}", scratch / "root" / "lib" / "x86_64-linux-gnu"


def main() -> None:
    folder.described()
    wine = shutil.which("wine64") or "/usr/lib/wine/wine64"
    found: dict[str, object] = {}
    with tempfile.TemporaryDirectory() as place:
        scratch = Path(place)
        step("the libraries of all platforms")
        released = fmu.write(OUT)
        step("the libraries as files")
        found["libraries"] = libraries.table(OUT)
        step("the contract's tests on the released Linux library")
        test_contract()
        step("the same again in another folder")
        found["twice"] = build_elsewhere(released, scratch)
        step("FMPy, with the Windows library under wine")
        found["fmpy"] = simulate_by_fmpy(released, wine, scratch)
        step("ten scenes on every platform that runs here")
        subprocess.run(["./scripts/build", "release"], check=True)
        old = old_libc(scratch / "glibc")
        run = platforms.scenes(OUT, wine, old)
    different = [scene for scene, digest in run["linux64"].items() if {r[scene] for r in run.values()} != {digest}]
    page = markdown.page(
        "platforms.md.j2",
        commit=said("git", "describe", "--always", "--dirty"),
        size=released.stat().st_size / 1e3,
        outputs=sum(v.causality == "output" for v in platforms.DESCRIPTION.modelVariables),
        compiler=said("c++", "--version"),
        old=old and old[0],
        wine=said(wine, "--version"),
        qemu=said("qemu-aarch64", "--version").replace("qemu-aarch64 version", "qemu"),
        run=platforms.table(run),
        different=different,
        **found,
    )
    report = ROOT / "docs" / "results" / "platforms.md"
    report.write_text(page, encoding="utf-8")
    if different:
        raise SystemExit(f"The trajectories differ between platforms: {different}; see {report}")
    step("the site and the folder")
    subprocess.run(["./scripts/site"], check=True)
    step("done")
    print("What was run and what was only built: docs/results/platforms.md.")
    folder.publish(released, ROOT / "build" / "site")


if __name__ == "__main__":
    main()
