"""One instance of wheel.fmu that runs one wheel after the other: fmi2Reset between runs, never a second instance.

march.c steps along the communication points, where Python would take longer than the wheel.
A start that several wheels share runs once. A wheel that fails is a status with the FMU's message; nothing in run_block
raises because of what a wheel does.
"""

from collections.abc import Mapping
from contextlib import suppress
from ctypes import CDLL, byref, c_size_t, c_uint, c_void_p, cast
from functools import cache
from pathlib import Path
from time import perf_counter

import numpy as np
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2FMUstate
from numpy.typing import NDArray

from .plan import PLANE_ANGLE, Measure, Status, Study, can_change, counters_of

Array = NDArray[np.float64]
Result = dict[str, NDArray]
OK, WARNING, DISCARD = range(3)  # fmi2Status
LAST_SUCCESSFUL_TIME, TERMINATED = 2, 3  # fmi2StatusKind
MARCH = "march.library"  # march.c, compiled (Dask would take a .so for a module), beside the FMU's modelDescription.xml
NUMBERS = {"Real": float, "Integer": int, "Boolean": int}

# Words of the FMU's message, for each way in which a run ends early.
ENDINGS = {
    "fell flat": Status.flat,
    "lifted off": Status.lifted_off,
    "needs a coefficient of friction": Status.grip,
}


class Instance:
    """The only instance of a worker, made by fmpy."""

    def __init__(self, folder: str) -> None:
        description = read_model_description(folder, validate=False)
        self.variables = {v.name: v for v in description.modelVariables}
        self.messages: list[str] = []  # since the start of the run
        of = {"guid": description.guid, "modelIdentifier": description.coSimulation.modelIdentifier}
        self.fmu = FMU2Slave(unzipDirectory=folder, instanceName="wheel", **of)
        callbacks = fmi2CallbackFunctions()  # the logger of instantiate_fmu would stay that of the process
        callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self.fmu.instantiate(callbacks=callbacks)
        self.typed = cache(self._typed)
        self._snapshot, self._kept = fmi2FMUstate(), None  # at branch_at: values and messages of that start
        self._march = CDLL(str(Path(folder) / MARCH)).march
        self._march.argtypes = (c_void_p,) * 4 + (c_size_t, c_void_p, c_size_t, c_void_p, c_void_p)
        self._functions_of_march = [cast(self.fmu.dll[name], c_void_p) for name in ("fmi2DoStep", "fmi2GetReal")]

    def _log(self, _environment: object, _name: bytes, status: int, _category: bytes, text: bytes) -> None:
        if status != OK:
            self.messages.append(text.decode())

    def _typed(self, names: tuple[str, ...]) -> list[tuple[str, list[str], list[int]]]:
        """For each type among the names: the type, the names and their value references."""
        of = {kind: [name for name in names if self.variables[name].type == kind] for kind in NUMBERS}
        return [(kind, mine, [self.variables[n].valueReference for n in mine]) for kind, mine in of.items() if mine]

    def set(self, values: Mapping[str, float]) -> None:
        for kind, names, references in self.typed(tuple(values)):
            getattr(self.fmu, f"set{kind}")(references, [NUMBERS[kind](values[name]) for name in names])

    def get(self, names: tuple[str, ...]) -> dict[str, float]:
        found = {}
        for kind, mine, references in self.typed(names):
            found |= zip(mine, getattr(self.fmu, f"get{kind}")(references), strict=True)
        return found

    def begin(self, values: Mapping[str, float], study: Study) -> tuple[Status, float]:
        """To t = 0, or to `branch_at`: restored if the start that was kept last had these values, else run and kept.

        FMICallException if the FMU refuses a value.
        """
        fmu, start = self.fmu, (values, study.tolerance, study.branch_at)
        if self._kept and self._kept[0] == start:
            self.messages = [*self._kept[1]]
            fmu.setFMUstate(self._snapshot)
            return Status.reached, study.branch_at
        self._kept, self.messages = None, []
        try:
            fmu.reset()
        except FMICallException:  # after fmi2Fatal the standard allows no further call to an instance
            fmu.instantiate(callbacks=fmu.callbacks)
        self.set(values)
        fmu.setupExperiment(study.tolerance)
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        if study.branch_at is None:
            return Status.reached, 0.0
        status, end, _ = self.march(np.array([0.0, study.branch_at]), ())
        if status == Status.reached:
            fmu.fmi2GetFMUstate(fmu.component, byref(self._snapshot))
            self._kept = (start, [*self.messages])
        return status, end

    def march(self, times: Array, names: tuple[str, ...]) -> tuple[Status, float, Array]:
        """Steps along the times from times[0], the present one.

        Returns the fate of the wheel, its time [s], and a row of these Real variables at each time that is reached.
        """
        rows, reached = np.empty((len(times), len(names))), c_size_t()
        references = (c_uint * len(names))(*(self.variables[name].valueReference for name in names))
        way = (times.ctypes.data, len(times), references, len(names), rows.ctypes.data)
        status = self._march(*self._functions_of_march, self.fmu.component, *way, byref(reached))
        end, fate = times[max(reached.value, 1) - 1], Status.reached if status <= WARNING else Status.failed
        if status == DISCARD:
            end, logged = self.fmu.getRealStatus(LAST_SUCCESSFUL_TIME), " ".join(self.messages)
            if self.fmu.getBooleanStatus(TERMINATED):
                fate = next((fate for words, fate in ENDINGS.items() if words in logged), fate)
        return fate, end, rows[: reached.value]


