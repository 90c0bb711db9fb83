"""One instance of wheel.fmu that runs one wheel after the other: fmi2Reset between runs, never a second instance.

Built on fmpy's FMU2Slave. The calls for each wheel use buffers that are prepared once for many wheels, and march.c
steps along the communication points: fmpy's loops would take longer than the wheel.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from ctypes import CDLL, byref, c_double, c_int, c_size_t, c_uint, c_void_p, cast
from enum import IntEnum
from pathlib import Path

import numpy as np
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.model_description import ModelDescription
from numpy.typing import ArrayLike, NDArray

OK, WARNING, DISCARD, ERROR, FATAL = range(5)  # fmi2Status
LAST_SUCCESSFUL_TIME, TERMINATED = 2, 3  # fmi2StatusKind
MARCH = "march.library"  # march.c, compiled (Dask would take a .so for a module), beside the FMU's modelDescription.xml
KINDS = {"Real": c_double, "Integer": c_int, "Boolean": c_int}


class Status(IntEnum):
    """The fate of one wheel."""

    not_computed = -1
    reached = 0  # the stop time
    flat = 1  # theta came to 0 or pi
    lifted_off = 2  # N came to 0
    refused = 3  # a start value or a parameter is impossible
    failed = 4  # the run ended with an error, or the worker process died
    grip = 5  # mu_required came to mu_max


# Words of the FMU's message, for each way in which a run ends early.
ENDINGS = {
    "fell flat": Status.flat,
    "lifted off": Status.lifted_off,
    "needs a coefficient of friction": Status.grip,
}


class Table:
    """Values of some variables for many wheels; a row goes to or comes from the FMU by one call per type."""

    def __init__(self, fmu: FMU2Instance, columns: Mapping[str, ArrayLike], rows: int) -> None:
        self._fmu, self._parts, self._column = fmu, [], {}
        for kind, number in KINDS.items():
            mine = [name for name in columns if fmu.variables[name].type == kind]
            if mine:
                values, buffer = np.empty((rows, len(mine)), number), (number * len(mine))()
                self._parts.append((kind, fmu.references(mine), buffer, np.ctypeslib.as_array(buffer), values))
                self._column |= dict(zip(mine, values.T, strict=True))
        for name, column in columns.items():
            self._column[name][:] = column

    def __getitem__(self, name: str) -> NDArray:
        """All rows of one variable."""
        return self._column[name]

    def set(self, row: int) -> None:
        for kind, references, buffer, row_of, values in self._parts:
            row_of[:] = values[row]
            getattr(self._fmu, f"fmi2Set{kind}")(self._fmu.component, references, len(references), buffer)

    def get(self, row: int) -> None:
        for kind, references, buffer, row_of, values in self._parts:
            getattr(self._fmu, f"fmi2Get{kind}")(self._fmu.component, references, len(references), buffer)
            values[row] = row_of

    def key(self, row: int) -> tuple:
        """Equal for rows of equal values."""
        return tuple((name, column[row]) for name, column in self._column.items())


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
        self.messages: list[str] = []  # since the start of the run
        self._logging = fmi2CallbackFunctions()
        self._logging.logger = fmi2CallbackLoggerTYPE(self._log)
        self.instantiate(callbacks=self._logging)
        self._march = CDLL(str(Path(folder) / MARCH)).march
        self._march.argtypes = (c_void_p,) * 4 + (c_size_t, c_void_p, c_size_t, c_void_p, c_void_p)
        self._functions_of_march = [cast(self.dll[name], c_void_p) for name in ("fmi2DoStep", "fmi2GetReal")]

    def references(self, names: Sequence[str]) -> object:
        """The value references of some variables, as the FMU takes them."""
        return (c_uint * len(names))(*(self.variables[name].valueReference for name in names))

    def _log(self, _environment: object, _name: bytes, status: int, _category: bytes, text: bytes) -> None:
        if status != OK:
            self.messages.append(text.decode())

    def begin(self, values: Table, row: int, tolerance: float | None) -> tuple[Status, float]:
        """From any state to t = 0 with these values."""
        self.messages = []
        try:
            self.reset()
        except FMICallException:  # after fmi2Fatal the standard allows no further call to an instance
            self.instantiate(callbacks=self._logging)
        try:
            values.set(row)
            self.setupExperiment(tolerance)
            self.enterInitializationMode()
            self.exitInitializationMode()
        except FMICallException:
            self.messages = self.messages or ["A value is outside its limits."]
            return Status.refused, np.nan
        return Status.reached, 0.0

    def march(self, times: NDArray, references: object, rows: NDArray) -> tuple[Status, float, int]:
        """Steps along the times from times[0], the present one, and fills a row at each time that is reached.

        Returns the fate of the wheel, its time [s], and the number of rows. `references` are of Real variables.
        """
        reached, arrays = c_size_t(), (times.ctypes.data, len(times), references, len(references), rows.ctypes.data)
        status = self._march(*self._functions_of_march, self.component, *arrays, byref(reached))
        last = times[max(reached.value, 1) - 1]
        return *self._ending(status, last), reached.value

    def _ending(self, status: int, last: float) -> tuple[Status, float]:
        """After a march whose last completed step ended at `last`."""
        if status <= WARNING:
            return Status.reached, last
        time, ended = c_double(last), c_int(0)
        if status == DISCARD:
            self.fmi2GetRealStatus(self.component, LAST_SUCCESSFUL_TIME, byref(time))
            self.fmi2GetBooleanStatus(self.component, TERMINATED, byref(ended))
        logged = " ".join(self.messages)
        found = (kind for words, kind in ENDINGS.items() if words in logged and ended.value)
        return next(found, Status.failed), time.value


def counters_of(description: ModelDescription) -> list[str]:
    """The FMU's counters: Integer variables whose name begins with n_."""
    return [v.name for v in description.modelVariables if v.type == "Integer" and v.name.startswith("n_")]


def can_change(description: ModelDescription, name: str) -> bool:
    """Whether a variable may be set between steps."""
    variable = next(v for v in description.modelVariables if v.name == name)
    return variable.causality == "input" or variable.variability == "tunable"
