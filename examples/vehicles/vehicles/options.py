"""What ./scripts/example takes: NAME [parameter=value ...], checked before anything is built or installed.

A vehicle's runs are the tables of its manoeuvres.toml; names, units, start values and limits of parameters are those of
the tables of variables. It needs the standard library alone; numbers may carry a unit, as in h=1ms, v=40km/h, k=60kN/m.
"""

from __future__ import annotations

import math
import re
import signal
import sys
import tomllib
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cache
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(EXAMPLES / "skeleton"))
from describe import Variable, read  # noqa: E402

SCALES = {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "m": 1.0, "mm": 1e-3, "deg": math.pi / 180, "rad": 1.0, "kg": 1.0,
          "N": 1.0, "kN": 1e3, "N/m": 1.0, "kN/m": 1e3, "Nm": 1.0, "m/s": 1.0, "km/h": 1 / 3.6}  # fmt: skip
_NUMBER = re.compile(r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)([a-zA-Z/%]*)", re.IGNORECASE)
EXCHANGES = ("held", "derivatives", "rollback")
FOLDERS = {"axle": "axle", "car": "car", "suspended": "quarter_car", "balance": "balance"}
CONTROL = "For a control engineer: linearization, regulator, optimal control; without parameters"
MODELS = {"axle": "axle", "quarter_car": "quarter_car", "chassis": "car", "driver": "car"}  # in C, and their folders
FIXED = {"R", "g", "inner_step", "psi_start", "v_start", "omega_start"}  # of the wheels too, or set by the run


class Refused(Exception):  # noqa: N818 - one message for the user
    """The command line asks for something that does not exist, or for a value that is not allowed."""


def number(name: str, text: str | float) -> float:
    """The value in SI units."""
    match = _NUMBER.fullmatch(str(text))
    if not match or match[2] not in (*SCALES, "%"):
        raise Refused(f"{name}={text} is not a number with one of the units {', '.join(filter(None, SCALES))} or %.")
    try:
        if match[2] == "%":  # of a slope
            return math.atan(float(match[1]) / 100)
        return float(match[1]) * SCALES[match[2]]
    except ValueError:
        raise Refused(f"{name}={text} is not a number.") from None


@cache
def file(vehicle: str) -> dict:
    """A vehicle's manoeuvres.toml."""
    return tomllib.loads((EXAMPLES / FOLDERS[vehicle] / "manoeuvres.toml").read_text())


@cache
def parameters(model: str) -> dict[str, Variable]:
    """The parameters of a model by name: in C from its table, those of balance.fmu from its list in Python."""
    if model == "balance":
        text = (EXAMPLES / "balance" / "balance.py").read_text()
        rows = re.findall(r'^    "(\w+)": ([-\d.]+),  # (\S+?)(?:, (.*))?$', text, re.MULTILINE)
        return {n: Variable("parameter", n, unit, float(start), "", (), about) for n, start, unit, about in rows}
    folder = EXAMPLES / MODELS[model]
    layout = folder / f"{folder.name}.toml"
    of = tomllib.loads(layout.read_text()) if layout.exists() else {}
    return {v.name: v for v in read(model, folder / f"{model}.csv", of)[1] if v.causality == "parameter"}


def starts(model: str) -> dict[str, float]:
    """Their start values."""
    return {name: v.start for name, v in parameters(model).items()}


@cache
def every(vehicle: str) -> dict[str, Variable]:
    """All parameters of a vehicle: of the run and the wheels first, then those of its models."""
    rows = file(vehicle).get("parameters", {}).items()
    own = {name: Variable("parameter", name, unit, x, limit, (), about) for name, (unit, x, limit, about) in rows}
    return own | {n: v for model in file(vehicle)["models"] for n, v in parameters(model).items() if n not in own}


@dataclass(frozen=True)
class Manoeuvre:
    """One run of a vehicle: inputs, end, verdict and picture, as its manoeuvres.toml has them."""

    vehicle: str
    name: str
    title: str
    stop: float = math.nan  # s
    given: dict[str, float] | None = None  # parameters that differ from their start values
    ends: tuple[str, ...] = ()
    judges: tuple[str, ...] = ()
    figures: str = ""
    plot: tuple[str | list[str], ...] = ()

    def __getitem__(self, name: str) -> float:
        return self.given[name] if name in self.given else every(self.vehicle)[name].start

    def followed(self, name: str) -> str:
        """The parameter whose value an unset one takes: the driver keeps the speed at the start."""
        return "v" if name in ("v_0", "v_1") and name not in self.given else name

    def changed(self, **values: float) -> Manoeuvre:
        """With other parameters, or another stop."""
        return replace(self, stop=values.pop("stop", self.stop), given={**self.given, **values})

    def of(self, model: str) -> dict[str, float]:
        """The parameters given of one model."""
        return {name: x for name, x in self.given.items() if name in parameters(model)}


@cache
def manoeuvres(vehicle: str) -> dict[str, Manoeuvre]:
    """By name."""
    found = {}
    for name, of in file(vehicle)["manoeuvre"].items():
        given = {n: number(n, x) for n, x in of.get("given", {}).items()}
        stop = of["stop"] if "stop" in of else every(vehicle)["stop"].start
        found[name] = Manoeuvre(vehicle, name, **{**of, "stop": stop, "given": given})
    return found


