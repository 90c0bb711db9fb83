"""Configures and builds one preset of CMakePresets.json: ./scripts/build [PRESET [CMAKE OPTION...]], release if none is
given. It shows its progress; the compiler's output is in build/PRESET.log."""

import json
import os
import re
import sys
from subprocess import PIPE, STDOUT

from wheelfmu.commands import processes
from wheelfmu.fmu.outputs import alone, deliver
from wheelfmu.fmu.paths import ROOT, without_stale_cache
from wheelfmu.fmu.values import Fault, suggestion

SOURCES = ("WHEEL_SUNDIALS_SOURCE", "WHEEL_LIBM_SOURCE")


def presets() -> list[str]:
    return [of["name"] for of in json.loads((ROOT / "CMakePresets.json").read_text())["buildPresets"]]


def reads(words: list[str]) -> list[str]:
    if {"-h", "--help"} & {*words}:
        print(__doc__)
        sys.exit()
    preset = words[0] if words else "release"
    if preset not in presets():
        meant = suggestion(preset, dict.fromkeys(presets(), ""))
        raise Fault(f'there is no preset "{preset}"; there are {", ".join(presets())}.{meant}')
    return words or [preset]


def needs(given: list[str]) -> list[str]:
    return [preset for preset in given[:1] if preset in ("asan", "tidy")]


def build(preset: str, *options: str) -> None:
    """The folder build/PRESET; Failed if it fails."""
    folder = ROOT / "build" / preset
    log = folder.with_suffix(".log")
    given = [f"-D{name}={os.environ[name]}" for name in SOURCES if os.environ.get(name)]
    with alone(folder):
        without_stale_cache(folder, ROOT)
        steps = (
            ["--preset", preset, *given, *options],
            ["--build", "--preset", preset, "--parallel", str(os.cpu_count())],
        )
        with log.open("w") as file:
            for step in steps:
                cmake = processes.start(
                    "cmake", *step, cwd=ROOT, stdout=PIPE, stderr=STDOUT, text=True, errors="replace"
                )
                due = show(preset, cmake, file)
                if cmake.wait():
                    file.flush()
                    print(*log.read_text(errors="replace").splitlines()[-60:], sep="\n", file=sys.stderr)
                    print(f"The build of preset {preset} failed; the whole log is {log}.", file=sys.stderr)
                    raise processes.Failed(1)
    print(f"{due}Built preset {preset}.", flush=True)


def show(preset: str, cmake, file) -> str:  # noqa: ANN001 - a program and its log
    """Prints how far a program is, per cent on a terminal, else quarters; returns what clears the line."""
    due, terminal = 0, sys.stdout.isatty()
    for line in cmake.stdout:
        file.write(line)
        found = re.match(r"\[ *(\d+)%\] Building", line)
        if found and (done := int(found[1])) >= due:
            print(f"Building preset {preset}: {done} %", end="\033[K\r" if terminal else "\n", flush=True)
            due = done + 1 if terminal else done - done % 25 + 25
    return "\033[K" * terminal


def fmu() -> None:
    """wheel.fmu in the project's folder, if there is none yet."""
    if not (ROOT / "wheel.fmu").exists():
        build("release")
        deliver(ROOT / "build" / "release" / "wheel.fmu", ROOT / "wheel.fmu")


def main(given: list[str]) -> None:
    build(*given)
