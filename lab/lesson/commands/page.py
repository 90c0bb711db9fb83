"""Writes the lesson, in which the wheel runs in a browser. One offline file, which opens by a double click, contains
wheel.fmu's sources compiled to WebAssembly with the releases' compiler; its trajectories are bit-identical to the
released FMU's (lab/lesson/README.md)."""

from argparse import Namespace
from pathlib import Path

from wheelfmu.fmu.paths import ROOT

STAYS, NEEDS = True, ("lesson", "release")
OPTIONS = {
    "file": {
        "nargs": "?",
        "type": Path,
        "default": ROOT / "results" / "wheel_lesson.html",
        "metavar": "FILE",
        "help": "if not given, results/wheel_lesson.html",
    },
    "--overwrite": {"action": "store_true", "help": "replaces FILE even if this command did not write it"},
}


def main(given: Namespace) -> None:
    from lab.lesson.writing import live
    from wheelfmu.release import compiling

    folder = ROOT / "build" / "wasm"
    compiling.build(folder, compiling.WASM, "wheel_page")
    live(folder / "wheel_page.wasm", given.file, overwrite=given.overwrite)
