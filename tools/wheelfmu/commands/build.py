"""Compiles wheel.fmu into build/PRESET.

  ./scripts/build [PRESET [CMAKE OPTION...]]

PRESET: release (if none is given), or another of CMakePresets.json: dev, debug, asan, tidy, coverage, constants. The
output of the compiler is in build/PRESET.log."""

import json
import os

from wheelfmu.fmu import building
from wheelfmu.fmu.files import deliver
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import one_of

SOURCES = ("WHEEL_SUNDIALS_SOURCE", "WHEEL_LIBM_SOURCE")


def presets() -> list[str]:
    return [of["name"] for of in json.loads((ROOT / "CMakePresets.json").read_text())["buildPresets"]]


def usage(_words: list[str]) -> str:
    return __doc__ or ""


def reads(words: list[str]) -> list[str]:
    preset, *options = words or ["release"]
    return [one_of(presets(), preset, "preset"), *options]


def needs(given: list[str]) -> list[str]:
    return [preset for preset in given[:1] if preset in ("asan", "tidy")]


def build(preset: str, *options: str) -> None:
    """The folder build/PRESET."""
    given = [f"-D{name}={os.environ[name]}" for name in SOURCES if os.environ.get(name)]
    configure = ["--preset", preset, *given, *options]
    building.build(f"preset {preset}", ROOT / "build" / preset, ROOT, configure, ["--preset", preset])
    print(f"Built preset {preset}.", flush=True)


def fmu() -> None:
    """wheel.fmu in the project's folder, if there is none yet."""
    if not (ROOT / "wheel.fmu").exists():
        build("release")
        deliver(ROOT / "build" / "release" / "wheel.fmu", ROOT / "wheel.fmu")


def main(given: list[str]) -> None:
    build(*given)
