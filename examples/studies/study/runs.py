"""Runs of one worker: a block of points, one after the other in one instance, with the start that they share run once.

A point that fails is a status with the FMU's own sentence; nothing here raises because of what a wheel does.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from ctypes import byref
from dataclasses import dataclass
from time import perf_counter

import numpy as np
from fmpy.fmi2 import fmi2FMUstate
from numpy.typing import NDArray

from .instance import WARNING, FMU2Instance, Status, Table
from .measures import PLANE_ANGLE, Measure

Array = NDArray[np.float64]
Columns = Mapping[str, NDArray]


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

    @property
    def at_the_end(self) -> dict[str, Measure]:
        """The measures that look at the end only."""
        return {name: m for name, m in self.measures.items() if not m.needs_samples}


@dataclass(frozen=True)
class Ending:
    """How a run ended, or the start that several runs share."""

    status: Status
    message: str = ""
    end_time: float = np.nan


class Runner:
    """The instance of a worker, and the snapshot of the start that it ran last."""

    def __init__(self, folder: str) -> None:
        self.instance = FMU2Instance(folder)
        self._snapshot = fmi2FMUstate()
        self._shared: tuple[object, Ending] | None = None

    def run_block(self, job: Job, points: Columns, enough: Callable[[], bool] = lambda: False) -> dict[str, NDArray]:
        """The outcomes of the points, whose values by name are columns; one row of each result per point.

        enough: asked after each point; ends the block early, the other points stay not computed.
        """
        run = _Block(self.instance, job, points)
        order = range(run.count)
        for i in sorted(order, key=run.early.key) if job.late else order:  # those that share a start follow each other
            begin = perf_counter()
            ending = self._run(run, i)
            run.put(i, ending)
            run.result["wall_time"][i] = perf_counter() - begin
            if enough():
                break
        return run.finished()

    def _run(self, run: _Block, i: int) -> Ending:
        """One wheel from its start, or from the snapshot, to its end."""
        job, begin = run.job, perf_counter()
        begun = self._begin(run, i) if job.branch_at is None else self._branch(run, i)
        if begun.status == Status.reached and run.late.move(i) > WARNING:
            begun = Ending(Status.refused, self.instance.take_message())
        ending, run.reached = begun, 0
        if begun.status == Status.reached:
            status, run.reached = self.instance.march(run.times, run.references, run.rows)
            ending = self._ending(status, run.times[-1], run.times[max(run.reached, 1) - 1], begun.message)
        if ending.status != Status.refused:
            run.read[i] = run.ends.move(i) <= WARNING
        run.result["fmu_time"][i] = perf_counter() - begin
        return ending

    def _begin(self, run: _Block, i: int) -> Ending:
        if self.instance.begin(run.early, i, run.job.tolerance) > WARNING:
            return Ending(Status.refused, self.instance.take_message() or "A value is outside its limits.")
        return Ending(Status.reached)

    def _branch(self, run: _Block, i: int) -> Ending:
        """At `branch_at`: restored if the last start was this one, else run there and kept."""
        unit, job = self.instance, run.job
        key = (job.branch_at, job.tolerance, *run.early.names, run.early.key(i))
        if self._shared and self._shared[0] == key:
            if self._shared[1].status == Status.reached:
                self._require(unit.fmi2SetFMUstate(unit.component, self._snapshot), "fmi2SetFMUstate")
            return self._shared[1]
        self._shared = None
        begun = self._begin(run, i)
        if begun.status == Status.reached:
            status, _ = unit.march(np.array([0.0, job.branch_at]), run.references[:0], run.rows)
            begun = self._ending(status, job.branch_at, 0.0)
        if begun.status == Status.reached:
            self._require(unit.fmi2GetFMUstate(unit.component, byref(self._snapshot)), "fmi2GetFMUstate")
        self._shared = (key, begun)
        return begun

    def _require(self, status: int, call: str) -> None:
        if status > WARNING:
            raise RuntimeError(f"{call} failed: {self.instance.take_message()}")

    def _ending(self, status: int, stop: float, last: float, said: str = "") -> Ending:
        """After a march that was to end at `stop` and completed its steps to `last`."""
        kind, time = Status.reached, stop
        if status > WARNING:
            kind, time = self.instance.ending(status)
        message = " ".join(filter(None, (said, self.instance.take_message())))
        return Ending(kind, message, last if np.isnan(time) else time)

    def close(self) -> None:
        """Frees the snapshot, the instance and the library."""
        self.instance.fmi2FreeFMUstate(self.instance.component, byref(self._snapshot))
        self.instance.freeInstance()


class _Block:
    """The values of some points, prepared for the FMU, and what comes out."""

    def __init__(self, unit: FMU2Instance, job: Job, points: Columns) -> None:
        self.job, self.counters = job, unit.counters
        self.count = len(next(iter(points.values())))
        values = {**job.values, **points}
        self.early = Table(unit, [n for n in values if n in job.values or n not in job.late], self.count, "Set")
        self.late = Table(unit, job.late, self.count, "Set")
        for name, value in values.items():
            if name in job.late:
                self.late[name][:] = value
            if name in self.early.names:
                self.early[name][:] = job.values[name] if name in job.late else value
        last = [m.variable for m in job.at_the_end.values()]
        self.ends = Table(unit, list(dict.fromkeys([*last, *self.counters])), self.count, "Get")
        self.read = np.zeros(self.count, bool)  # whether the row of `ends` is known
        self.times = np.array(job.times)
        self.references = np.array([unit.variables[name].valueReference for name in job.sampled], np.uint32)
        self.rows = np.empty((len(self.times) + 1, len(self.references)))  # one more for the end of a run
        self.final = Table(unit, job.sampled, 1, "Get")
        self.reached = 0
        self.result = empty_result(job, self.count, len(self.counters))

    def put(self, i: int, ending: Ending) -> None:
        """Writes what became of point i, whose samples are in `rows`."""
        result, job, n = self.result, self.job, self.reached
        result["status"][i], result["message"][i] = ending.status, ending.message
        result["end_time"][i] = ending.end_time
        if not n or not len(self.references):
            return
        for k, name in enumerate(job.history):
            result[name][i, :n] = self.rows[:n, k]
        t = self.times[:n]
        if ending.end_time > t[-1]:  # the end of a run is a sample too
            self.final.move(0)
            t, n = np.append(t, ending.end_time), n + 1
            self.rows[n - 1] = [self.final[name][0] for name in job.sampled]
        for name, measure in job.measures.items():
            if measure.needs_samples:
                result[name][i] = number(measure, t, self.rows[:n, job.sampled.index(measure.variable)])

    def finished(self) -> dict[str, NDArray]:
        """All results, those that were read at the end included."""
        for name, measure in self.job.at_the_end.items():
            values = np.where(self.read, self.ends[measure.variable], np.nan)
            self.result[name][:] = plane_angle(values) if measure.quantity == PLANE_ANGLE else values
        for k, name in enumerate(self.counters):
            self.result["counters"][:, k] = np.where(self.read, self.ends[name], -1)
        return self.result


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
