"""Builds and runs a vehicle of examples/vehicles, or the wheel for a control engineer: NAME is one of"""

import sys
from argparse import Namespace
from functools import partial

from lab.vehicles.manoeuvres import EXAMPLES, MANOEUVRES
from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.files import alone
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, one_of

CONTROL = ROOT / "lab" / "vehicles" / "control.py"
# Each example that is here.
NAMES = {"car": "four wheels, a chassis and a driver", "suspended": "a quarter car on its wheel"}
NAMES = NAMES if (EXAMPLES / "package.py").exists() else {}
NAMES |= {"control": "the wheel: linearization, regulator, optimal control"} if CONTROL.exists() else {}
ABOUT = [f"  {name:10s}{about}" for name, about in NAMES.items()]
if "car" in NAMES:
    ABOUT += ["", "The car's MANOEUVRE is one of", ""]
    ABOUT += [f"  {name:10s}{run.title}" for name, run in MANOEUVRES.items()]
__doc__ = "\n".join([__doc__, "", *ABOUT])


def example(typed: str) -> str:
    """A name; Fault if there is none such."""
    if not NAMES:
        raise Fault(f'there is no example "{typed}"; examples/vehicles and control.py are not here.')
    return one_of(NAMES, typed, "example")


OPTIONS = {
    "name": {"metavar": "NAME", "type": example},
    "manoeuvre": {
        "metavar": "MANOEUVRE",
        "nargs": "?",
        "type": partial(one_of, MANOEUVRES, kind="manoeuvre"),
        "help": "of the car; if not given, lane",
    },
}


def needs(given: Namespace) -> list[str]:
    if given.manoeuvre and given.name != "car":
        raise Fault(f"{given.name} has no manoeuvres: leave {given.manoeuvre} out.")
    return ["vehicles"] * (given.name == "control")


def main(given: Namespace) -> int:
    build("release")
    with alone(ROOT / "results" / "examples"):
        if given.name == "control":
            words = CONTROL, "build/release/wheel.fmu", "results/examples/control"
            return processes.status(sys.executable, "-P", *words)
        from lab.vehicles.example import main as run

        return run(given.name, given.manoeuvre or "lane")
