"""Drives wheel.fmu through fmpy's FMU2Slave as a master does: set, initialise, step, read; endings and messages kept.

SI units; names are those of modelDescription.xml. One library is loaded once, instances come and go.
"""

from __future__ import annotations

import shutil
from ctypes import byref
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

import numpy as np
from fmpy import extract, fmi2, read_model_description
from fmpy.fmi1 import FMICallException

OK, WARNING, DISCARD, ERROR = range(4)
ENUMERATIONS = {
    "formulation": {"automatic": 1, "reduced": 2, "multibody": 3},
    "friction_law": {"exact": 1, "regularized": 2},
    "method": {"automatic": 1, "adams": 2, "bdf": 3},
}
COUNTERS = ("n_steps", "n_rhs", "n_jac", "n_roots", "n_events", "n_restarts")
Values = dict[str, float | str | bool]


@dataclass
class Run:
    """What one run showed. status: that of the last call; end: the instant an ended run stopped at, else None."""

    columns: dict[str, np.ndarray]
    messages: list[str]
    status: int
    end: float | None
    seconds: float
    counters: dict[str, int] = field(default_factory=dict)

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]


class Library:
    """The unpacked FMU and its loaded library."""

    def __init__(self, fmu: Path) -> None:
        self.folder = extract(str(fmu))
        description = read_model_description(self.folder)
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.types = {v.name: v.type for v in description.modelVariables}
        arguments = {"guid": description.guid, "modelIdentifier": description.coSimulation.modelIdentifier}
        self.slave = fmi2.FMU2Slave(instanceName="wheel", unzipDirectory=self.folder, **arguments)

    def close(self) -> None:
        self.slave.freeLibrary()
        shutil.rmtree(self.folder)


class Wheel:
    """One instance."""

    def __init__(self, library: Library, logging: bool = False) -> None:
        self.library, self.messages = library, []
        self._logger = fmi2.fmi2CallbackLoggerTYPE(self._keep)
        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = self._logger
        library.slave.instantiate(callbacks=callbacks, loggingOn=logging)
        self.component = library.slave.component
        self.time = 0.0

    def _keep(self, _environment, _name, _status, _category, message: bytes) -> None:
        self.messages.append(message.decode().replace("%%", "%").replace("##", "#"))

    def __enter__(self) -> Wheel:
        return self

    def __exit__(self, *_: object) -> None:
        self.library.slave.fmi2FreeInstance(self.component)

    def _status(self, function: str, *arguments: object) -> int:
        try:
            return getattr(self.library.slave, function)(self.component, *arguments)
        except FMICallException as refusal:
            return refusal.status

    def set(self, values: Values) -> int:
        worst = OK
        for name, value in values.items():
            value = ENUMERATIONS[name][value] if isinstance(value, str) else value
            reference = (fmi2.fmi2ValueReference * 1)(self.library.references[name])
            kind, holder = {
                "Real": ("Real", fmi2.fmi2Real),
                "Boolean": ("Boolean", fmi2.fmi2Boolean),
            }.get(self.library.types[name], ("Integer", fmi2.fmi2Integer))
            worst = max(worst, self._status(f"fmi2Set{kind}", reference, 1, (holder * 1)(value)))
        return worst

    def initialise(self, tolerance: float | None = None, start_time: float = 0.0) -> int:
        self.time = start_time
        has = int(tolerance is not None)
        status = self._status("fmi2SetupExperiment", has, tolerance or 0.0, start_time, 0, 0.0)
        if status <= WARNING:
            status = self._status("fmi2EnterInitializationMode")
        return self._status("fmi2ExitInitializationMode") if status <= WARNING else status

    def reset(self) -> int:
        return self._status("fmi2Reset")

    def step_to(self, t: float) -> int:
        """Steps to t. After an ending, self.time is its instant."""
        status = self._status("fmi2DoStep", self.time, t - self.time, 1)
        if status <= WARNING:
            self.time = t
        elif status == DISCARD:
            self.time = self.last_time()
        return status

    def last_time(self) -> float:
        value = fmi2.fmi2Real()
        self._status("fmi2GetRealStatus", fmi2.fmi2LastSuccessfulTime, byref(value))
        return value.value

    def terminated(self) -> bool:
        value = fmi2.fmi2Boolean()
        self._status("fmi2GetBooleanStatus", fmi2.fmi2Terminated, byref(value))
        return bool(value.value)

    def reader(self, names: tuple[str, ...]):
        """A function that reads these real variables, as a fresh list."""
        references = (fmi2.fmi2ValueReference * len(names))(*(self.library.references[n] for n in names))
        values = (fmi2.fmi2Real * len(names))()
        return lambda: (self._status("fmi2GetReal", references, len(names), values), list(values))[1]

    def rates(self, names: tuple[str, ...]):
        """A function that reads the first derivatives of these outputs."""
        references = (fmi2.fmi2ValueReference * len(names))(*(self.library.references[n] for n in names))
        values, orders = (fmi2.fmi2Real * len(names))(), (fmi2.fmi2Integer * len(names))(*[1] * len(names))
        call = "fmi2GetRealOutputDerivatives"
        return lambda: (self._status(call, references, len(names), orders, values), list(values))[1]

    def integers(self, names: tuple[str, ...]) -> list[int]:
        references = (fmi2.fmi2ValueReference * len(names))(*(self.library.references[n] for n in names))
        values = (fmi2.fmi2Integer * len(names))()
        self._status("fmi2GetInteger", references, len(names), values)
        return list(values)


SIGNALS = (
    *("E", "theta", "theta_dot", "psi", "psi_dot", "phi", "phi_dot", "omega_z", "X_O", "Y_O", "Z_O"),
    *("X_O_dot", "Y_O_dot", "Z_O_dot", "lambda_1", "lambda_2", "lambda_3"),
)


def run(library: Library, values: Values, times: np.ndarray, tolerance: float | None = None, events=False) -> Run:
    """Steps through `times` (the first is the start) and reads all signals; an ended run has its last row there."""
    with Wheel(library, logging=events) as wheel:
        status = wheel.set(values)
        status = max(status, wheel.initialise(tolerance, float(times[0])))
        rows, rates, modes, seconds, end = [], [], [], 0.0, None
        read, read_rates = wheel.reader(SIGNALS), wheel.rates(("omega_z", "lambda_3"))
        if status > WARNING:
            return Run({}, wheel.messages, status, None, 0.0)

        def record() -> None:
            rows.append([wheel.time, *read()])
            rates.append(read_rates())
            modes.append(wheel.integers(("friction_mode", "n_events")))

        record()
        for t in times[1:]:
            before = perf_counter()
            status = wheel.step_to(float(t))
            seconds += perf_counter() - before
            if status == DISCARD and wheel.terminated():
                end = wheel.time
            if status <= WARNING or end is not None:
                record()
            if status > WARNING:
                break
        columns = dict(zip(("t", *SIGNALS), np.array(rows).T, strict=True))
        columns.update(zip(("omega_z_dot", "lambda_3_dot"), np.array(rates).T, strict=True))
        columns.update(zip(("friction_mode", "n_events"), np.array(modes).T, strict=True))
        counters = dict(zip(COUNTERS, wheel.integers(COUNTERS), strict=True))
        return Run(columns, wheel.messages, status, end, seconds, counters)
