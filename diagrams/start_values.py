"""Turns arguments such as `s=0.01 theta_start=60deg` into checked start values of wheel.fmu, for ./scripts/run.

Prints `name value` pairs in SI for `fmpy simulate --start-values`, one a line; `outputs` prints the variables to
record, start values among them, so that a figure can say what was run. Names, units and start values are those of
modelDescription.xml. It needs no package, so that `--help` works before anything is installed.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

DESCRIPTION = Path(__file__).resolve().parent.parent / "modelDescription.xml"
DEGREE = math.pi / 180
USAGE = """./scripts/run [name=value ...]   build, simulate without and with rolling friction, draw the diagrams

  ./scripts/run                             the paper's two scenes
  ./scripts/run s=0.01 theta_start=60deg    other values; the scene without friction takes them too, but for s
  ./scripts/run stop_time=20                longer than 10 s

Results go into results/: free.csv, friction.csv, and the diagrams. Angles and their rates may end in deg.
The values that can be given (SI; docs/variables.md):
"""


class Fault(Exception):
    """The message is one sentence for the user."""


class Variable(NamedTuple):
    name: str
    causality: str
    type: str
    unit: str
    start: str
    description: str


def variables() -> Iterator[Variable]:
    for row in ElementTree.parse(DESCRIPTION).getroot().iter("ScalarVariable"):
        (typed,) = row
        texts = (typed.get("unit", ""), typed.get("start", ""), row.get("description", ""))
        yield Variable(row.get("name", ""), row.get("causality", ""), typed.tag, *texts)


def parameters() -> dict[str, Variable]:
    return {v.name: v for v in variables() if v.causality == "parameter"}


def usage(known: dict[str, Variable]) -> str:
    rows = [f"  {v.name:16s}{v.unit:8s}{v.start:>22s}   {v.description}" for v in known.values()]
    return "\n".join([USAGE, *rows])


def value_of(name: str, text: str) -> str:
    """The number in SI as text."""
    match = re.fullmatch(r"(.+?)\s*(deg)?", text)
    try:
        number = float(match[1]) * (DEGREE if match[2] else 1)
    except (TypeError, ValueError):
        if text in ("true", "false"):
            return text
        raise Fault(f'{name} = "{text}" is not a number.') from None
    return repr(int(number)) if number == int(number) and not match[2] else repr(number)


def pairs(arguments: list[str], known: dict[str, Variable]) -> dict[str, str]:
    values = {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals:
            raise Fault(f'"{argument}" is not of the form name=value; ./scripts/run --help lists the names.')
        if name not in known and name != "stop_time":
            raise Fault(f'wheel.fmu has no parameter "{name}"; ./scripts/run --help lists the names.')
        values[name] = value_of(name, text)
    if float(values.get("s", 1)) <= 0:
        raise Fault("s must be above 0 here: the scene without friction is drawn beside it anyway.")
    return values


def outputs() -> list[str]:
    """All that a figure or a page may need: outputs, energy, friction, and the values that were set."""
    return [
        v.name
        for v in variables()
        if v.causality == "output"
        or v.name in ("E", "friction_mode", "n_events")
        or (v.causality == "parameter" and v.type == "Real")
    ]


def main() -> int:
    arguments = sys.argv[1:]
    if arguments == ["outputs"]:
        print("\n".join(outputs()))
        return 0
    known = parameters()
    if {"-h", "--help"} & set(arguments):
        print(usage(known))
        return 0
    try:
        print("\n".join(f"{name} {value}" for name, value in pairs(arguments, known).items()))
    except Fault as fault:
        print(f"run: {fault}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
