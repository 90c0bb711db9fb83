"""Runs of one worker: a block of wheels, one after the other in one instance; a start that several share runs once.

A wheel that fails is a status with the FMU's message; nothing here raises because of what a wheel does.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from time import perf_counter

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2FMUstate
from numpy.typing import NDArray

from .instance import FMU2Instance, Status, Table, can_change, counters_of
from .measures import PLANE_ANGLE, Measure
from .plan import Study

Array = NDArray[np.float64]
Result = dict[str, NDArray]


class Runner:
    """The instance of a worker, and the snapshot of the start that it ran last."""

    def __init__(self, folder: str) -> None:
        self.instance = FMU2Instance(folder)
        self._snapshot = fmi2FMUstate()
        self._shared: tuple[object, Status, float, list[str]] | None = None  # key and outcome of that start

    def run_block(self, study: Study, points: Mapping[str, Array]) -> Result:
        """The outcomes of wheels whose values by name are broadcast against each other, in C order.

        The axes of the study itself are not used, only what all its wheels have in common.
        """
        fmu = self.instance
        columns = dict(zip(points, map(np.ravel, np.broadcast_arrays(*points.values())), strict=True))
        count, measures = len(next(iter(columns.values()))), study.parsed
        late = [n for n in columns if study.branch_at is not None and can_change(fmu.description, n)]
        early = Table(fmu, {n: v for n, v in columns.items() if n not in late} | study.values, count)
        change = Table(fmu, {n: columns[n] for n in late}, count)
        counters = counters_of(fmu.description)
        at_the_end = {name: m for name, m in measures.items() if m.kind == "last"}
        names = dict.fromkeys([*(m.variable for m in at_the_end.values()), *counters])
        ends, known = Table(fmu, dict.fromkeys(names, 0), count), np.zeros(count, bool)
        sampled, times = study.sampled, np.array(study.times)
        references, rows = fmu.references(sampled), np.empty((len(times) + 1, len(sampled)))  # one more for the end
        result = _empty(study, count)

        for i in sorted(range(count), key=early.key) if late else range(count):  # those that share a start in a row
            begin, n = perf_counter(), 0
            status, end = self._start(study, early, i)
            try:
                if status == Status.reached:
                    change.set(i)
                    status, end, n = fmu.march(times, references, rows)
            except FMICallException:
                status, end = Status.refused, np.nan
            if status != Status.refused:
                with suppress(FMICallException):  # an instance that failed may be unable to answer
                    ends.get(i)
                    known[i] = True
            result["fmu_time"][i] = perf_counter() - begin
            result["status"][i], result["end_time"][i], result["message"][i] = status, end, " ".join(fmu.messages)
            if n and sampled:
                for k, name in enumerate(study.history):
                    result[name][i, :n] = rows[:n, k]
                t = times[:n]
                if end > t[-1]:  # the end of a run is a sample too
                    t, rows[n] = np.append(t, end), fmu.getReal(references)
                for name, measure in measures.items():
                    if name not in at_the_end:
                        result[name][i] = number(measure, t, rows[: len(t), sampled.index(measure.variable)])
            result["wall_time"][i] = perf_counter() - begin

        for name, measure in at_the_end.items():
            values = np.where(known, ends[measure.variable], np.nan)
            result[name] = plane_angle(values) if measure.quantity == PLANE_ANGLE else values
        return result | {name: np.where(known, ends[name], -1) for name in counters}

    def _start(self, study: Study, early: Table, i: int) -> tuple[Status, float]:
        """To t = 0, or to `branch_at`: restored if the start that ran last had these values, else run and kept."""
        fmu = self.instance
        if study.branch_at is None:
            return fmu.begin(early, i, study.tolerance)
        key = (study.branch_at, study.tolerance, early.key(i))
        if self._shared and self._shared[0] == key:
            _, status, end, messages = self._shared
            fmu.messages = [*messages]
            if status == Status.reached:
                fmu.fmi2SetFMUstate(fmu.component, self._snapshot)
            return status, end
        self._shared = None
        status, end = fmu.begin(early, i, study.tolerance)
        if status == Status.reached:
            status, end, _ = fmu.march(np.array([0.0, study.branch_at]), fmu.references([]), np.empty(0))
        if status == Status.reached:
            fmu.fmi2GetFMUstate(fmu.component, self._snapshot)
        self._shared = (key, status, end, [*fmu.messages])
        return status, end

    def close(self) -> None:
        """Frees the snapshot, the instance and the library."""
        self.instance.fmi2FreeFMUstate(self.instance.component, self._snapshot)
        self.instance.freeInstance()


def _empty(study: Study, count: int) -> Result:
    """Results of `count` wheels of which nothing is known yet."""
    names, points = ("end_time", "wall_time", "fmu_time", *study.measures), len(study.times)
    result = {"status": np.full(count, Status.not_computed, np.int8), "message": np.full(count, "", object)}
    result |= {name: np.full(count, np.nan) for name in names}
    return result | {name: np.full((count, points), np.nan) for name in study.history}


def number(measure: Measure, t: Array, x: Array) -> float:
    """The measure for samples x of its variable at the times t, the last of which is the end of the run."""
    if measure.quantity == PLANE_ANGLE:
        x = plane_angle(x)
    if measure.is_time:
        return first_passage(t, x, measure.limit, below=measure.kind == "<")
    if measure.kind == "mean":
        return float(np.trapezoid(x, t) / (t[-1] - t[0])) if t[-1] > t[0] else float(x[-1])
    return float(x.min() if measure.kind == "min" else x.max())


def plane_angle(theta: Array) -> Array:
    """Angle [rad] of the wheel's plane to the ground, 0 to pi/2: 90 deg - |theta - 90 deg|."""
    return np.pi / 2 - np.abs(theta - np.pi / 2)


def first_passage(t: Array, x: Array, limit: float, below: bool) -> float:
    """First time at which x is beyond the limit, interpolated linearly between two samples; NaN if it never is."""
    beyond = x < limit if below else x > limit
    if not beyond.any():
        return float("nan")
    k = int(np.argmax(beyond))
    if k == 0:
        return float(t[0])
    return float(t[k - 1] + (limit - x[k - 1]) / (x[k] - x[k - 1]) * (t[k] - t[k - 1]))
