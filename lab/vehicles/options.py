"""What ./scripts/example takes: NAME [parameter=value ...], checked before anything is built or installed.

A vehicle's runs are the tables of its manoeuvres.toml; names, units, start values and limits of parameters are those of
the tables of variables. It needs the standard library alone; numbers may carry a unit, as in h=1ms, v=40km/h, k=60kN/m
(wheelfmu.fmu.values).
"""

import math
import re
import tomllib
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Self

from lab.vehicles.describe import Variable, read
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, limited, number, single, suggestion, variables

EXAMPLES = ROOT / "examples" / "vehicles"
# Of the road, as the wheel checks them; every vehicle takes them.
ROAD = ("s", "slope", "slope_direction", "mu_max", "mu_slide")
WHEEL = variables((ROOT / "modelDescription.xml").read_bytes(), "parameter")
EXCHANGES = ("held", "derivatives", "rollback")
FOLDERS = {"car": "car", "suspended": "quarter_car", "balance": "balance"}


@cache
def file(vehicle: str) -> dict:
    """A vehicle's manoeuvres.toml."""
    if vehicle == "control":
        return {"about": "For a control engineer: linearization, regulator, optimal control; without parameters"}
    return tomllib.loads((EXAMPLES / FOLDERS[vehicle] / "manoeuvres.toml").read_text())


@cache
def parameters(model: str) -> dict[str, Variable]:
    """The parameters in a model's table, by name."""
    (table,) = EXAMPLES.glob(f"*/{model}.csv")
    return {v.name: v for v in read(table)[2] if v.causality == "parameter"}


@cache
def every(vehicle: str) -> dict[str, Variable]:
    """All parameters of a vehicle: of the run and the road first, then those of its models."""
    rows, models = file(vehicle).get("parameters", {}).items(), file(vehicle).get("models", ())
    own = {name: Variable("parameter", name, unit, x, limit, (), about) for name, (unit, x, limit, about) in rows}
    if models:  # road = {...} of the file: the start values that are its own
        starts = {name: WHEEL[name].preset for name in ROAD} | file(vehicle).get("road", {})
        for name, x in starts.items():
            own[name] = Variable("parameter", name, WHEEL[name].unit, x, "", (), WHEEL[name].description)
    return own | {n: v for model in models for n, v in parameters(model).items() if n not in own}


@dataclass(frozen=True)
class Manoeuvre:
    """One run of a vehicle: inputs, end, verdict and picture, as its manoeuvres.toml has them."""

    vehicle: str
    name: str
    title: str
    stop: float  # s
    h: float  # s
    given: dict[str, float]  # parameters that differ from their start values
    follows: dict[str, str] = field(default_factory=dict)  # parameter -> the one whose value it takes where not given
    ends: tuple[str, ...] = ()
    judges: tuple[str, ...] = ()
    plot: tuple[str | list[str], ...] = ()
    exchange: str = "derivatives"
    grid: float | None = None  # s, of the table
    positive: tuple[str, ...] = ()  # parameters that have to be above zero
    holds: tuple[str, ...] = ()  # parameters of which its closed forms take any value

    @property
    def called(self) -> str:
        """Its title, with the parameters that the title names."""
        return self.title.format_map(self)

    def __getitem__(self, name: str) -> float:
        name = name if name in self.given else self.follows.get(name, name)
        return self.given.get(name, every(self.vehicle)[name].start)

    @property
    def beyond(self) -> str:
        """Why its closed forms do not hold, in words: a parameter that is changed and must not be; or empty."""
        own = manoeuvres(self.vehicle)[self.name]
        changed = (name for name in self.given if self[name] != own[name] and name not in self.holds)
        return next((f"{name} is changed" for name in changed), "")

    def changed(self, **values: float) -> Self:
        """With other parameters, or another stop, step or exchange."""
        own = {name: values.pop(name) for name in ("stop", "h", "exchange") if name in values}
        return replace(self, **own, given=self.given | values)

    def of(self, model: str) -> dict[str, float]:
        """The parameters of one model that are given, or follow one that is."""
        return {n: self[n] for n in parameters(model) if n in self.given or self.follows.get(n) in self.given}


@cache
def manoeuvres(vehicle: str) -> dict[str, Manoeuvre]:
    """By name."""
    found = {}
    for name, of in file(vehicle).get("manoeuvre", {}).items():
        given = {n: number(n, str(x), every(vehicle)[n].unit) for n, x in of.get("given", {}).items()}
        step = {"h": every(vehicle)["h"].start} if "h" in every(vehicle) else {}
        found[name] = Manoeuvre(vehicle, name, **step | file(vehicle).get("how", {}) | of | {"given": given})
    return found


