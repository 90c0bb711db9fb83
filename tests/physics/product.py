"""The built FMU as a function from a scene to its motion, in one process, through fmpy's FMU2Slave.

Names, frames and units are those of modelDescription.xml. Used by the physics tests and by scripts/accuracy.py.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray
from reference import Start, Wheel

from .schedule import INPUTS, Schedule

Array = NDArray[np.float64]
HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
COUNTERS = ("n_steps", "n_rhs", "n_jac", "n_roots", "n_events", "n_restarts")
TRANSITION = re.compile(r"t = (\S+) s: .*(stick|negative|positive)")
MODES = {"stick": 0, "negative": -1, "positive": 1}
DISCARD = 2  # fmi2Status
LAST_SUCCESSFUL_TIME = 2  # fmi2StatusKind


@dataclass(frozen=True)
class Result:
    """Columns by name (result["X_O"]); events: (t, mode) as the log tells them; ended: the log's last sentence.

    An ended run has its last row at the ending.
    """

    t: Array
    columns: dict[str, Array]
    events: list[tuple[float, int]]
    counters: dict[str, int]
    ended: str | None

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]


def start_values(wheel: Wheel, start: Start) -> dict[str, float]:
    """A wheel and a start of the reference as start values of the FMU."""
    return asdict(wheel) | {f"{name}_start": value for name, value in asdict(start).items()}


class Product:
    """The unpacked FMU, loaded once; each `simulate` is an instance of its own."""

    def __init__(self, folder: str, description: ModelDescription) -> None:
        self.folder = folder
        self.description = description
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        readable = [v for v in description.modelVariables if v.causality in ("output", "local")]
        self.reals = [v.name for v in readable if v.type == "Real"]
        self.integers = [v.name for v in readable if v.type == "Integer"]
        self.kinds = {v.name: v.type for v in description.modelVariables}

    def simulate(
        self,
        times: Sequence[float],
        tolerance: float | None = None,
        inputs: Schedule | None = None,
        **start: float,
    ) -> Result:
        """The motion from times[0], read at `times` (rising); start values by name, the rest as in the XML."""
        slave, sentences = self._begin(float(times[0]), tolerance, inputs or Schedule(), start)
        try:
            rows, ended = self._march(slave, [float(t) for t in times], inputs or Schedule())
        finally:
            slave.freeInstance()
        table = np.array([row[1:] for row in rows])
        names = [*self.reals, *self.integers]
        columns = {name: table[:, i] for i, name in enumerate(names)}
        events = [(float(m[1]), MODES[m[2]]) for s in sentences if (m := TRANSITION.match(s))]
        counters = {name: int(columns.pop(name)[-1]) for name in COUNTERS}
        return Result(np.array([r[0] for r in rows]), columns, events, counters, sentences[-1] if ended else None)

    def slave(self, logger: fmi2CallbackLoggerTYPE | None = None) -> FMU2Slave:
        """An instance; its events are logged if there is a logger."""
        slave = FMU2Slave(
            instanceName="physics",
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
        )
        if logger is None:
            slave.instantiate()
        else:
            callbacks = fmi2CallbackFunctions()
            callbacks.logger = logger
            slave.instantiate(callbacks=callbacks, loggingOn=True)
        return slave

    def set_start(self, slave: FMU2Slave, start: dict[str, float]) -> None:
        for name, value in start.items():
            setter = {"Real": slave.setReal, "Boolean": slave.setBoolean}.get(self.kinds[name], slave.setInteger)
            setter([self.reference[name]], [value])

    def _begin(
        self, t: float, tolerance: float | None, inputs: Schedule, start: dict[str, float]
    ) -> tuple[FMU2Slave, list[str]]:
        sentences: list[str] = []

        def log(_environment: object, _name: bytes, _status: int, _category: bytes, message: bytes) -> None:
            sentences.append(message.decode())

        slave = self.slave(fmi2CallbackLoggerTYPE(log))
        self.set_start(slave, start)
        slave.setupExperiment(tolerance=tolerance, startTime=t)
        slave.enterInitializationMode()
        self._feed(slave, inputs, t)
        slave.exitInitializationMode()
        return slave, sentences

    def _feed(self, slave: FMU2Slave, inputs: Schedule, t: float) -> None:
        """The inputs' polynomials about t, to the third derivative."""
        if not inputs.pieces:
            return
        derivatives = inputs.derivatives(t)
        references = [self.reference[name] for name in INPUTS]
        slave.setReal(references, derivatives[0].tolist())
        if derivatives[1:].any():
            orders = [order for order in (1, 2, 3) for _ in INPUTS]
            slave.setRealInputDerivatives(references * 3, orders, derivatives[1:].ravel().tolist())

    def _march(self, slave: FMU2Slave, times: list[float], inputs: Schedule) -> tuple[list[tuple[float, ...]], bool]:
        """Rows at the times asked for; at a jump of the inputs, from the right."""
        rows = [self._row(slave, times[0])]
        jumps = [t for t in inputs.jumps if times[0] < t < times[-1]]
        t, asked = times[0], set(times)
        for stop in sorted({*times[1:], *jumps}):
            try:
                slave.doStep(t, stop - t)
            except FMICallException as fault:
                if fault.status != DISCARD:
                    raise
                return [*rows, self._row(slave, slave.getRealStatus(LAST_SUCCESSFUL_TIME))], True
            t = stop
            self._feed(slave, inputs, t)
            if t in asked:
                rows.append(self._row(slave, t))
        return rows, False

    def _row(self, slave: FMU2Slave, t: float) -> tuple[float, ...]:
        reals = slave.getReal([self.reference[name] for name in self.reals])
        integers = slave.getInteger([self.reference[name] for name in self.integers])
        return (t, *reals, *integers)
