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

DESCRIPTION = Path(__file__).resolve().parents[2] / "modelDescription.xml"
DEGREE = math.pi / 180
USAGE = """./scripts/run [name=value ...]   build, simulate without and with rolling friction, draw the diagrams

  ./scripts/run                             the paper's two scenes
  ./scripts/run s=0.01 theta_start=60deg    other values; the scene without friction takes them too, but for s
  ./scripts/run stop_time=20                longer than 10 s

Results go into results/: wheel.html, the motion to play and to turn; the diagrams; free.csv and friction.csv.
Angles and their rates may end in deg.
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
    low: str
    high: str
    description: str


def variables() -> Iterator[Variable]:
    for row in ElementTree.parse(DESCRIPTION).getroot().iter("ScalarVariable"):
        (typed,) = row
        texts = [typed.get(attribute, "") for attribute in ("unit", "start", "min", "max")]
        yield Variable(row.get("name", ""), row.get("causality", ""), typed.tag, *texts, row.get("description", ""))


def parameters() -> dict[str, Variable]:
    return {v.name: v for v in variables() if v.causality == "parameter"}


def usage(known: dict[str, Variable]) -> str:
    rows = [f"  {v.name:16s}{v.unit:8s}{v.start:>22s}   {v.description}" for v in known.values()]
    return "\n".join([USAGE, *rows])


def number_of(name: str, text: str) -> tuple[float, str]:
    """The number in SI, and as text for FMPy."""
    match = re.fullmatch(r"(.+?)\s*(deg)?", text)
    try:
        number = float(match[1]) * (DEGREE if match[2] else 1)
        whole = number == int(number) and not match[2]
    except (TypeError, ValueError, OverflowError):
        raise Fault(f'{name} = "{text}" is not a number.') from None
    return number, repr(int(number)) if whole else repr(number)


def value_of(variable: Variable, text: str) -> str:
    """The value in SI as text; Fault outside of the limits that the description sets."""
    if variable.type == "Boolean":
        if text not in ("true", "false"):
            raise Fault(f'{variable.name} = "{text}" must be true or false.')
        return text
    number, short = number_of(variable.name, text)
    above = variable.description.endswith("above 0") or ", above 0;" in variable.description
    low, high = float(variable.low or "-inf"), float(variable.high or "inf")
    if not (low < number if above else low <= number) or not number <= high or not math.isfinite(number):
        limits = [f"{'above' if above else 'at least'} {low:g}"] * math.isfinite(low) + [
            f"at most {high:g}"
        ] * math.isfinite(high)
        raise Fault(f"{variable.name} = {number:g} must be {' and '.join(limits) or 'finite'}.")
    if variable.type == "Integer" and number != int(number):
        raise Fault(f"{variable.name} = {number:g} must be a whole number.")
    return short


def pairs(arguments: list[str], known: dict[str, Variable]) -> dict[str, str]:
    stop = Variable("stop_time", "parameter", "Real", "s", "10", "0", "", "End of the runs, above 0")
    values = {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals:
            raise Fault(f'"{argument}" is not of the form name=value; ./scripts/run --help lists the names.')
        if name not in known and name != stop.name:
            raise Fault(f'wheel.fmu has no parameter "{name}"; ./scripts/run --help lists the names.')
        values[name] = value_of(known.get(name, stop), text)
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
