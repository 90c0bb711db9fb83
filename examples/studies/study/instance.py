"""One instance of wheel.fmu that runs one wheel after the other: fmi2Reset between runs, never a second instance.

Built on the signatures and the loading of fmpy's FMU2Slave. The functions that are called once per communication step
are taken from the library directly: fmpy's wrapper around them costs more than a step of the wheel.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from ctypes import byref, c_double, c_int, c_size_t, c_uint, c_void_p
from enum import IntEnum
from time import perf_counter

import numpy as np
from fmpy import read_model_description
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from numpy.typing import NDArray

Array = NDArray[np.float64]
OK, WARNING, DISCARD, ERROR, FATAL = range(5)  # fmi2Status
LAST_SUCCESSFUL_TIME, TERMINATED = 2, 3  # fmi2StatusKind


class Status(IntEnum):
    """What became of one wheel."""

    not_computed = -1
    reached = 0  # the stop time
    flat = 1  # theta came to 0 or pi
    lifted_off = 2  # N came to 0
    refused = 3  # a start value or a parameter is impossible
    failed = 4  # the run ended with an error, or the worker process died


# What the FMU says of each ending.
ENDINGS = {"fell flat": Status.flat, "lifted off": Status.lifted_off}


class Refused(Exception):
    """The FMU refuses these start values; the text is its own."""


class FMU2Instance(FMU2Slave):
    """The only instance of a worker. fmpy chooses the functions to load by the name FMU2."""

    def __init__(self, folder: str) -> None:
        self.description = read_model_description(folder, validate=False)
        super().__init__(
            guid=self.description.guid,
            unzipDirectory=folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="study",
        )
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.counters = counters_of(self.description)
        self.sentences: list[str] = []
        self.spent = 0.0  # s inside the FMU, since the count was last set to zero
        self._do_step = self._raw("fmi2DoStep", c_void_p, c_double, c_double, c_int)
        self._get_real = self._raw("fmi2GetReal", c_void_p, c_void_p, c_size_t, c_void_p)
        self._own_callbacks = fmi2CallbackFunctions()
        self._own_callbacks.logger = fmi2CallbackLoggerTYPE(self._listen)
        self.instantiate(callbacks=self._own_callbacks)

    def _raw(self, name: str, *argtypes: type):
        function = self.dll[name]  # a new function object each time, so fmpy's own keeps its types
        function.argtypes, function.restype = argtypes, c_int
        return function

    def _listen(self, _environment: object, _name: bytes, status: int, _category: bytes, text: bytes) -> None:
        if status != OK:
            self.sentences.append(text.decode())

    def _call(self, fname: str, *args: object) -> int:
        """Every call through fmpy: timed, and its status given back where fmpy would raise."""
        begin = perf_counter()
        status = self._functions[fname](*args)
        self.spent += perf_counter() - begin
        return status

    def take_message(self) -> str:
        """What the FMU has said since this was last asked, as one line."""
        message, self.sentences = " ".join(self.sentences), []
        return message

    def begin(self, values: Mapping[str, float], tolerance: float | None) -> None:
        """From whatever went before to t = 0 with these values by name; raises Refused."""
        self.sentences = []
        if self.fmi2Reset(self.component) > WARNING:  # the standard allows nothing more to an instance after fmi2Fatal
            self.instantiate(callbacks=self._own_callbacks)
        status = max(self.set(values), self.setupExperiment(tolerance, 0.0, None))
        if status <= WARNING:
            status = max(self.enterInitializationMode(), self.exitInitializationMode())
        if status > WARNING:
            raise Refused(self.take_message() or f"A value is outside its limits: {dict(values)}.")

    def set(self, values: Mapping[str, float]) -> int:
        """Sets values by name, each with the function of its type; the worst status."""
        status = OK
        for name, value in values.items():
            variable = self.variables[name]
            reference = (c_uint * 1)(variable.valueReference)
            if variable.type == "Real":
                status = max(status, self.fmi2SetReal(self.component, reference, 1, (c_double * 1)(value)))
            else:
                call = self.fmi2SetBoolean if variable.type == "Boolean" else self.fmi2SetInteger
                status = max(status, call(self.component, reference, 1, (c_int * 1)(int(value))))
        return status

    def read(self, names: Sequence[str]) -> Array:
        """Values by name now, all as floating-point numbers."""
        row = np.empty(len(names))
        for i, name in enumerate(names):
            reference = (c_uint * 1)(self.variables[name].valueReference)
            real = self.variables[name].type == "Real"
            value = ((c_double if real else c_int) * 1)()
            call = self.fmi2GetReal if real else self.fmi2GetInteger
            row[i] = value[0] if call(self.component, reference, 1, value) <= WARNING else math.nan
        return row

    def march(self, times: Array, names: Sequence[str]) -> tuple[int, Array]:
        """Steps along the times from times[0], where the instance stands.

        Returns the FMI status of the last step and the rows of `names` (Real variables) at all times that were reached,
        times[0] included.
        """
        rows = np.empty((len(times), len(names)))
        references = (c_uint * len(names))(*(self.variables[name].valueReference for name in names))
        step, get, component, count = self._do_step, self._get_real, self.component, len(names)
        address, stride, points = rows.ctypes.data, rows.strides[0], times.tolist()
        reached, status = 1, get(component, references, count, address) if count else OK
        begin = perf_counter()
        for k in range(1, len(points)):
            status = step(component, points[k - 1], points[k] - points[k - 1], 0)
            if status > WARNING:
                break
            if count:
                get(component, references, count, address + k * stride)
            reached += 1
        self.spent += perf_counter() - begin
        return status, rows[:reached]

    def ending(self, status: int) -> tuple[Status, float]:
        """After a step that was not completed: what happened, and when [s] (NaN if the FMU does not say)."""
        time, ended = c_double(math.nan), c_int(0)
        if status == DISCARD:
            self.fmi2GetRealStatus(self.component, LAST_SUCCESSFUL_TIME, byref(time))
            self.fmi2GetBooleanStatus(self.component, TERMINATED, byref(ended))
        if not ended.value:
            return Status.failed, time.value
        said = " ".join(self.sentences)
        return next(kind for words, kind in ENDINGS.items() if words in said), time.value


def counters_of(description) -> list[str]:
    """The FMU's counters: Integer variables whose name begins with n_."""
    return [v.name for v in description.modelVariables if v.type == "Integer" and v.name.startswith("n_")]