def takes(vehicle: str) -> tuple[dict[str, tuple[str, ...]], dict[str, Variable]]:
    """Words with their choices, and numbers, that may be given."""
    of = file(vehicle)
    numbers = {name: v for name, v in every(vehicle).items() if name not in of.get("fixed", ())}
    words = {of["word"]: tuple(manoeuvres(vehicle))} if "word" in of else {}
    return words | ({"exchange": EXCHANGES} if "h" in numbers else {}), numbers


def checked(of: Variable, value: float) -> float:
    """A value within the limit of its table, and one of those that the description lists as `0: ...; 1: ...`."""
    limited(of.name, value, of.unit, 0 if of.limit else -math.inf, above=of.limit == ">0")
    listed = re.findall(r"(?:^|; )([0-9]): ", of.description)
    if len(listed) > 1 and value not in map(float, listed):
        raise Fault(f"{of.name} = {value:g} is not one of {', '.join(sorted(listed))}.")
    return value


def value(vehicle: str, argument: str) -> tuple[str, str | float]:
    """The name, and the word or number, of an argument."""
    (words, numbers), (name, equals, text) = takes(vehicle), argument.partition("=")
    if not equals:
        raise Fault(f'"{argument}" is not of the form name=value; --help lists the names.')
    if name in words:
        if text not in words[name]:
            meant = suggestion(text, dict.fromkeys(words[name], ""))
            raise Fault(f"{name} = {text} is not one of {', '.join(words[name])}.{meant}")
        return name, text
    if of := numbers.get(name):
        return name, WHEEL[name].number_of(text) if name in ROAD else checked(of, number(name, text, of.unit))
    if not numbers:
        raise Fault(f"{argument}: this example takes no parameters.")
    meant = suggestion(name, dict.fromkeys(words, "") | {n: v.description for n, v in numbers.items()})
    raise Fault(f"There is no parameter {name} here.{meant} ./scripts/example {vehicle} --help lists them.")


ABOUT = {vehicle: file(vehicle)["about"] for vehicle in [*FOLDERS, "control"]}


def asked(vehicle: str = "", *rest: str) -> Manoeuvre | None:
    """The run that the command line asks for: the manoeuvre with the parameters given; None where there is none."""
    if vehicle not in ABOUT:
        meant = suggestion(vehicle, dict.fromkeys(ABOUT, ""))
        raise Fault(f'"{vehicle}" is no example; there are {", ".join(ABOUT)}.{meant}' if vehicle else usage())
    single((argument.partition("=")[0], argument.partition("=")[2]) for argument in rest)
    given, of, described = dict(value(vehicle, argument) for argument in rest), manoeuvres(vehicle), file(vehicle)
    if not of:
        return None
    run = of[given.pop(described.get("word"), described.get("first", next(iter(of))))].changed(**given)
    if run.stop < run.h:
        raise Fault(f"stop = {run.stop:g}: it must be at least the step h, {run.h:g} s.")
    if lacking := [name for name in run.positive if run[name] <= 0]:
        raise Fault(f"{lacking[0]} = {run[lacking[0]]:g}: it must be above 0 in the manoeuvre {run.name}.")
    for side in ("", "_right"):
        if f"mu_slide{side}" not in every(vehicle):
            continue
        slide, most = (run[f"{name}{side}"] or run[name] for name in ("mu_slide", "mu_max"))
        if slide > most:
            raise Fault(f"mu_slide{side} = {slide:g}: it must be at most mu_max{side} = {most:g}.")
    return run


def usage(name: str = "", *arguments: str) -> str:
    """All that one example takes, with the start values of the manoeuvre that is named; or the list of the examples."""
    if name not in ABOUT:
        rows = [f"  {vehicle:11s}{text}" for vehicle, text in ABOUT.items()]
        line = f"./scripts/example {'|'.join(ABOUT)} [parameter=value ...]   a vehicle made of FMUs, run and drawn"
        return "\n".join([line, *rows, "./scripts/example NAME --help lists the parameters of one example."])
    words, numbers = takes(name)
    lines = [f"./scripts/example {name}{' [parameter=value ...]' if numbers else ''}   {ABOUT[name]}"]
    for word, choices in words.items():
        lines.append(f"  {word}={'|'.join(choices)}")
        for one in manoeuvres(name).values() if word == file(name).get("word") else ():
            given = " ".join(f"{n}={x:.4g}" for n, x in one.given.items())
            lines.append(f"    {one.name}: {one.called}; stop={one.stop:g} {given}")
    if run := asked(name, *arguments):
        lines.append(f"Parameters, with their values in the run {run.name}:")
    for v in numbers.values():
        start = getattr(run, v.name) if v.name in ("h", "stop") else run[v.name]
        lines.append(f"  {v.name:16s}{v.unit:10s}{start:>9.6g} {v.limit:>4s}  {v.description}")
    return "\n".join(lines)
