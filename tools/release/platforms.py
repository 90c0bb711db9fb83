"""Runs ten scenes on every platform that this machine can run.

The driver (driver.c) is compiled by zig for each platform; Windows runs under wine, arm under qemu, WebAssembly
in wasmtime. macOS is only built. Scenes of the paper, SI units.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import fmpy
import wasmtime

from publishing import markdown
from release.compiling import ROOT, compiler, wasm
from release.fmu import ARM, LINUX, WINDOWS

DESCRIPTION = fmpy.read_model_description(str(ROOT), validate=False)
Scenes = dict[str, str]  # the digest of each scene's trajectory, all bits


def build_driver(platform: str, out: Path) -> Path:
    driver = out / platform / ("driver.exe" if platform == WINDOWS else "driver")
    headers = (Path(fmpy.__file__).parent / "c-code", ROOT / "tests" / "support", out / platform / "generated")
    system = [] if platform == WINDOWS else ["-ldl"]
    source = [f"-I{folder}" for folder in headers] + [ROOT / "tools" / "release" / "driver.c"]
    subprocess.run([compiler() / "zig", "cc", "-target", platform, "-O1", *source, "-o", driver, *system], check=True)
    return driver


def run(*command: str | Path) -> str:
    """What a driver prints."""
    done = subprocess.run([*command, DESCRIPTION.guid], capture_output=True, text=True, timeout=900, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))} failed: {done.stderr[-500:]}")
    return done.stdout


def run_wasm(program: Path) -> str:
    """What a WebAssembly program of WASI prints in wasmtime."""
    printed = program.with_suffix(".out")
    configuration = wasmtime.WasiConfig()
    configuration.argv = [program.name, "linked in", DESCRIPTION.guid]
    configuration.stdout_file = str(printed)
    configuration.inherit_stderr()
    store = wasmtime.Store()
    store.set_wasi(configuration)
    linker = wasmtime.Linker(store.engine)
    linker.define_wasi()
    start = linker.instantiate(store, wasmtime.Module.from_file(store.engine, str(program))).exports(store)["_start"]
    try:
        start(store)
    except wasmtime.ExitTrap as ended:
        if ended.code:
            raise SystemExit(f"{program} ended with status {ended.code}.") from ended
    return printed.read_text()


def printed(out: Path, wine: str, old: tuple[str, Path] | None) -> Iterator[tuple[str, str]]:
    """The name of each place where a library runs, and what the driver prints there."""
    linux, arm, windows = (build_driver(platform, out) for platform in (LINUX, ARM, WINDOWS))
    library = out / LINUX / "wheel.so"
    yield "linux64", run(linux, library)
    if old:
        name, libc = old
        yield f"linux64, {name}", run(libc / "ld-linux-x86-64.so.2", "--library-path", libc, linux, library)
    yield "this machine's compiler", run(linux, ROOT / "build" / "release" / "wheel.so")
    yield "win64, wine", run(wine, windows, out / WINDOWS / "wheel.dll")
    yield "aarch64-linux, qemu", run("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu", arm, out / ARM / "wheel.so")
    yield "wasm32, wasmtime", run_wasm(wasm(out / "wasm32-wasi", "wheel_driver"))


def scenes(*place: object) -> dict[str, Scenes]:
    return {name: dict(line.split("\t") for line in text.splitlines()) for name, text in printed(*place)}


def table(run: dict[str, Scenes]) -> str:
    """A row for each scene; the digest on the first platform, and on each other one whether it is equal."""
    first, *others = run.values()
    rows = []
    for scene, digest in first.items():
        rows.append([scene, digest, *("equal" if other[scene] == digest else other[scene] for other in others)])
    return markdown.table(["scene", *run], rows)
