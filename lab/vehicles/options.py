"""What ./scripts/example takes: NAME [manoeuvre=NAME] [exchange=...] [parameter=value ...], checked before anything is
built or installed.

The manoeuvres are tables of manoeuvres.toml; names, units, start values and limits of parameters are those of the
models' tables of variables. It needs the standard library alone; numbers may carry a unit, as in h=1ms, v=40km/h,
k_h=60kN/m (wheelfmu.fmu.values).
"""

import csv
import re
import runpy
import tomllib
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, Self

from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, Variable, single, suggestion, variables

EXAMPLES = ROOT / "examples" / "vehicles"
VEHICLES = tomllib.loads(Path(__file__).with_name("manoeuvres.toml").read_text(encoding="utf-8"))
ABOUT = {name: of["about"] for name, of in VEHICLES.items()}
ABOUT["control"] = "for a control engineer: linearization, regulator, optimal control; without parameters"
WHEEL = variables((ROOT / "modelDescription.xml").read_bytes(), "parameter")
ROAD = ("s", "slope", "slope_direction", "mu_max", "mu_slide")  # parameters of wheel.fmu that may be given
EXCHANGES = ("held", "derivatives", "rollback")
FIXED = re.compile(r"[xy]_..|R|g|inner_step|v_start")  # of the wheels too, or set by the run
R, M_WHEEL, J_X, J_Z, G = 0.35, 20.0, 0.9, 1.8, 9.81  # of the wheels; SI


@cache
def system(vehicle: str) -> dict[str, Any]:
    """Its FMUs, connections and start values: a file of the examples."""
    return runpy.run_path(str(EXAMPLES / "package.py"))["read"](EXAMPLES / VEHICLES[vehicle]["system"])


@cache
def parameters(model: str) -> dict[str, Variable]:
    """The parameters of a model, by name."""
    if model == "wheel":
        return WHEEL
    (table,) = EXAMPLES.glob(f"*/{model}.csv")
    found = {}
    for row in csv.reader(table.read_text(encoding="utf-8").splitlines()[2:]):
        kind, name, unit, starts, limit, _ = row[:6]
        about, low = ",".join(row[6:]) + ", above 0" * (limit == ">0"), "0" * bool(limit)
        for wheel, start in zip(("fl", "fr", "rl", "rr"), (starts.split() or [""]) * 4, strict=False):
            of = name.format(wheel=wheel)
            if kind == "parameter" and of not in found:
                found[of] = Variable(of, kind, "Real", unit, start, low, "", about.format(wheel=wheel))
    return found


@cache
def takes(vehicle: str) -> dict[str, Variable]:
    """The numbers that may be given: of the run, the road and the models."""
    own = {"h": ("s", ", above 0"), "stop": ("s", ", above 0"), "v": ("m/s", "")}
    about = {"h": "Communication step", "stop": "End of the run", "v": "Speed at the start"}
    found = {n: Variable(n, "parameter", "Real", unit, "0", "0", "", about[n] + end) for n, (unit, end) in own.items()}
    found |= {name: WHEEL[name] for name in ROAD}
    for model in dict.fromkeys(system(vehicle)["fmus"].values()):
        if model != "wheel":
            found |= {n: of for n, of in parameters(model).items() if n not in found and not FIXED.fullmatch(n)}
    return found


@dataclass(frozen=True)
class Manoeuvre:
    """One run of a vehicle."""

    vehicle: str
    name: str
    title: str
    stop: float  # s
    h: float  # s
    given: dict[str, float] = field(default_factory=dict)
    judges: tuple[str, ...] = ()
    exchange: str = "derivatives"

    def __getitem__(self, name: str) -> float:
        """The value of a parameter; v: the speed at the start."""
        if name in self.given:
            return self.given[name]
        if name == "v":
            name = "v_start"
        starts = [values[name] for values in system(self.vehicle)["start"].values() if name in values]
        presets = (parameters(model).get(name) for model in system(self.vehicle)["fmus"].values())
        return starts[0] if starts else next(of.preset for of in presets if of)

    def changed(self, **values: Any) -> Self:
        """With other parameters, or another stop, step or exchange."""
        own = {name: values.pop(name) for name in ("stop", "h", "exchange") if name in values}
        return replace(self, **own, given=self.given | values)

    def start(self) -> dict[str, dict[str, float]]:
        """The start values of every component."""
        v, of = self["v"], system(self.vehicle)
        values = {"v_start": v, "v_0": v, "v_1": v, "phi_dot_start": -v / R} | self.given
        of_model = {model: {n: x for n, x in values.items() if n in parameters(model)} for model in of["fmus"].values()}
        return {name: of["start"][name] | of_model[model] for name, model in of["fmus"].items()}


