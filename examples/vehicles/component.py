"""One FMU of a system, driven through its C functions with buffers that are made once."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from ctypes import POINTER, byref, c_double, c_int, c_size_t, c_uint, c_void_p
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

OK, DISCARD = 0, 2  # fmi2Status
TERMINATED, LAST_SUCCESSFUL = 3, 2  # fmi2StatusKind
_doubles, _integers, _references, _size = POINTER(c_double), POINTER(c_int), POINTER(c_uint), c_size_t


class Ended(Exception):  # noqa: N818 - an ending, such as a wheel's lift-off, is no error
    """A component ended the run. `component`, `time` [s], `sentence`: its own words."""

    def __init__(self, component: str, time: float, sentence: str) -> None:
        super().__init__(f"{component}: {sentence}")
        self.component, self.time, self.sentence = component, time, sentence


class Values:
    """A list of variables of one component, with buffers for their values and derivatives."""

    def __init__(self, component: Component, names: Sequence[str]) -> None:
        self.names, self.fmu = list(names), component.fmu
        self.count = len(self.names)
        self.references = (c_uint * self.count)(*component.references(self.names))
        self.values, self.derivatives = np.zeros(self.count), np.zeros(self.count)
        self.orders = {order: (c_int * self.count)(*[order] * self.count) for order in (1, 2, 3)}
        # Made once: a pointer to a numpy array takes longer than the call it is for.
        self._values, self._derivatives = (x.ctypes.data_as(_doubles) for x in (self.values, self.derivatives))

    def get(self) -> np.ndarray:
        """Read into the buffer, and return it."""
        self.fmu.dll.fmi2GetReal(self.fmu.component, self.references, self.count, self._values)
        return self.values

    def set(self, values: np.ndarray) -> None:
        """fmi2SetReal."""
        self.values[:] = values
        status = self.fmu.dll.fmi2SetReal(self.fmu.component, self.references, self.count, self._values)
        if status != OK:
            raise ValueError(f"{self.fmu.instanceName} does not take {dict(zip(self.names, values, strict=True))}.")

    def rates(self) -> np.ndarray:
        """Read first derivatives of outputs into their buffer, and return it."""
        dll, c = self.fmu.dll, self.fmu.component
        dll.fmi2GetRealOutputDerivatives(c, self.references, self.count, self.orders[1], self._derivatives)
        return self.derivatives

    def set_derivative(self, order: int, values: np.ndarray) -> None:
        """Derivative of inputs."""
        dll, c = self.fmu.dll, self.fmu.component
        self.derivatives[:] = values
        dll.fmi2SetRealInputDerivatives(c, self.references, self.count, self.orders[order], self._derivatives)


@dataclass
class Component:
    """One FMU: its name in the system, its file, and the start values of its parameters."""

    name: str
    path: Path
    start: dict[str, float] = field(default_factory=dict)

    def load(self) -> None:
        """Unpack and instantiate; parameters and start values are set."""
        self.folder, self.log, self.state = extract(str(self.path)), [], c_void_p()
        self.description = read_model_description(self.folder)
        self.variable = {v.name: v for v in self.description.modelVariables}
        self.fmu = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=self.name,
        )
        self._prototypes()
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(lambda _e, _n, _s, _c, text: self.log.append(text.decode()))
        self.fmu.instantiate(callbacks=self.callbacks)
        self.fmu.setupExperiment(startTime=0.0)
        for name, value in self.start.items():
            self._set_start(name, value)

    def _prototypes(self) -> None:
        """Only numpy's buffers go through; without prototypes ctypes would have to convert each call's numbers."""
        dll = self.fmu.dll
        values = [c_void_p, _references, _size, _doubles]
        derivatives = [c_void_p, _references, _size, _integers, _doubles]
        for name in ("fmi2GetReal", "fmi2SetReal"):
            getattr(dll, name).argtypes = values
        for name in ("fmi2GetRealOutputDerivatives", "fmi2SetRealInputDerivatives"):
            getattr(dll, name).argtypes = derivatives

    def _set_start(self, name: str, value: float) -> None:
        if name not in self.variable:
            raise ValueError(f"{self.name} has no variable {name}.")
        kind, reference = self.variable[name].type, self.references([name])
        if kind == "Boolean":
            self.fmu.setBoolean(reference, [bool(value)])
        elif kind == "Real":
            self.fmu.setReal(reference, [float(value)])
        else:
            self.fmu.setInteger(reference, [int(value)])

    def initialize(self) -> None:
        """Leave initialization mode."""
        self.fmu.exitInitializationMode()

    def free(self) -> None:
        """End the run and remove the unpacked files."""
        self.fmu.dll.fmi2FreeFMUstate(self.fmu.component, byref(self.state))
        self.fmu.dll.fmi2Terminate(self.fmu.component)
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def references(self, names: Sequence[str]) -> list[int]:
        """Value references of variables."""
        missing = [name for name in names if name not in self.variable]
        if missing:
            raise ValueError(f"{self.name} has no variable {missing[0]}.")
        return [self.variable[name].valueReference for name in names]

    def feeds(self, output: str) -> list[str]:
        """Inputs on which an output depends directly; undeclared dependencies mean all."""
        unknown = [u for u in self.description.outputs if u.variable.name == output]
        if not unknown or unknown[0].dependencies is None:
            return [v.name for v in self.description.modelVariables if v.causality == "input"]
        return [v.name for v in unknown[0].dependencies]

    def step(self, t: float, h: float, undoable: bool) -> None:
        """fmi2DoStep; `undoable`: the master may set back a state from before it. Raises Ended."""
        status = self.fmu.dll.fmi2DoStep(self.fmu.component, t, h, 0 if undoable else 1)
        if status != OK:
            raise Ended(self.name, self._last_time(t), self.log[-1] if self.log else f"fmi2DoStep gave {status}")

    def _last_time(self, t: float) -> float:
        value = c_double(t)
        self.fmu.dll.fmi2GetRealStatus(self.fmu.component, LAST_SUCCESSFUL, byref(value))
        return value.value

    def keep(self) -> None:
        """Take a snapshot, in the place of the one before."""
        self.fmu.dll.fmi2GetFMUstate(self.fmu.component, byref(self.state))

    def restore(self) -> None:
        """Go back to the snapshot."""
        self.fmu.dll.fmi2SetFMUstate(self.fmu.component, self.state)
