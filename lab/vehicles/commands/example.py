"""Builds, runs and draws a vehicle made of FMUs, or the wheel for a control engineer. Prints a verdict;
results/examples/ has all of it. Exit status 1: the manoeuvre failed."""

import sys

from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.outputs import alone
from wheelfmu.fmu.paths import ROOT


def usage(words: list[str]) -> str:
    from lab.vehicles import options

    return options.usage(*words)


def reads(words: list[str]) -> list[str]:
    from lab.vehicles import options

    options.asked(*words)
    return words


def needs(given: list[str]) -> list[str]:
    return ["vehicles"] * (given[0] == "control")


def main(given: list[str]) -> int:
    build("release")
    with alone(ROOT / "results" / "examples"):
        if given[0] == "control":
            program = ROOT / "lab" / "vehicles" / "control.py"
            return processes.status(
                sys.executable, "-P", program, "build/release/wheel.fmu", "results/examples/control"
            )
        from lab.vehicles.example import main as run

        return run(given)
