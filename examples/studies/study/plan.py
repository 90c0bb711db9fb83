"""A study: which start values, parameters and inputs are run, and what is measured of each run."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray

from .measures import Measure, StudyError, parse_measure

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]
POINT = "wheel"  # the dimension of a list or a sample
OWN = ("status", "message", "end_time", "wall_time", "fmu_time", "time", POINT)  # results of every study


@dataclass(frozen=True, kw_only=True)
class Study:
    """Many wheels. Names are those of modelDescription.xml, values in SI units (rad, m, s).

    Exactly one of these lists the wheels:
      grid    name -> values; every combination is run; the names are the dimensions of the results
      list    name -> values, all of one length; the k-th wheel takes the k-th of each
      sample  name -> (lowest, highest); `count` wheels, a Latin hypercube drawn with `seed`
    values      name -> value, the same for all wheels; a name that is missing keeps the FMU's default
    measures    name of a result -> text, see measures.py
    history     Real variables kept at every communication point
    interval    s between communication points, at which min, max, mean, first and the history are evaluated
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
        """Runs the wheels that are missing in `out` (a Zarr folder or its URL) and returns the results.

        overwrite=True discards results of another study that are there; compute.run lists all options.
        """
        from .compute import run  # not needed by a worker, and slow to load

        return run(self, out, **how)

    def scaled(self, wheel: str) -> Study:
        """The same study of a ready wheel (examples/wheels.json): a wheel of the paper's shape would move alike.

        Lengths are in proportion to R = r_0 + r, times to sqrt(R), masses to m. StudyError if it sets such a parameter.
        """
        from .options import factors, ready, scale

        body = ready(wheel)
        given = self.grid | self.list | self.sample | self.values
        if both := sorted({*body} & {*given} - {"phi_dot_start"}):
            raise StudyError(
                f"The study has values of {', '.join(both)}, which are those of the wheel {wheel} already."
            )
        factor, time = factors(body), scale(body, s=1)

        def similar(values: Mapping[str, object]) -> dict[str, object]:
            return {n: np.multiply(x, factor.get(n, 1.0)).tolist() for n, x in values.items()}

        def measured(text: str) -> str:
            m = parse_measure(text)
            return f"first({m.quantity} {m.kind} {m.limit * factor.get(m.variable, 1.0)!r})" if m.is_time else text

        return replace(
            self,
            **{kind: similar(getattr(self, kind)) for kind in ("grid", "list", "sample")},
            values={n: x for n, x in body.items() if n not in given} | similar(self.values),
            measures={n: measured(text) for n, text in self.measures.items()},
            stop_time=self.stop_time * time,
            interval=self.interval * time,
            branch_at=None if self.branch_at is None else self.branch_at * time,
        )

    @cached_property
    def axes(self) -> dict[str, Array]:
        """Name -> values: per dimension of a grid, per wheel of a list or a sample."""
        if not self.sample:
            return {name: np.asarray(values, float) for name, values in (self.grid or self.list).items()}
        from scipy.stats import qmc  # only the caller draws

        unit = qmc.LatinHypercube(len(self.sample), rng=self.seed).random(self.count)
        bounds = np.array([*self.sample.values()], float).T
        return dict(zip(self.sample, qmc.scale(unit, *bounds).T, strict=True))

    @property
    def shape(self) -> dict[str, int]:
        """Dimension -> length, in the order of the results."""
        lengths = {name: len(values) for name, values in self.axes.items()}
        return lengths if self.grid else {POINT: next(iter(lengths.values()))}

    def points(self, region: tuple[slice, ...] | None = None) -> dict[str, Array]:
        """The values of a region of the results, or of all: arrays to be broadcast against each other."""
        parts = region or (slice(None),) * len(self.shape)
        if not self.grid:
            return {name: axis[parts] for name, axis in self.axes.items()}
        mesh = np.ix_(*(axis[part] for axis, part in zip(self.axes.values(), parts, strict=True)))
        return dict(zip(self.axes, mesh, strict=True))

    def common(self) -> Study:
        """The study without its axes, as a worker needs it."""
        return replace(self, grid={}, list={}, sample={})

    @property
    def parsed(self) -> dict[str, Measure]:
        """The measures by the name of their result; StudyError if one cannot be parsed."""
        return {name: parse_measure(text) for name, text in self.measures.items()}

    @property
    def sampled(self) -> list[str]:
        """Variables read at every communication point; the history comes first."""
        return [*dict.fromkeys([*self.history, *(m.variable for m in self.parsed.values() if m.kind != "last")])]

    @property
    def times(self) -> list[float]:
        """The communication points in s; only the first and the last if nothing is read in between."""
        begin, end = self.branch_at or 0.0, float(self.stop_time)
        if not self.sampled:
            return [begin, end]
        steps = int(np.ceil((end - begin) / self.interval * (1 - 1e-12)))
        return [*(begin + k * self.interval for k in range(steps)), end]

    def spec(self) -> dict[str, object]:
        """The study as plain data: equal for equal studies, whatever types its numbers had."""
        plain = {"stop_time": self.stop_time, "interval": self.interval, "tolerance": self.tolerance}
        plain |= {"branch_at": self.branch_at, "seed": self.seed, "measures": dict(self.measures)}
        plain |= {"history": [*self.history], "values": {n: float(v) for n, v in self.values.items()}}
        kind = "grid" if self.grid else "sample" if self.sample else "list"
        return plain | {"kind": kind, "axes": {name: values.tolist() for name, values in self.axes.items()}}

    def fingerprint(self, fmu_sha256: str) -> str:
        """Identifies kept results of this study with this FMU."""
        return hashlib.sha256(json.dumps([self.spec(), fmu_sha256]).encode()).hexdigest()

    def check(self, description: ModelDescription) -> None:
        """StudyError if a name is unknown or the study does not suit the FMU."""
        if sum(map(bool, (self.grid, self.list, self.sample))) != 1:
            raise StudyError("Give exactly one of grid, list and sample: it lists the wheels.")
        if self.sample and self.count < 1:
            raise StudyError(f"count = {self.count}: a sample needs at least one wheel.")
        from .options import READABLE, SETTABLE, check_names

        kinds = {v.name: v for v in description.modelVariables}
        check_names([*self.axes, *self.values], SETTABLE, kinds)
        check_names([*(m.variable for m in self.parsed.values()), *self.history], READABLE, kinds)
        self._check_axes()
        for name in self.sampled:
            if kinds[name].type != "Real":
                raise StudyError(f"'{name}' is an integer: only its value at the end can be measured.")
        counters = [name for name in kinds if name.startswith("n_")]
        names = [*self.measures, *self.history, *self.axes, *OWN, *counters]
        for name in names:
            if names.count(name) > 1:
                raise StudyError(f"'{name}' would name two things in the results; give the measure another name.")
        begin = self.branch_at or 0.0
        if not (0 <= begin < self.stop_time < np.inf and 0 < self.interval < np.inf):
            raise StudyError(
                f"interval = {self.interval}, branch_at = {self.branch_at}, stop_time = {self.stop_time}: "
                "the interval must be above zero, and branch_at before the stop time."
            )

    def _check_axes(self) -> None:
        lengths = {name: len(values) if values.ndim == 1 else 0 for name, values in self.axes.items()}
        for name, length in lengths.items():
            if name in self.values and self.branch_at is None:
                raise StudyError(f"'{name}' is in values and among the names that vary.")
            if not length:
                raise StudyError(f"The values of '{name}' must be a list of numbers, at least one.")
        if not self.grid and len(set(lengths.values())) > 1:
            listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
            raise StudyError(f"The columns of a list must have one length; these have: {listed}.")