def takes(vehicle: str) -> tuple[dict[str, tuple[str, ...]], dict[str, Variable]]:
    """Words with their choices, and numbers, that may be given."""
    if vehicle == "control":
        return {}, {}
    fixed = {"axle": FIXED | {"slope_direction"}, "balance": set()}.get(vehicle, FIXED)
    numbers = {name: v for name, v in every(vehicle).items() if name not in fixed}
    words = {file(vehicle)["word"]: tuple(manoeuvres(vehicle))} if "word" in file(vehicle) else {}
    return words | ({"exchange": EXCHANGES} if "h" in numbers else {}), numbers


def allowed(variable: Variable, value: float) -> float:
    """The value, or the message that the FMU itself would log."""
    if (variable.limit == ">0" and not value > 0) or (variable.limit == ">=0" and not value >= 0):
        limit = "above" if variable.limit == ">0" else "at least"
        raise Refused(f"{variable.name} = {value:g}: it must be {limit} 0 {variable.unit}.")
    return value


@dataclass(frozen=True)
class Asked:
    """What a command line asks for."""

    vehicle: str
    manoeuvre: Manoeuvre | None = None
    exchange: str = "derivatives"
    h: float = 0.001


def values(vehicle: str, arguments: list[str]) -> dict[str, str | float]:
    """Words and numbers by name."""
    (words, numbers), given = takes(vehicle), {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals:
            raise Refused(f'"{argument}" is not of the form name=value; --help lists the names.')
        if name in words:
            if text not in words[name]:
                raise Refused(f"{name} is one of {', '.join(words[name])}, not {text}.")
            given[name] = text
        elif name in numbers:
            given[name] = allowed(numbers[name], number(name, text))
        else:
            if not numbers:
                raise Refused(f"{argument}: this example takes no parameters.")
            near = get_close_matches(name, [*words, *numbers], 5, 0.3) or list(numbers)[:8]
            raise Refused(f"There is no parameter {name} here; there are, for example, {', '.join(near)}.")
    return given


def chosen(vehicle: str, arguments: list[str]) -> Asked:
    """The manoeuvre with what was given, and how it is run."""
    given = values(vehicle, arguments)
    if vehicle == "control":
        return Asked(vehicle)
    how = {name: given.pop(name) for name in ("exchange", "h") if name in given}
    of = manoeuvres(vehicle)
    name = given.pop(file(vehicle).get("word"), file(vehicle).get("first", next(iter(of))))
    asked = Asked(vehicle, of[name].changed(**given), **how)
    if asked.manoeuvre.stop < asked.h:
        raise Refused(f"stop = {asked.manoeuvre.stop:g}: it must be at least the step h, {asked.h:g} s.")
    return asked


def usage(name: str, arguments: list[str]) -> str:
    """All that one example takes, with the start values of the manoeuvre that is named; or the list of the examples."""
    about = {vehicle: file(vehicle)["about"] for vehicle in FOLDERS} | {"control": CONTROL}
    if name not in about:
        rows = [f"  {vehicle:11s}{text}" for vehicle, text in about.items()]
        line = f"./scripts/example {'|'.join(about)} [parameter=value ...]   a vehicle made of FMUs, run and drawn"
        return "\n".join([line, *rows, "./scripts/example NAME --help lists the parameters of one example."])
    lines = [f"./scripts/example {name} [parameter=value ...]   {about[name]}"]
    words, numbers = takes(name)
    if not numbers:
        return lines[0]
    for word, choices in words.items():
        lines.append(f"  {word}={'|'.join(choices)}")
        own = manoeuvres(name).values() if word == file(name).get("word") else ()
        for one in own:
            given = " ".join(f"{n}={x:.4g}" for n, x in one.given.items())
            lines.append(f"    {one.name}: {one.title}; stop={one.stop:g} {given}")
    asked = chosen(name, arguments).manoeuvre
    lines.append(f"Parameters, with their values in the run {asked.name}:")
    for v in numbers.values():
        start = asked.stop if v.name == "stop" else asked[asked.followed(v.name)]
        lines.append(f"  {v.name:16s}{v.unit:10s}{start:>9.6g} {v.limit:>4s}  {v.description}")
    return "\n".join(lines)


def asked(arguments: list[str]) -> Asked:
    """The example that the command line asks for."""
    name, *rest = arguments or [""]
    examples = (*FOLDERS, "control")
    if name not in examples:
        near = get_close_matches(name, examples, 1, 0.3)
        mean = f"; did you mean {near[0]}?" if near else "."
        raise Refused(f'"{name}" is no example; there are {", ".join(examples)}{mean}' if name else usage("", []))
    return chosen(name, rest)


def main() -> int:
    """Prints the help, or checks the arguments."""
    arguments = sys.argv[1:]
    rest = [a for a in arguments if a not in ("-h", "--help")]
    try:
        if rest != arguments:
            print(usage(rest[0] if rest else "", rest[1:]))
        else:
            asked(arguments)
    except Refused as reason:
        print(reason, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # as of --help | head
    sys.exit(main())
