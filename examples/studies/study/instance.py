"""One instance of wheel.fmu that runs one wheel after the other: fmi2Reset between runs, never a second instance.

Built on the signatures and the loading of fmpy's FMU2Slave. The functions that are called for each wheel are taken from
the library directly, with arguments that are prepared once per block: fmpy's wrappers cost more than the wheel.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from ctypes import CDLL, byref, c_double, c_int, c_size_t, c_void_p, cast
from enum import IntEnum
from pathlib import Path

import numpy as np
from fmpy import read_model_description
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from numpy.typing import NDArray

Array = NDArray[np.float64]
OK, WARNING, DISCARD, ERROR, FATAL = range(5)  # fmi2Status
LAST_SUCCESSFUL_TIME, TERMINATED = 2, 3  # fmi2StatusKind
MARCH = "march.library"  # march.c, compiled (Dask would take a .so for a module), beside the FMU's modelDescription.xml


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


class Table:
    """Values of some variables for many wheels: a row goes to or from the FMU by one call per type."""

    def __init__(self, unit: FMU2Instance, names: Sequence[str], rows: int, access: str) -> None:
        """access: Get or Set."""
        self._unit, self.names, self._parts, self._column = unit, tuple(names), [], {}
        for kind in ("Real", "Integer", "Boolean"):
            mine = [name for name in names if unit.variables[name].type == kind]
            if mine:
                values = np.zeros((rows, len(mine)), np.float64 if kind == "Real" else np.int32)
                references = np.array([unit.variables[name].valueReference for name in mine], np.uint32)
                call = unit.raw(f"fmi2{access}{kind}", c_void_p, c_void_p, c_size_t, c_void_p)
                fixed = (call, references.ctypes.data, len(mine), values.ctypes.data, values.strides[0])
                self._parts.append((*fixed, values, references))
                self._column |= {name: values[:, k] for k, name in enumerate(mine)}

    def __getitem__(self, name: str) -> NDArray:
        """All rows of one variable, to read or to fill."""
        return self._column[name]

    def move(self, row: int) -> int:
        """Sets or gets one row; the worst status."""
        worst = OK
        for call, references, count, address, stride, *_ in self._parts:
            worst = max(worst, call(self._unit.component, references, count, address + row * stride))
        return worst

    def key(self, row: int) -> bytes:
        """Equal for rows of equal values."""
        return b"".join(part[5][row].tobytes() for part in self._parts)


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
        self._own_callbacks = fmi2CallbackFunctions()
        self._own_callbacks.logger = fmi2CallbackLoggerTYPE(self._listen)
        self.instantiate(callbacks=self._own_callbacks)
        self._reset, self._enter, self._exit = (
            self.raw(f"fmi2{name}", c_void_p) for name in ("Reset", "EnterInitializationMode", "ExitInitializationMode")
        )
        self._set_up = self.raw("fmi2SetupExperiment", c_void_p, c_int, c_double, c_double, c_int, c_double)
        self._march = CDLL(str(Path(folder) / MARCH)).march
        self._march.argtypes = (c_void_p,) * 4 + (c_size_t, c_void_p, c_size_t, c_void_p, c_void_p)
        self._functions_of_march = [cast(self.dll[name], c_void_p) for name in ("fmi2DoStep", "fmi2GetReal")]

    def raw(self, name: str, *argtypes: type):
        """A function of the library that returns its status."""
        function = self.dll[name]  # a new function object each time, so fmpy's own keeps its types
        function.argtypes, function.restype = argtypes, c_int
        return function

    def _listen(self, _environment: object, _name: bytes, status: int, _category: bytes, text: bytes) -> None:
        if status != OK:
            self.sentences.append(text.decode())

    def take_message(self) -> str:
        """What the FMU has said since this was last asked, as one line."""
        message, self.sentences = " ".join(self.sentences), []
        return message

    def begin(self, values: Table, row: int, tolerance: float | None) -> int:
        """From whatever went before to t = 0 with these values; the worst status."""
        self.sentences = []
        if self._reset(self.component) > WARNING:  # the standard allows nothing more to an instance after fmi2Fatal
            self.instantiate(callbacks=self._own_callbacks)
        worst = values.move(row)
        given = tolerance is not None
        worst = max(worst, self._set_up(self.component, given, tolerance if given else 0.0, 0.0, 0, 0.0))
        if worst <= WARNING:
            worst = max(worst, self._enter(self.component), self._exit(self.component))
        return worst

    def march(self, times: Array, references: NDArray[np.uint32], rows: Array) -> tuple[int, int]:
        """Steps along the times from times[0], where the instance stands, and fills a row at each time that is reached.

        Returns the FMI status of the last step and the number of rows. `references` are of Real variables.
        """
        reached = c_size_t()
        status = self._march(
            *self._functions_of_march,
            self.component,
            times.ctypes.data,
            len(times),
            references.ctypes.data,
            len(references),
            rows.ctypes.data,
            byref(reached),
        )
        return status, reached.value

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
