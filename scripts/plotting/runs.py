"""Runs of wheel.fmu as tables, for the pictures of the documents.

Names, frames and units are those of modelDescription.xml.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave

from plotting.scene import Array

OUTPUTS = (
    *("X_O", "Y_O", "theta", "psi", "psi_dot", "omega_z", "X_C", "Y_C"),
    *("E", "friction_mode", "mu_required", "n_events"),
)


INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake")


class Signals(dict):
    """Inputs over time as columns, straight lines between the rows; the others are zero."""

    def named(self, **names: str) -> Array:
        """The table that fmpy takes, with columns called by the names of inputs."""
        table = np.zeros(len(self["time"]), dtype=[(name, float) for name in ("time", *INPUTS)])
        for name, values in self.items():
            table[names.get(name, name)] = values
        return table


class Fmu:
    """The FMU, unpacked once. `run` is one simulation from given start values and inputs."""

    def __init__(self, path: Path):
        self.folder = extract(str(path))
        self.description = read_model_description(self.folder)

    def run(self, stop: float = 10.0, h: float = 0.01, signals: Array | None = None, **start: float) -> Array:
        return simulate_fmu(
            self.folder,
            model_description=self.description,
            stop_time=stop,
            output_interval=h,
            start_values=start,
            input=signals,
            output=OUTPUTS,
            logger=lambda *_: None,
        )

    def on_a_suspension(self, h: float = 1e-3, stop: float = 6.0) -> Array:
        """A wheel that M_1 holds upright, that M_2 turns to a heading of 90 degrees, and that is braked from 3 s on.

        A spring and damper about e1 stand for the suspension, another pair about e2 for the steering; first order in h.
        """
        wheel = self.instance(theta_start=np.pi / 2, psi_start=0.0, phi_dot_start=-10.0)
        reference = {v.name: v.valueReference for v in self.description.modelVariables}
        outputs = [reference[name] for name in ("psi", "theta", "psi_dot", "theta_dot", "omega_z")]
        inputs = [reference[name] for name in ("M_1", "M_2", "M_brake")]
        rows = []
        for t in np.arange(0, stop, h):
            psi, theta, psi_dot, theta_dot, omega_z = wheel.getReal(outputs)
            lean, wanted = theta - np.pi / 2, np.radians(90) * np.clip(t - 1, 0, 1)
            loads = (-3000 * lean - 100 * theta_dot, 300 * (wanted - psi) - 40 * psi_dot, 30.0 * (t >= 3))
            rows.append((t, psi, lean, -0.35 * omega_z, loads[0]))
            wheel.setReal(inputs, loads)
            wheel.doStep(t, h)
        wheel.terminate()
        wheel.freeInstance()
        return table_of(("time", "psi", "lean", "speed", "M_1"), rows)

    def instance(self, **start: float) -> FMU2Slave:
        model = self.description.coSimulation.modelIdentifier
        wheel = FMU2Slave(guid=self.description.guid, unzipDirectory=self.folder, modelIdentifier=model)
        wheel.instantiate()
        references = {v.name: v.valueReference for v in self.description.modelVariables}
        wheel.setReal([references[name] for name in start], list(start.values()))
        wheel.setupExperiment()
        wheel.enterInitializationMode()
        wheel.exitInitializationMode()
        return wheel


def table_of(names: Sequence[str], rows: Sequence[Sequence[float]]) -> Array:
    table = np.zeros(len(rows), dtype=[(name, float) for name in names])
    for name, column in zip(names, np.transpose(rows), strict=True):
        table[name] = column
    return table
