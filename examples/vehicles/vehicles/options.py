"""What ./scripts/example takes: NAME [parameter=value ...], checked before anything is built or installed.

Names, units, start values and limits are those of the examples' tables of variables. It needs the standard library
alone; numbers may carry a unit, as in h=1ms, v=40km/h, k=60kN/m.
"""

from __future__ import annotations

import math
import re
import sys
import tomllib
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(EXAMPLES / "skeleton"))
from describe import Variable, read  # noqa: E402

SCALES = {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "m": 1.0, "mm": 1e-3, "deg": math.pi / 180, "rad": 1.0, "kg": 1.0,
          "N": 1.0, "kN": 1e3, "N/m": 1.0, "kN/m": 1e3, "Nm": 1.0, "m/s": 1.0, "km/h": 1 / 3.6}  # fmt: skip
_NUMBER = re.compile(r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)([a-zA-Z/%]*)", re.IGNORECASE)
SCENES = ("straight", "clothoid", "trailing", "rolling_out")
MANOEUVRES = ("straight", "circle", "step", "eight", "lane", "hill", "too_fast")
EXCHANGES = ("held", "derivatives", "rollback")
TABLES = {"axle": "axle/axle.csv", "chassis": "car/chassis.csv", "driver": "car/driver.csv"} | {
    "quarter_car": "quarter_car/quarter_car.csv"
}
LAYOUTS = {"axle": "axle/axle.toml", "chassis": "car/car.toml"}
Values = dict[str, str | float]


class Refused(Exception):  # noqa: N818 - one sentence for the user
    """The command line asks for something that does not exist, or for a value that is not allowed."""


@dataclass(frozen=True)
class Example:
    """`words`: what a name may be; `own`: of the run, not of an FMU; `models`: whose parameters may be given."""

    about: str
    words: dict[str, tuple[str, ...]]
    own: dict[str, Variable]
    models: tuple[str, ...]


def _own(**rows: str) -> dict[str, Variable]:
    """Numbers of a run, each "unit limit meaning"; - is no limit."""
    parts = {name: row.split(" ", 2) for name, row in rows.items()}
    return {
        name: Variable("parameter", name, unit, math.nan, limit.strip("-"), (), meaning)
        for name, (unit, limit, meaning) in parts.items()
    }


STEP = {"h": "s >0 Communication step"}
FIXED = {"R", "g", "inner_step", "psi_start", "v_start", "omega_start"}  # of the wheels too, or set by the run
LIST = {
    "axle": Example(
        "Two wheels on one rigid beam: how stiff is too stiff",
        {"scene": SCENES, "exchange": EXCHANGES},
        _own(
            **STEP,
            stop="s >0 End of the run",
            v="m/s - Speed at the start",
            omega="rad/s - Yaw rate at the start",
            s="m >=0 Coefficient of rolling friction of the wheels",
            stiffness="1 >0 Factor on all stiffnesses and dampings",
        ),
        ("axle",),
    ),
    "car": Example(
        "A chassis on four wheels, and a driver",
        {"manoeuvre": MANOEUVRES, "exchange": EXCHANGES},
        _own(**STEP, stop="s >0 End of the run", v="m/s >=0 Speed at the start"),
        ("chassis", "driver"),
    ),
    "suspended": Example(
        "A quarter car on its wheel, launched from rest",
        {"exchange": EXCHANGES},
        _own(
            **STEP,
            stop="s >0 End of the run",
            k="N/m >=0 Stiffness along X and Y: k_h",
            c="N.s/m >=0 Damping along X and Y: c_h",
        ),
        ("quarter_car",),
    ),
    "balance": Example("A controller in Python holds up a wheel that alone would fall", {}, {}, ("balance",)),
    "control": Example(
        "For a control engineer: linearization, regulator, optimal control; without parameters", {}, {}, ()
    ),
}


def in_table(model: str) -> list[Variable]:
    """The parameters of a model in C."""
    layout = tomllib.loads((EXAMPLES / LAYOUTS[model]).read_text()) if model in LAYOUTS else {}
    return [v for v in read(model, EXAMPLES / TABLES[model], layout)[1] if v.causality == "parameter"]


def starts(model: str) -> dict[str, float]:
    """Their start values by name."""
    return {v.name: v.start for v in in_table(model)}


