"""Runs clang-tidy over fmu-src, file by file, as clang compiles it. The checks are in .clang-tidy."""

import os
import sys
from argparse import Namespace
from pathlib import Path
from subprocess import STDOUT

from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.paths import ROOT

NEEDS = ("tidy",)


def main(_given: Namespace) -> None:
    build("tidy")
    log = ROOT / "build" / "tidy.log"
    program = Path(sys.executable).with_name("run-clang-tidy.py")
    words = [program, "-quiet", "-j", str(os.cpu_count()), "-p", "build/tidy", "/fmu-src/.*"]
    with log.open("w") as file:
        code = processes.status(*words, stdout=file, stderr=STDOUT)
    if code:
        lines = log.read_text(errors="replace").splitlines()
        print(*(line for line in lines if not line.startswith("[")), sep="\n", file=sys.stderr)
        raise processes.Failed(1)
    print("clang-tidy found nothing in fmu-src.")
