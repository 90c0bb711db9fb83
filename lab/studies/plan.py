"""A study: which start values, parameters and inputs are run, and what is measured of each run.

Plain data, by Python's standard library alone: scripts/study refuses an impossible study before anything is installed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from enum import IntEnum
from functools import cached_property
from itertools import product
from typing import Any

from wheelfmu.fmu.presets import MOMENTS, doubt
from wheelfmu.fmu.values import Fault, Variable

from .measures import Measure, parse_measure
from .names import READABLE, SETTABLE, check_names, counters_of, in_si

POINT = "wheel"  # the dimension of a list
BODY = ("m", "r_0", "r", *MOMENTS)


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


OWN = {  # results of every study: empty value, type, unit, description
    "status": (int(Status.not_computed), "i1", "", "Fate of the wheel"),
    "message": ("", "T", "", "Messages of the FMU"),
    "end_time": (math.nan, "f8", "s", "Time at which the run ended"),
    "wall_time": (math.nan, "f8", "s", "Computing time of the run"),
    "fmu_time": (math.nan, "f8", "s", "Part of wall_time spent in calls of the FMU"),
}


def quoted(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in dict.fromkeys(names))


@dataclass(frozen=True, kw_only=True, eq=False)
class Study:
    """Many wheels. Names are those of modelDescription.xml, values in SI units (rad, m, s) or texts with a unit.

    Exactly one of these lists the wheels:
      grid    name -> values; every combination is run; the names are the dimensions of the results
      list    name -> values, all of one length; the k-th wheel takes the k-th of each
    values      name -> value, the same for all wheels; a name that is missing keeps the FMU's default
    measures    name of a result -> text, as in measures.py
    history     Real variables kept at every communication point
    interval    s between communication points, from which min, max, mean, first and the history follow
    """

    grid: Mapping[str, Sequence[float]] = field(default_factory=dict)
    list: Mapping[str, Sequence[float]] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    measures: Mapping[str, str] = field(default_factory=lambda: {"theta_end": "theta"})
    history: Sequence[str] = ()
    stop_time: float = 10.0
    interval: float = 0.01
    tolerance: float | None = None

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
        times = {name: getattr(self, name) for name in ("stop_time", "interval", "tolerance")}
        for name, value in (plain | {n: float(x) for n, x in times.items() if x is not None}).items():
            object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        """Whether the other one asks the same, of whatever subclass."""
        return isinstance(other, Study) and asdict(self) == asdict(other)

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
        steps = math.ceil(self.stop_time / self.interval * (1 - 1e-12)) if self.sampled else 1
        return [*(k * self.interval for k in range(steps)), self.stop_time]

    def check(self, variables: Mapping[str, Variable]) -> None:
        """Fault if a name is unknown or the study does not suit the FMU."""
        check_names([*self.varied, *self.values], SETTABLE, variables)
        check_names([*(n for m in self.parsed.values() for n in m.variables), *self.history], READABLE, variables)
        columns = [*self.varied.items(), *((name, [x]) for name, x in self.values.items())]
        lengths = {name: len(column) for name, column in self.list.items()}
        empty = quoted(name for name, xs in columns if not xs)
        parts = quoted(n for n, xs in columns if variables[n].type != "Real" and any(x % 1 for x in xs))
        words = quoted(n for n, xs in columns if variables[n].type == "Boolean" and {*xs} - {0, 1})
        both = quoted(name for name in self.varied if name in self.values)
        integers = quoted(name for name in self.sampled if variables[name].type != "Real")
        names = [*self.measures, *self.history, *self.varied, *OWN, "time", POINT, *counters_of(variables)]
        twice = quoted(name for name in names if names.count(name) > 1)
        in_order = 0 < self.stop_time < math.inf and 0 < self.interval < math.inf
        refused = {
            "Give either grid or list: it lists the wheels.": bool(self.grid) == bool(self.list),
            f"The values of {parts} must be whole numbers.": parts,
            f"The values of {words} must be true or false, 1 or 0.": words,
            f"The values of {empty} must be a list of numbers, at least one.": empty,
            f"{both} is in values and among the names that vary.": both,
            f"The columns of a list must have one length; these have: {lengths}.": len({*lengths.values()}) > 1,
            f"{integers} is an integer: only its value at the end can be measured.": integers,
            f"{twice} would name two things in the results; give the measure another name.": twice,
            "Interval and stop_time must be above zero and finite.": not in_order,
        }
        for text, found in refused.items():
            if found:
                raise Fault(text)

    def bodies(self, variables: Mapping[str, Variable]) -> Iterator[dict[str, float]]:
        """Mass, size and moments of inertia of the wheels, each combination once."""
        same = {name: variables[name].preset for name in BODY} | {**self.values}
        varied = {name: xs for name, xs in self.varied.items() if name in BODY}
        for xs in zip(*varied.values(), strict=True) if self.list and varied else product(*varied.values()):
            yield same | dict(zip(varied, xs, strict=True))

    def doubt(self, variables: Mapping[str, Variable]) -> str:
        """One sentence if there are wheels that no body can be, with their number; else nothing."""
        said = [doubt(body) for body in self.bodies(variables)]
        found = [text for text in said if text]
        wheels = math.prod(map(len, self.grid.values())) * max(map(len, self.list.values()), default=1)
        count = len(found) * wheels // len(said)
        return f"{count} of {wheels} wheels cannot exist. The first: {found[0]}" if found else ""
