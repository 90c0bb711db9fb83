"""A study: which start values, parameters and inputs are run, and what is measured of each run.

A measure of a run is text, which can be kept with the results and compared when a study is started again: `theta` (at
the end), `lowest`, `min(Z_O)`, `max(mu_required)`, `mean(E)`, `first(theta > 1.6)`, `first(theta > 95deg)`. Besides the
FMU's variables there are `plane_angle`, of the wheel's plane to the ground on either side (`lowest` is its least), and
the speed of the slip (`slip` is its largest, `slid` the time for which there is any).
Plain data, by Python's standard library alone: scripts/study refuses an impossible study before anything is installed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from enum import IntEnum
from functools import cache, cached_property
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.etree import ElementTree
from zipfile import BadZipFile, ZipFile

from wheelfmu.fmu import values
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import MOMENTS, Fault, Variable, moments, preset, scale, suggestion

if TYPE_CHECKING:
    import numpy

SETTABLE, READABLE = ("parameter", "input"), ("output", "local")  # causalities
POINT = "wheel"  # the dimension of a list
PLANE, SLIP = "plane_angle", "slip"  # quantities of a measure beside the variables
PLANE_TEXT = "Angle of the wheel's plane to the ground, from 0 to 90 deg on either side: 90 deg - |theta - 90 deg|"
SLIP_TEXT = "Speed of the slip: of the wheel's material point at the contact over the ground, 0 while it rolls"
QUANTITIES = {
    PLANE: Variable(PLANE, "local", "Real", "rad", "", "", "", PLANE_TEXT),
    SLIP: Variable(SLIP, "local", "Real", "m/s", "", "", "", SLIP_TEXT),
}
MADE_OF = {PLANE: ("theta",), SLIP: ("slip_x", "slip_y")}
SIZE = ("m", "r_0", "r")  # from which a body's moments of inertia follow


class Status(IntEnum):
    """The fate of one wheel."""

    not_computed = -1
    reached = 0  # the stop time
    flat = 1  # theta came to 0 or pi
    lifted_off = 2  # N came to 0
    refused = 3  # a start value or a parameter is impossible
    failed = 4  # the run ended with an error, or the worker process died
    grip = 5  # mu_required reached mu_max
    jammed = 6  # the sliding wheel jammed


OWN = {  # results of every study: empty value, type, unit, label, description
    "status": (int(Status.not_computed), "i1", "", "fate", "Fate of the wheel"),
    "message": ("", "T", "", "message", "Messages of the FMU"),
    "end_time": (math.nan, "f8", "s", "end of the run", "Time at which the run ended"),
    "wall_time": (math.nan, "f8", "s", "computing time", "Computing time of the run"),
    "fmu_time": (math.nan, "f8", "s", "time in the FMU", "Part of wall_time spent in calls of the FMU"),
}


class Measure(NamedTuple):
    """One number of a run: `kind` is last, min, max, mean, or of a time <, > or lasting; `limit` is in the quantity's
    unit."""

    kind: str
    quantity: str
    limit: float = 0.0

    @property
    def variables(self) -> tuple[str, ...]:
        """The FMU's variables that have to be read."""
        return MADE_OF.get(self.quantity, (self.quantity,))

    def value(self, t: numpy.ndarray, x: Any, *y: Any) -> float:
        """For samples of the variables at times t, the last of which is the end of the run; x at the end for `last`.

        A time is that of the first passage, interpolated linearly between two samples; NaN if there is none.
        """
        if self.quantity == PLANE:
            x = math.pi / 2 - abs(x - math.pi / 2)
        elif self.quantity == SLIP:
            x = (x * x + y[0] * y[0]) ** 0.5
        if self.kind == "lasting":
            slides = (x > 0) * 1.0
            return ((t[1:] - t[:-1]) * (slides[1:] + slides[:-1]) / 2).sum()
        if self.kind in "<>":
            beyond = x < self.limit if self.kind == "<" else x > self.limit
            k = beyond.argmax()
            if k == 0:
                return t[0] if beyond[0] else math.nan
            return t[k - 1] + (self.limit - x[k - 1]) / (x[k] - x[k - 1]) * (t[k] - t[k - 1])
        if self.kind == "mean":
            return ((t[1:] - t[:-1]) * (x[1:] + x[:-1]) / 2).sum() / (t[-1] - t[0]) if len(t) > 1 else x[-1]
        return x if self.kind == "last" else self.extreme(x)

    def extreme(self, x: Any) -> float:
        """The least or largest, by a parabola between the samples where their second differences show a smooth turn."""
        k = getattr(x, f"arg{self.kind}")()
        if 2 <= k < len(x) - 3:  # the last sample, the end of a run, has another distance
            before, bend, after = (x[j - 1] - 2 * x[j] + x[j + 1] for j in (k - 1, k, k + 1))
            if bend and all(0.5 < beside / bend < 2 for beside in (before, after)):
                return x[k] - (x[k + 1] - x[k - 1]) ** 2 / (8 * bend)
        return x[k]