def parameters(model: str) -> dict[str, Variable]:
    """The parameters of a model that a user may set, from its table; those of balance.fmu from its list in Python."""
    if model == "balance":
        text = (EXAMPLES / "balance" / "balance.py").read_text()
        rows = re.findall(r'^    "(\w+)": ([-\d.]+),  # (\S+?)(?:, (.*))?$', text, re.MULTILINE)
        return {n: Variable("parameter", n, unit, float(start), "", (), about) for n, start, unit, about in rows}
    fixed = FIXED | ({"slope_direction"} if model == "axle" else set())
    return {v.name: v for v in in_table(model) if v.name not in fixed}


def known(example: Example) -> dict[str, Variable]:
    """All numbers that the example takes, those of a run first."""
    of_models = {name: variable for model in example.models for name, variable in parameters(model).items()}
    return {**example.own, **{name: v for name, v in of_models.items() if name not in example.own}}


def number(name: str, text: str) -> float:
    """The value in SI units."""
    match = _NUMBER.fullmatch(text)
    if not match or match[2] not in (*SCALES, "%"):
        raise Refused(f"{name}={text} is not a number with one of the units {', '.join(filter(None, SCALES))} or %.")
    try:
        if match[2] == "%":  # of a slope
            return math.atan(float(match[1]) / 100)
        return float(match[1]) * SCALES[match[2]]
    except ValueError:
        raise Refused(f"{name}={text} is not a number.") from None


def allowed(variable: Variable, value: float) -> float:
    """The value, or the sentence that the FMU itself would say."""
    if (variable.limit == ">0" and not value > 0) or (variable.limit == ">=0" and not value >= 0):
        limit = "above" if variable.limit == ">0" else "at least"
        raise Refused(f"{variable.name} = {value:g}: it must be {limit} 0 {variable.unit}.")
    return value


def values(example: Example, arguments: list[str]) -> Values:
    """The options by name."""
    numbers, given = known(example), {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals:
            raise Refused(f'"{argument}" is not of the form name=value; --help lists the names.')
        if name in example.words:
            if text not in example.words[name]:
                raise Refused(f"{name} is one of {', '.join(example.words[name])}, not {text}.")
            given[name] = text
        elif name in numbers:
            given[name] = allowed(numbers[name], number(name, text))
        else:
            if not numbers:
                raise Refused(f"{argument}: this example takes no parameters.")
            near = get_close_matches(name, [*example.words, *numbers], 5, 0.3) or list(numbers)[:8]
            raise Refused(f"There is no parameter {name} here; there are, for example, {', '.join(near)}.")
    if given.get("stop", math.inf) < given.get("h", 0.0):
        raise Refused(f"stop = {given['stop']:g}: it must be at least the step h, {given['h']:g} s.")
    return given


def usage(name: str) -> str:
    """All that one example takes, or the list of the examples."""
    if name not in LIST:
        rows = [f"  {name:11s}{example.about}" for name, example in LIST.items()]
        line = f"./scripts/example {'|'.join(LIST)} [parameter=value ...]   a vehicle made of FMUs, run and drawn"
        return "\n".join([line, *rows, "./scripts/example NAME --help lists the parameters of one example."])
    words = [f"  {word}={'|'.join(choices)}" for word, choices in LIST[name].words.items()]
    rows = [
        f"  {v.name:16s}{v.unit:10s}{'' if math.isnan(v.start) else f'{v.start:g}':>9s} {v.limit:>4s}  {v.description}"
        for v in known(LIST[name]).values()
    ]
    return "\n".join([f"./scripts/example {name} [parameter=value ...]   {LIST[name].about}", *words, *rows])


def asked(arguments: list[str]) -> tuple[str, Values]:
    """Name and values of the example that the command line asks for."""
    name, *rest = arguments or [""]
    if name not in LIST:
        near = get_close_matches(name, LIST, 1, 0.3)
        mean = f"; did you mean {near[0]}?" if near else "."
        raise Refused(f'"{name}" is no example; there are {", ".join(LIST)}{mean}' if name else usage(""))
    return name, values(LIST[name], rest)


def main() -> int:
    arguments = sys.argv[1:]
    if {"-h", "--help"} & set(arguments):
        print(usage(arguments[0]))
        return 0
    try:
        asked(arguments)
    except Refused as reason:
        print(reason, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
