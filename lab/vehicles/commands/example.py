"""Drives the car of examples/vehicles through a manoeuvre, or runs the wheel for a control engineer: NAME is one of"""

import sys
from argparse import Namespace

from lab.vehicles.manoeuvres import EXAMPLES, MANOEUVRES
from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.outputs import alone
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, suggestion

CONTROL = ROOT / "lab" / "vehicles" / "control.py"
# Each example that is here.
NAMES = {name: f"the car, {run.title}" for name, run in MANOEUVRES.items() if (EXAMPLES / "package.py").exists()}
NAMES |= {"control": "the wheel: linearization, regulator, optimal control"} if CONTROL.exists() else {}
__doc__ = "\n".join([__doc__, "", *(f"  {name:10s}{about}" for name, about in NAMES.items())])


def example(name: str) -> str:
    """A name; Fault if there is none such."""
    if name not in NAMES:
        there = f"there are {', '.join(NAMES)}." if NAMES else "examples/vehicles and control.py are not here."
        raise Fault(f'there is no example "{name}"; {there}{suggestion(name, dict.fromkeys(NAMES, ""))}')
    return name


OPTIONS = {"name": {"metavar": "NAME", "type": example}}


def needs(given: Namespace) -> list[str]:
    return ["vehicles"] * (given.name == "control")


def main(given: Namespace) -> int:
    build("release")
    with alone(ROOT / "results" / "examples"):
        if given.name == "control":
            words = CONTROL, "build/release/wheel.fmu", "results/examples/control"
            return processes.status(sys.executable, "-P", *words)
        from lab.vehicles.example import main as run

        return run(given.name)