MEASURE = re.compile(r"(\w+)|(min|max|mean)\((\w+)\)|first\((\w+)([<>])([-+]?\.?\d.*)\)")
SHORT = {"lowest": Measure("min", PLANE), "slip": Measure("max", SLIP), "slid": Measure("lasting", SLIP)}


def parse_measure(text: str) -> Measure:
    """The measure that the text describes, with a limit in SI; Fault if it describes none."""
    if not (found := MEASURE.fullmatch(text.replace(" ", ""))):
        raise Fault(
            f"'{text}' is not a measure: write lowest, slip, slid, a variable's name, min(name), max(name), "
            "mean(name), first(name < number) or first(name > number), as first(theta < 30deg)."
        )
    name, kind, of, quantity, side, limit = found.groups()
    if name:
        return SHORT.get(name, Measure("last", name))
    return Measure(kind, of) if kind else Measure(side, quantity, in_si(quantity, limit))


def description(fmu: Path = ROOT / "wheel.fmu") -> bytes:
    """modelDescription.xml of the FMU or, before it is built, of the project."""
    try:
        return ZipFile(fmu).read("modelDescription.xml")
    except (OSError, BadZipFile, KeyError):
        return (ROOT / "modelDescription.xml").read_bytes()


@cache
def quantities() -> dict[str, Variable]:
    """The variables of the project's FMU, and what a measure takes besides."""
    return values.variables(description()) | QUANTITIES


def in_si(name: str, value: float | str) -> float:
    """A value, or a text as a user types it: `60deg`, `bdf`, `true`; nan for a name that is unknown."""
    if not isinstance(value, str):
        return float(value)
    return quantities()[name].number_of(value) if name in quantities() else math.nan


def can_change(variable: Variable) -> bool:
    """Whether it may be set between steps."""
    return variable.causality == "input" or variable.variability == "tunable"


def counters_of(variables: Mapping[str, Variable]) -> list[str]:
    """The FMU's counters: Integer variables whose name begins with n_."""
    return [name for name, v in variables.items() if v.type == "Integer" and name.startswith("n_")]


def factors(body: Mapping[str, float]) -> dict[str, float]:
    """By variable: its value in a motion of this wheel over that in the similar motion of the paper's."""
    units = ElementTree.fromstring(description()).iter("Unit")
    powers = {u.get("name"): {n: int(u[0].get(n, 0)) for n in ("kg", "m", "s")} for u in units}
    return {name: scale(body, **powers.get(v.unit, {})) for name, v in quantities().items()}


def check_names(names: Iterable[str], causalities: tuple[str, str], known: Mapping[str, Variable]) -> None:
    """Fault about the first name that is not a variable of these causalities."""
    there = {name: v.description or "" for name, v in known.items() if v.causality in causalities}
    for name in names:
        if name not in there:
            hint = suggestion(name, there) or " docs/variables.md lists them."
            kind = "a parameter or input" if causalities == SETTABLE else "an output or local variable"
            raise Fault(f"'{name}' is not {kind} of this FMU.{hint}")


def quoted(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in dict.fromkeys(names))


