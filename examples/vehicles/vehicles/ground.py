"""The ground under a driven wheel: it stands until the torque beats s N, and it slows down on sand (s is tunable).

Both wheels are upright and keep to a line, where the closed forms are exact: with R = r_0 + r and J = J_z + m R^2,
omega_z_dot = (M_3 - s N sign(omega_z)) / J and N = m g. Lines of the log come with each run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np

from .component import Component
from .master import Master

M, R, J_Z, G = 20.0, 0.35, 1.8, 9.81  # kg, m, kg m2, m/s2: the paper's wheel
J = J_Z + M * R**2  # kg m2, about the contact
UPRIGHT = {"psi_start": 0.0, "theta_start": pi / 2, "X_O_start": 0.0}
STEP = 0.01  # s
OUTPUTS = ("X_O", "theta", "omega_z", "lambda_3")


@dataclass
class Run:
    """A table of outputs and what the FMU said."""

    table: np.ndarray
    log: list[str]


def run(
    fmus: dict[str, Path],
    stop: float,
    start: dict[str, float],
    act: Callable[[float], dict[str, float]],
    slope: dict[str, float] | None = None,
) -> Run:
    """The wheel alone; act(t) gives what is set before the step from t, slope the inputs' first derivatives."""
    wheel = Component("wheel", fmus["wheel"], start)

    def set_inputs(t: float) -> None:
        setting = act(t)
        wheel.fmu.setReal(wheel.references(list(setting)), list(setting.values()))
        if slope:
            wheel.fmu.setRealInputDerivatives(wheel.references(list(slope)), [1] * len(slope), list(slope.values()))

    with Master([wheel], [], fmus["chassis"].parent) as master:
        wheel.fmu.setDebugLogging(True, ["logEvents", "logStatusDiscard"])
        table = master.run(stop, STEP, [("wheel", name) for name in OUTPUTS], act=set_inputs)
    table.dtype.names = ("time", *OUTPUTS)
    return Run(table, wheel.log)


def stand(fmus: dict[str, Path], share: float, s: float = 0.01) -> Run:
    """A wheel at rest under the torque -share s N, switched on at 0.1 s, off at 0.5 s."""
    torque = -share * s * M * G
    return run(
        fmus, 1.0, {**UPRIGHT, "s": s, "phi_dot_start": 0.0}, lambda t: {"M_3": torque if 0.095 < t < 0.495 else 0.0}
    )


def ramp(fmus: dict[str, Path], release: float = 0.505, s: float = 0.01) -> Run:
    """A wheel at rest under a torque that grows steadily and reaches s N at the time `release`, inside a step."""
    rate = -s * M * G / release
    start = {**UPRIGHT, "s": s, "phi_dot_start": 0.0}
    return run(fmus, 1.0, start, lambda t: {"M_3": rate * t}, {"M_3": rate})


def ramp_speed(t: np.ndarray, release: float = 0.505, s: float = 0.01) -> np.ndarray:
    """omega_z of `ramp`, exactly: the excess torque grows from the release on."""
    return -s * M * G / release / J / 2 * np.maximum(t - release, 0.0) ** 2


def sand(fmus: dict[str, Path], s: float = 0.05, at: float = 0.5) -> Run:
    """A wheel at 20 rad/s that rolls onto sand: s from 0 to `s` at the time `at`."""
    return run(
        fmus, 2.0, {**UPRIGHT, "s": 0.0, "phi_dot_start": -20.0}, lambda t: {"s": s if t > at - STEP / 2 else 0.0}
    )


def sand_speed(t: np.ndarray, s: float = 0.05, at: float = 0.5) -> np.ndarray:
    """omega_z of `sand`, exactly."""
    return -20.0 + s * M * G / J * np.maximum(t - at, 0.0)
