"""Runs a release on every platform that this machine can run: Windows under wine, arm under qemu, WebAssembly in
wasmtime. macOS is only built: its drivers, and that for Windows, are left for machines of a forge. Scenes of the paper,
SI units.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import fmpy
import wasmtime
from tabulate import tabulate

from wheelfmu.fmu.paths import ROOT
from wheelfmu.release.compiling import WASM, build
from wheelfmu.release.fmu import ARM, ARM_MAC, INTEL_MAC, LINUX, WINDOWS

DESCRIPTION = fmpy.read_model_description(str(ROOT), validate=False)
OUTPUTS = [v.name for v in DESCRIPTION.modelVariables if v.causality == "output" and v.type == "Real"]
WINE = shutil.which("wine64") or "/usr/lib/wine/wine64"


def run(*command: str | Path) -> str:
    """What a driver prints (driver.c)."""
    done = subprocess.run([*command, DESCRIPTION.guid], capture_output=True, text=True, timeout=900, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))} failed: {done.stderr[-500:]}")
    return done.stdout


def run_wasm(program: Path) -> str:
    """The same in wasmtime; an exit status other than 0 raises wasmtime.ExitTrap."""
    printed = program.with_suffix(".out")
    configuration = wasmtime.WasiConfig()
    configuration.argv = [program.name, "linked in", DESCRIPTION.guid]
    configuration.stdout_file = printed
    configuration.inherit_stderr()
    store = wasmtime.Store()
    store.set_wasi(configuration)
    linker = wasmtime.Linker(store.engine)
    linker.define_wasi()
    begin = linker.instantiate(store, wasmtime.Module.from_file(store.engine, program)).exports(store)["_start"]
    assert isinstance(begin, wasmtime.Func)
    begin(store)
    return printed.read_text()


def printed(out: Path) -> Iterator[tuple[str, str]]:
    """The name of each place where a library runs, and what the driver prints there."""
    for platform in (LINUX, ARM, WINDOWS, WASM):
        build(out / platform, platform, "wheel_driver")
    driver, library = out / LINUX / "wheel_driver", out / LINUX / "wheel.so"
    yield "linux64", run(driver, library)
    yield "this machine's compiler", run(driver, ROOT / "build" / "release" / "wheel.so")
    # Only in a UTF-8 locale does wine find a folder whose name is not ASCII. Its first start makes its own.
    os.environ |= {"WINEPREFIX": f"{out}/wine", "WINEDEBUG": "-all", "LC_ALL": "C.UTF-8"}
    subprocess.run([WINE, "wineboot", "--init"], capture_output=True, check=False)
    yield "win64, wine", run(WINE, out / WINDOWS / "wheel_driver.exe", out / WINDOWS / "wheel.dll")
    arm = ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu", out / ARM / "wheel_driver", out / ARM / "wheel.so")
    yield "aarch64-linux, qemu", run(*arm)
    yield "wasm32, wasmtime", run_wasm(out / WASM / "wheel_driver.wasm")


def leave_drivers(out: Path, hashes: str) -> None:
    """out/drivers, for .github/workflows/release.yml: a driver by the name of its platform, and what it must print."""
    folder = out / "drivers"
    folder.mkdir(exist_ok=True)
    (folder / "hashes.txt").write_text(hashes, encoding="utf-8")
    for name, platform in {"win64.exe": WINDOWS, "darwin64": INTEL_MAC, "aarch64-darwin": ARM_MAC}.items():
        build(out / platform, platform, "wheel_driver")
        shutil.copy((out / platform / "wheel_driver").with_suffix(Path(name).suffix), folder / name)


def scenes(out: Path) -> dict[str, object]:
    """For the page: the platforms, each scene's digest on the first of them, and where another one has another."""
    texts = dict(printed(out))
    leave_drivers(out, texts["linux64"])
    digests = {place: dict(line.split("\t") for line in text.splitlines()) for place, text in texts.items()}
    first = digests["linux64"]
    different = [f"{s} on {place}" for place, found in digests.items() for s in first if found[s] != first[s]]
    run = tabulate(first.items(), ["scene", "hash"], "pipe", disable_numparse=True)
    return {"run": run, "places": [*digests], "different": different}