@dataclass(frozen=True, kw_only=True, eq=False)
class Study:
    """Many wheels. Names are those of modelDescription.xml, values in SI units (rad, m, s).

    Exactly one of these lists the wheels:
      grid    name -> values; every combination is run; the names are the dimensions of the results
      list    name -> values, all of one length; the k-th wheel takes the k-th of each; dataset.sample draws them
    values      name -> value, the same for all wheels; a name that is missing keeps the FMU's default
    measures    name of a result -> text, as above
    history     Real variables kept at every communication point
    interval    s between communication points, from which min, max, mean, first and the history follow
    body        `torus`, `disc` or `hoop` (examples/bodies.json): J_x, J_y, J_z follow from m, r_0 and r of each wheel
    branch_at   s; until then tunable parameters and inputs of the grid keep their values of `values`: runs that differ
                in nothing else share one start, which a worker runs once and restores from a snapshot
    """

    grid: Mapping[str, Sequence[float]] = field(default_factory=dict)
    list: Mapping[str, Sequence[float]] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    measures: Mapping[str, str] = field(default_factory=lambda: {"theta_end": "theta"})
    history: Sequence[str] = ()
    stop_time: float = 10.0
    interval: float = 0.01
    tolerance: float | None = None
    branch_at: float | None = None
    body: str | None = None

    def __post_init__(self) -> None:
        try:  # Python's own types: equal studies have equal fields, whatever they were given as
            columns = {kind: getattr(self, kind).items() for kind in ("grid", "list")}
            plain: dict[str, Any] = {
                kind: {n: [in_si(n, x) for x in xs] for n, xs in of} for kind, of in columns.items()
            }
            plain["values"] = {n: in_si(n, x) for n, x in self.values.items()}
        except TypeError as fault:
            raise Fault(f"A name that varies needs a list of numbers ({fault}).") from None
        plain |= {"measures": {**self.measures}, "history": [*self.history]}
        times = {name: getattr(self, name) for name in ("stop_time", "interval", "tolerance", "branch_at")}
        for name, value in (plain | {n: float(x) for n, x in times.items() if x is not None}).items():
            object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        """Whether the other one asks the same, of whatever subclass."""
        return isinstance(other, Study) and asdict(self) == asdict(other)

    def scaled(self, wheel: str) -> Study:
        """The same study of a preset (examples/wheels.json): a wheel of the paper's shape would move alike.

        Lengths are in proportion to R = r_0 + r, times to sqrt(R), masses to m. Fault if it sets such a parameter.
        """
        body = {n: x for n, x in preset(wheel).items() if not (self.body and n in MOMENTS)}
        factor, slower, given = factors(body), scale(body, s=1), {*self.varied, *self.values}
        if both := sorted({*body} & given - {"phi_dot_start"}):
            raise Fault(f"The study has values of {', '.join(both)}, which are those of the wheel {wheel}.")

        def similar(columns: Mapping[str, Sequence[float]]) -> dict[str, Sequence[float]]:
            return {name: [x * factor.get(name, 1.0) for x in column] for name, column in columns.items()}

        passages = {
            name: f"first({m.quantity} {m.kind} {m.limit * factor.get(m.quantity, 1.0)!r})"
            for name, m in self.parsed.items()
            if m.kind in "<>"
        }
        return replace(
            self,
            grid=similar(self.grid),
            list=similar(self.list),
            values={n: x for n, x in body.items() if n not in given}
            | {n: x * factor.get(n, 1.0) for n, x in self.values.items()},
            measures={**self.measures, **passages},
            **{n: t * slower for n in ("stop_time", "interval", "branch_at") if (t := getattr(self, n))},
        )

    @property
    def varied(self) -> dict[str, Sequence[float]]:
        """The names that vary, with their values."""
        return {**self.grid, **self.list}

    @cached_property
    def parsed(self) -> dict[str, Measure]:
        """The measures by the name of their result; Fault if one cannot be parsed."""
        return {name: parse_measure(text) for name, text in self.measures.items()}

    @cached_property
    def sampled(self) -> tuple[str, ...]:
        """Variables read at every communication point."""
        watched = (name for m in self.parsed.values() if m.kind != "last" for name in m.variables)
        return tuple(dict.fromkeys([*self.history, *watched]))

    @property
    def times(self) -> Sequence[float]:
        """The communication points in s; only the first and the last if nothing is read in between."""
        begin, end = self.branch_at or 0.0, self.stop_time
        steps = math.ceil((end - begin) / self.interval * (1 - 1e-12)) if self.sampled else 1
        return [*(begin + k * self.interval for k in range(steps)), end]

    def branches(self, variable: Variable) -> bool:
        """Whether it has its value of the grid or list from branch_at on, not from the start."""
        return self.branch_at is not None and can_change(variable)

    def check(self, variables: Mapping[str, Variable]) -> None:
        """Fault if a name is unknown or the study does not suit the FMU."""
        check_names([*self.varied, *self.values], SETTABLE, variables)
        check_names([*(n for m in self.parsed.values() for n in m.variables), *self.history], READABLE, variables)
        derived = [*moments(self.body)] if self.body else []
        columns = [*self.varied.items(), *((name, [x]) for name, x in self.values.items())]
        lengths = {name: len(column) for name, column in self.list.items()}
        empty = quoted(name for name, xs in columns if not xs)
        parts = quoted(n for n, xs in columns if variables[n].type != "Real" and any(x % 1 for x in xs))
        words = quoted(n for n, xs in columns if variables[n].type == "Boolean" and {*xs} - {0, 1})
        both = quoted(name for name in self.varied if name in self.values and self.branch_at is None)
        integers = quoted(name for name in self.sampled if variables[name].type != "Real")
        fixed = quoted(name for name in derived if name in {*self.varied, *self.values})
        names = [*self.measures, *self.history, *self.varied, *OWN, "time", POINT, *counters_of(variables), *derived]
        twice = quoted(name for name in names if names.count(name) > 1)
        shared = self.branch_at is None or any(can_change(variables[name]) for name in self.varied)
        in_order = 0 <= (self.branch_at or 0.0) < self.stop_time < math.inf and 0 < self.interval < math.inf
        refused = {
            "Give either grid or list: it lists the wheels.": bool(self.grid) == bool(self.list),
            f"{fixed} follows from m, r_0 and r with body {self.body}: leave one of the two out.": fixed,
            f"The values of {parts} must be whole numbers.": parts,
            f"The values of {words} must be true or false, 1 or 0.": words,
            f"The values of {empty} must be a list of numbers, at least one.": empty,
            f"{both} is in values and among the names that vary.": both,
            f"The columns of a list must have one length; these have: {lengths}.": len({*lengths.values()}) > 1,
            f"{integers} is an integer: only its value at the end can be measured.": integers,
            f"{twice} would name two things in the results; give the measure another name.": twice,
            f"With branch_at nothing would be shared: {quoted(self.varied)} cannot change in a run. "
            "Vary s or an input too.": not shared,
            "The interval must be above zero, and branch_at from zero to below a finite stop_time.": not in_order,
        }
        for text, found in refused.items():
            if found:
                raise Fault(text)

    def starts(self, variables: Mapping[str, Variable]) -> Iterator[dict[str, float]]:
        """The parameters with which wheels start; those that vary are mass, size and moments alone."""
        presets = {name: v.preset for name, v in variables.items() if v.causality == "parameter"}
        same = {**presets, **self.values}
        varied = {name: xs for name, xs in self.varied.items() if name in (*SIZE, *MOMENTS)}
        for xs in zip(*varied.values(), strict=True) if self.list and varied else product(*varied.values()):
            own = same | dict(zip(varied, xs, strict=True))
            yield own | (moments(self.body, *(own[name] for name in SIZE)) if self.body else {})

    def doubt(self, variables: Mapping[str, Variable]) -> str:
        """One sentence if there are wheels that no body can be, with their number; else nothing."""
        said = [values.doubt(own) for own in self.starts(variables)]
        found = [text for text in said if text]
        wheels = math.prod(map(len, self.grid.values())) * max(map(len, self.list.values()), default=1)
        count = len(found) * wheels // len(said)
        return f"{count} of {wheels} wheels cannot exist. The first: {found[0]}" if found else ""
