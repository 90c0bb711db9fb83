"""What a study is: which start values, parameters and inputs are run, and what is to be known of each run."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray

from .measures import Measure, StudyError, parse_measure
from .runs import Job

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]
POINT = "wheel"  # the dimension of a list or a sample
OWN = ("status", "message", "end_time", "wall_time", "fmu_time", "time", POINT)


@dataclass(frozen=True, kw_only=True)
class Study:
    """Many wheels. Names are those of modelDescription.xml, values in SI units (rad, m, s).

    Exactly one of these says which wheels:
      grid    name -> values; every combination is run; the names are the dimensions of the results
      list    name -> values, all of one length; the k-th wheel takes the k-th of each
      sample  name -> (lowest, highest); `count` wheels, a Latin hypercube drawn with `seed`
    values      name -> value, the same for all wheels; what is not named keeps the FMU's default
    measures    name of a result -> text, see measures.py
    history     Real variables kept at every communication point
    interval    s between communication points; the measures min, max, mean, first and the history look there
    branch_at   s; until then tunable parameters and inputs of the grid keep their values of `values`: runs that differ
                in nothing else share one start, which is run once per worker and restored from a snapshot
    """

    grid: Mapping[str, Sequence[float]] = field(default_factory=dict)
    list: Mapping[str, Sequence[float]] = field(default_factory=dict)
    sample: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    count: int = 0
    seed: int = 0
    values: Mapping[str, float] = field(default_factory=dict)
    measures: Mapping[str, str] = field(default_factory=lambda: {"theta_end": "theta"})
    history: Sequence[str] = ()
    stop_time: float = 10.0
    interval: float = 0.01
    tolerance: float | None = None
    branch_at: float | None = None

    def run(self, out: str | Path, **how: object) -> xarray.Dataset:
        """Runs what is missing in `out` (a Zarr folder or its URL), returns the results; options as in compute.run."""
        from .compute import run  # not needed by a worker, and slow to load

        return run(self, out, **how)

    @property
    def axes(self) -> dict[str, Array]:
        """Name -> values: per dimension of a grid, per wheel of a list or a sample."""
        if self.sample:
            return self._drawn()
        return {name: np.asarray(values, float) for name, values in (self.grid or self.list).items()}

    @property
    def shape(self) -> dict[str, int]:
        """Dimension -> length, in the order of the results."""
        if self.grid:
            return {name: len(values) for name, values in self.axes.items()}
        return {POINT: len(next(iter(self.axes.values())))}

    def _drawn(self) -> dict[str, Array]:
        from scipy.stats import qmc  # only the caller draws

        unit = qmc.LatinHypercube(len(self.sample), rng=self.seed).random(self.count)
        bounds = np.array([*self.sample.values()], float).T
        return dict(zip(self.sample, qmc.scale(unit, *bounds).T, strict=True))

    def parsed_measures(self) -> dict[str, Measure]:
        """The measures by the name of their result; StudyError if one cannot be understood."""
        return {name: parse_measure(text) for name, text in self.measures.items()}

    def times(self, sampled: bool) -> tuple[float, ...]:
        """The communication points in s; only the first and the last if nothing looks at those between."""
        begin = self.branch_at or 0.0
        if not sampled:
            return (begin, float(self.stop_time))
        steps = int(np.ceil((self.stop_time - begin) / self.interval * (1 - 1e-12)))
        return (*(begin + k * self.interval for k in range(steps)), float(self.stop_time))

    def job(self, description: ModelDescription) -> Job:
        """What a worker has to know besides the points; StudyError if the study does not suit the FMU."""
        measures = self.parsed_measures()
        check(self, measures, description)
        sampled = bool(self.history) or any(m.needs_samples for m in measures.values())
        return Job(
            times=self.times(sampled),
            values={name: float(value) for name, value in self.values.items()},
            measures=measures,
            history=tuple(self.history),
            tolerance=self.tolerance,
            branch_at=self.branch_at,
            late=tuple(n for n in self.axes if can_change(description, n)) if self.branch_at is not None else (),
        )

    def spec(self) -> dict[str, object]:
        """The study as plain data: equal for equal studies, whatever types its numbers had."""
        plain = {"stop_time": self.stop_time, "interval": self.interval, "tolerance": self.tolerance}
        plain |= {"branch_at": self.branch_at, "seed": self.seed, "measures": dict(self.measures)}
        plain |= {"history": [*self.history], "values": {n: float(v) for n, v in self.values.items()}}
        kind = "grid" if self.grid else "sample" if self.sample else "list"
        return plain | {"kind": kind, "axes": {name: values.tolist() for name, values in self.axes.items()}}

    def fingerprint(self, fmu_sha256: str) -> str:
        """Tells whether kept results are of this study and this FMU."""
        text = json.dumps([self.spec(), fmu_sha256])
        return hashlib.sha256(text.encode()).hexdigest()


def can_change(description: ModelDescription, name: str) -> bool:
    """Whether a variable may be set between steps."""
    return any(
        v.name == name and (v.causality == "input" or v.variability == "tunable") for v in description.modelVariables
    )


def check(study: Study, measures: Mapping[str, Measure], description: ModelDescription) -> None:
    """StudyError with one sentence if something is unknown or does not fit."""
    kinds = {v.name: v for v in description.modelVariables}
    given = [bool(study.grid), bool(study.list), bool(study.sample)]
    if sum(given) != 1:
        raise StudyError("Give exactly one of grid, list and sample: it says which wheels are run.")
    if study.sample and study.count < 1:
        raise StudyError(f"count = {study.count}: a sample needs at least one wheel.")
    _check_axes(study, kinds)
    known = [name for name in kinds if kinds[name].causality in ("output", "local")]
    for name in [m.variable for m in measures.values()] + [*study.history]:
        if name not in known:
            raise StudyError(f"'{name}' is no output or local variable of this FMU; there are {', '.join(known)}.")
    for name in [m.variable for m in measures.values() if m.needs_samples] + [*study.history]:
        if kinds[name].type != "Real":
            raise StudyError(f"'{name}' is a whole number: only its value at the end can be measured.")
    names = [*measures, *study.history, *study.axes, *OWN, *(n for n in known if n.startswith("n_"))]
    for name in set(names):
        if names.count(name) > 1:
            raise StudyError(f"'{name}' would name two things in the results; call the measure something else.")
    begin = study.branch_at or 0.0
    if not (0 <= begin < study.stop_time < np.inf and 0 < study.interval < np.inf):
        raise StudyError(
            f"interval = {study.interval}, branch_at = {study.branch_at}, stop_time = {study.stop_time}: "
            "the interval must be above zero, and branch_at before the stop time."
        )


def _check_axes(study: Study, kinds: Mapping[str, object]) -> None:
    axes = study.axes
    for name in [*axes, *study.values]:
        if name not in kinds or kinds[name].causality not in ("parameter", "input"):
            raise StudyError(f"'{name}' is no parameter or input of this FMU, so it has no value to start from.")
        if name in axes and name in study.values and study.branch_at is None:
            raise StudyError(f"'{name}' stands in values and among those that vary.")
    for name, values in axes.items():
        if values.ndim != 1 or not len(values):
            raise StudyError(f"The values of '{name}' must be a list of numbers, at least one.")
    if not study.grid and len({len(values) for values in axes.values()}) > 1:
        lengths = ", ".join(f"{name} {len(values)}" for name, values in axes.items())
        raise StudyError(f"The columns of a list must have one length; these have: {lengths}.")