def run_block(fmu: Instance, study: Study, points: Mapping[str, Array]) -> Result:
    """The outcomes of wheels whose values by name are broadcast against each other, in C order.

    Of the study only what all its wheels have in common is used.
    """
    columns = [column.ravel().tolist() for column in np.broadcast_arrays(*points.values())]
    late = [name for name in points if study.branch_at is not None and can_change(fmu.variables[name])]
    changes = [dict(zip(points, row, strict=True)) for row in zip(*columns, strict=True)]
    starts = [{n: change.pop(n) for n in points if n not in late} | study.values for change in changes]
    order = sorted(range(len(starts)), key=lambda i: [*starts[i].values()] if late else i)  # a shared start in a row
    counters, sampled, times = counters_of(fmu.variables), tuple(study.sampled), np.array(study.times)
    at_end = {name: m for name, m in study.parsed.items() if m.kind == "last"}
    measures = {name: m for name, m in study.parsed.items() if name not in at_end}
    asked = tuple(dict.fromkeys([*(m.variable for m in at_end.values()), *counters]))
    result = {n: np.full(len(starts), np.nan) for n in ("status", "end_time", "fmu_time", "wall_time", *measures)}
    result |= {name: np.full((len(starts), len(times)), np.nan) for name in study.history}
    messages, ends = [""] * len(starts), [{}] * len(starts)

    for i in order:
        begin, rows = perf_counter(), np.empty(0)
        try:
            status, end = fmu.begin(starts[i], study)
            if status == Status.reached:
                fmu.set(changes[i])
                status, end, rows = fmu.march(times, sampled)
        except FMICallException:
            status, end = Status.refused, np.nan
            fmu.messages = fmu.messages or ["A value is outside its limits."]
        else:
            with suppress(FMICallException):  # an instance that failed may be unable to answer
                ends[i] = fmu.get(asked)
        result["fmu_time"][i] = perf_counter() - begin
        result["status"][i], result["end_time"][i], messages[i] = status, end, " ".join(fmu.messages)
        if rows.size:
            t = times[: len(rows)]
            for name, column in zip(study.history, rows.T, strict=False):
                result[name][i, : len(t)] = column
            if end > t[-1] and ends[i]:  # the end of a run is a sample too
                t, rows = np.append(t, end), np.vstack([rows, [*fmu.get(sampled).values()]])
            for name, measure in measures.items():
                result[name][i] = number(measure, t, rows[:, sampled.index(measure.variable)])
        result["wall_time"][i] = perf_counter() - begin

    result |= {name: np.array([end.get(name, -1) for end in ends]) for name in counters}
    for name, measure in at_end.items():
        result[name] = quantity(measure, np.array([end.get(measure.variable, np.nan) for end in ends]))
    return result | {"message": np.array(messages, "T")}


def quantity(measure: Measure, x: Array) -> Array:
    """What is measured, for values x of its variable; plane_angle is 90 deg - |theta - 90 deg|, in rad."""
    return np.pi / 2 - np.abs(x - np.pi / 2) if measure.quantity == PLANE_ANGLE else x


def number(measure: Measure, t: Array, x: Array) -> float:
    """The measure for samples x of its variable at the times t, the last of which is the end of the run.

    A time is that of the first passage, interpolated linearly between two samples; NaN if there is none.
    """
    x = quantity(measure, x)
    if measure.is_time:
        beyond = x < measure.limit if measure.kind == "<" else x > measure.limit
        k = int(np.argmax(beyond))
        if k == 0:
            return t[0] if beyond[0] else np.nan
        return t[k - 1] + (measure.limit - x[k - 1]) / (x[k] - x[k - 1]) * (t[k] - t[k - 1])
    if measure.kind == "mean":
        return np.trapezoid(x, t) / (t[-1] - t[0]) if len(t) > 1 else x[-1]
    return x.min() if measure.kind == "min" else x.max()