@cache
def manoeuvres(vehicle: str) -> dict[str, Manoeuvre]:
    """By name."""
    h, found = system(vehicle)["step"], VEHICLES[vehicle]["manoeuvre"]
    return {name: Manoeuvre(vehicle, name, h=h, **values) for name, values in found.items()}


def asked(vehicle: str = "", *rest: str) -> Manoeuvre | None:
    """The run that the command line asks for; None where it takes no parameters."""
    if vehicle not in ABOUT:
        meant = suggestion(vehicle, dict.fromkeys(ABOUT, ""))
        raise Fault(f'"{vehicle}" is no example; there are {", ".join(ABOUT)}.{meant}' if vehicle else usage())
    pairs = [argument.partition("=") for argument in rest]
    for argument, (_, equals, _) in zip(rest, pairs, strict=True):
        if not equals:
            raise Fault(f'"{argument}" is not of the form name=value; --help lists the names.')
    given = single((name, text) for name, _, text in pairs)
    if vehicle == "control":
        if given:
            raise Fault(f"{rest[0]}: this example takes no parameters.")
        return None
    run = manoeuvres(vehicle)[word("manoeuvre", given, tuple(manoeuvres(vehicle)), VEHICLES[vehicle]["first"])]
    run = run.changed(exchange=word("exchange", given, EXCHANGES, run.exchange))
    run = run.changed(**{name: value(vehicle, name, text) for name, text in given.items()})
    if run.stop < run.h:
        raise Fault(f"stop = {run.stop:g}: it must be at least the step h, {run.h:g} s.")
    if run["mu_slide"] > run["mu_max"]:
        raise Fault(f"mu_slide = {run['mu_slide']:g}: it must be at most mu_max = {run['mu_max']:g}.")
    return run


def word(name: str, given: dict[str, str], choices: tuple[str, ...], otherwise: str) -> str:
    """A word among choices, which is taken out of what is given."""
    text = given.pop(name, otherwise)
    if text not in choices:
        meant = suggestion(text, dict.fromkeys(choices, ""))
        raise Fault(f"{name} = {text} is not one of {', '.join(choices)}.{meant}")
    return text


def value(vehicle: str, name: str, text: str) -> float:
    """The number of a parameter."""
    known = takes(vehicle)
    if name not in known:
        words = {n: of.description for n, of in known.items()} | {"manoeuvre": "", "exchange": ""}
        meant = suggestion(name, words)
        raise Fault(f"There is no parameter {name} here.{meant} ./scripts/example {vehicle} --help lists them.")
    return known[name].number_of(text)


def usage(vehicle: str = "", *arguments: str) -> str:
    """All that one example takes, with the values of the manoeuvre that is named; or the list of the examples."""
    if vehicle not in ABOUT:
        rows = [f"  {name:11s}{text}" for name, text in ABOUT.items()]
        line = f"./scripts/example {'|'.join(ABOUT)} [parameter=value ...]   a vehicle made of FMUs, run and drawn"
        return "\n".join([line, *rows, "./scripts/example NAME --help lists the parameters of one example."])
    run = asked(vehicle, *arguments)
    if not run:
        return f"./scripts/example {vehicle}   {ABOUT[vehicle]}"
    lines = [f"./scripts/example {vehicle} [parameter=value ...]   {ABOUT[vehicle]}", "  manoeuvre=NAME, one of"]
    lines += [f"    {one.name:10s}{one.title}" for one in manoeuvres(vehicle).values()]
    lines += [f"  exchange={'|'.join(EXCHANGES)}", f"Parameters, with their values in the manoeuvre {run.name}:"]
    for of in takes(vehicle).values():
        now = getattr(run, of.name) if of.name in ("h", "stop") else run[of.name]
        lines.append(f"  {of.name:16s}{of.unit:8s}{now:>10.6g}   {of.description}")
    return "\n".join(lines)
