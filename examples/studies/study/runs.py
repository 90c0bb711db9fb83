"""Runs of one worker: a block of points, one after the other in one instance, with the start that they share run once.

A point that fails is a status with the FMU's own sentence; nothing here raises because of what a wheel does.
"""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import byref
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np
from fmpy.fmi2 import fmi2FMUstate
from numpy.typing import NDArray

from .instance import WARNING, FMU2Instance, Refused, Status
from .measures import Measure

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Job:
    """What all points of a study have in common; times in s, values by name in SI units.

    `times` are the communication points that are read, from the start or from the instant `branch_at` to the stop time.
    `late` are the names that are set at `branch_at`; until then, points that agree in all others share one run.
    """

    times: tuple[float, ...]
    values: Mapping[str, float]
    measures: Mapping[str, Measure]
    history: tuple[str, ...] = ()
    tolerance: float | None = None
    branch_at: float | None = None
    late: tuple[str, ...] = ()

    @property
    def sampled(self) -> list[str]:
        """Variables read at every communication point."""
        watched = [m.variable for m in self.measures.values() if m.needs_samples]
        return list(dict.fromkeys([*self.history, *watched]))


@dataclass
class Outcome:
    """What became of one point. `ended` is a run that did not come to its stop time."""

    status: Status
    message: str = ""
    end_time: float = np.nan
    counters: Array | None = None
    measures: dict[str, float] = field(default_factory=dict)
    history: Array | None = None

    @property
    def ended(self) -> bool:
        return self.status != Status.reached


class Runner:
    """The instance of a worker, and the snapshot of the start that it ran last."""

    def __init__(self, folder: str) -> None:
        self.instance = FMU2Instance(folder)
        self._snapshot = fmi2FMUstate()
        self._shared: tuple[object, Outcome] | None = None

    def run_block(self, job: Job, points: Mapping[str, Array]) -> dict[str, NDArray]:
        """The outcomes of the points, whose values by name are columns; one row of each result per point."""
        count = len(next(iter(points.values())))
        rows = [{name: float(column[i]) for name, column in points.items()} for i in range(count)]
        early = [tuple(value for name, value in row.items() if name not in job.late) for row in rows]
        result = empty_result(job, count, len(self.instance.counters))
        for i in sorted(range(count), key=early.__getitem__):  # those that share a start follow each other
            begin, self.instance.spent = perf_counter(), 0.0
            put(result, i, self.run_point(job, rows[i]))
            result["wall_time"][i] = perf_counter() - begin
            result["fmu_time"][i] = self.instance.spent
        return result

    def run_point(self, job: Job, point: Mapping[str, float]) -> Outcome:
        """One wheel from its start, or from the snapshot, to its end."""
        start = {**job.values, **{name: value for name, value in point.items() if name not in job.late}}
        if job.branch_at is None:
            begun = self._begin(job, start)
            return begun if begun.ended else self._march(job)
        begun = self._branch(job, start)
        if begun.ended:
            return begun
        if self.instance.set({name: point[name] for name in job.late}) > WARNING:
            return Outcome(Status.refused, self.instance.take_message())
        return self._march(job, begun.message)

    def _begin(self, job: Job, values: Mapping[str, float]) -> Outcome:
        try:
            self.instance.begin(values, job.tolerance)
        except Refused as fault:
            return Outcome(Status.refused, str(fault))
        return Outcome(Status.reached)

    def _branch(self, job: Job, values: Mapping[str, float]) -> Outcome:
        """At `branch_at`: restored if the last start was this one, else run there and kept."""
        key = (job.branch_at, job.tolerance, tuple(sorted(values.items())))
        if self._shared and self._shared[0] == key:
            if not self._shared[1].ended:
                self._require(self.instance.fmi2SetFMUstate(self.instance.component, self._snapshot), "fmi2SetFMUstate")
            return self._shared[1]
        self._shared = None
        begun = self._begin(job, values)
        if not begun.ended:
            status, _ = self.instance.march(np.array([0.0, job.branch_at]), [])
            begun = self._outcome(job, status, job.branch_at, 0.0)
        if not begun.ended:
            state = byref(self._snapshot)
            self._require(self.instance.fmi2GetFMUstate(self.instance.component, state), "fmi2GetFMUstate")
        self._shared = (key, begun)
        return begun

    def _require(self, status: int, call: str) -> None:
        if status > WARNING:
            raise RuntimeError(f"{call} failed: {self.instance.take_message()}")

    def _march(self, job: Job, message: str = "") -> Outcome:
        names, times = job.sampled, np.array(job.times)
        status, rows = self.instance.march(times, names)
        outcome = self._outcome(job, status, times[-1], times[len(rows) - 1])
        outcome.message = " ".join(filter(None, (message, outcome.message)))
        t = times[: len(rows)]
        if job.history:
            outcome.history = rows[:, : len(job.history)]
        if outcome.end_time > t[-1]:  # the end of a run is a sample too
            t, rows = np.append(t, outcome.end_time), np.vstack([rows, self.instance.read(names)])
        for name, measure in job.measures.items():
            if measure.needs_samples:
                outcome.measures[name] = measure.of(t, rows[:, names.index(measure.variable)])
        return outcome

    def _outcome(self, job: Job, status: int, stop: float, last: float) -> Outcome:
        """After a march that was to end at `stop` and completed its steps to `last`."""
        if status <= WARNING:
            outcome = Outcome(Status.reached, end_time=stop)
        else:
            kind, time = self.instance.ending(status)
            outcome = Outcome(kind, end_time=last if np.isnan(time) else time)
        outcome.message = self.instance.take_message()
        outcome.counters = self.instance.read(self.instance.counters)
        for name, measure in job.measures.items():
            if not measure.needs_samples:
                outcome.measures[name] = measure.of(np.array([stop]), self.instance.read([measure.variable]))
        return outcome

    def close(self) -> None:
        """Frees the snapshot, the instance and the library."""
        self.instance.fmi2FreeFMUstate(self.instance.component, byref(self._snapshot))
        self.instance.freeInstance()


def empty_result(job: Job, count: int, counters: int) -> dict[str, NDArray]:
    """Results of `count` points of which nothing is known yet."""
    result = {
        "status": np.full(count, Status.not_computed, np.int8),
        "message": np.full(count, "", object),
        "end_time": np.full(count, np.nan),
        "counters": np.full((count, counters), -1, np.int64),
        "wall_time": np.full(count, np.nan),
        "fmu_time": np.full(count, np.nan),
    }
    result |= {name: np.full(count, np.nan) for name in job.measures}
    return result | {name: np.full((count, len(job.times)), np.nan) for name in job.history}


def put(result: dict[str, NDArray], i: int, outcome: Outcome) -> None:
    """Writes one outcome as row i."""
    result["status"][i], result["message"][i] = outcome.status, outcome.message
    result["end_time"][i] = outcome.end_time
    if outcome.counters is not None:
        result["counters"][i] = np.where(np.isnan(outcome.counters), -1, outcome.counters)
    for name, value in outcome.measures.items():
        result[name][i] = value
    if outcome.history is not None:
        names = [name for name in result if result[name].ndim == 2 and name != "counters"]
        for k, name in enumerate(names):
            result[name][i, : len(outcome.history)] = outcome.history[:, k]
