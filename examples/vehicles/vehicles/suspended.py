"""Suspended wheel: a quarter car on its wheel, launched from rest by a step of the drive torque.

Coupled through F_X, F_Y, F_Z, M_1, M_2, M_3 and the pose and velocity of O, by values held over the communication
step or by straight lines (derivatives of first order); compared with the same system as one set of equations.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import exp, pi
from pathlib import Path

import numpy as np
from reference.model import Wheel

from . import errors, monolithic
from .component import Component, Ended
from .hubs import FORCE, MOMENT, POSE
from .master import Master, Signal
from .ssp import System
from .ssp import run as run_package

STOP = 3.0  # s
GRID = 0.05  # s, where runs are compared; every step below divides it
STEPS = (0.005, 0.0025, 0.00125, 0.000625, 0.0003125)  # s
LARGE_STEPS = (0.0125, 0.015, 0.02, 0.025)  # s, around the limit of stability
LOAD = FORCE + MOMENT
START = {"s": 0.01, "psi_start": 0.0, "theta_start": 88 * pi / 180, "phi_dot_start": 0.0, "X_O_start": 0.0}
COMPARED = ("X_O", "theta", "phi_dot", "psi_dot", "X_B", "Z_B")
RECORD: list[Signal] = [
    *(("wheel", name) for name in ("X_O", "theta", "phi_dot", "psi_dot", "psi", "theta_dot", "omega_z", "lambda_3")),
    *(("wheel", name) for name in ("Y_O", "phi")),  # scripts/view needs these too
    *(("quarter_car", name) for name in ("X_B", "Y_B", "Z_B", *LOAD)),
]
CONNECTIONS: list[tuple[Signal, Signal]] = [
    *((("wheel", name), ("quarter_car", name)) for name in POSE),
    *((("quarter_car", name), ("wheel", name)) for name in LOAD),
]


def components(fmus: dict[str, Path], parameters: dict[str, float] | None = None) -> list[Component]:
    """Wheel and quarter car; `parameters` of either, by their names."""
    car = Component("quarter_car", fmus["quarter_car"], parameters or {})
    return [Component("wheel", fmus["wheel"], START), car]


def coupled(
    fmus: dict[str, Path],
    step: float,
    exchange: str,
    stop: float = STOP,
    grid: float = GRID,
    parameters: dict[str, float] | None = None,
    **how: bool,
) -> dict[str, np.ndarray]:
    """The co-simulation on the comparison grid, columns by variable name."""
    with Master(components(fmus, parameters), CONNECTIONS) as master:
        table = master.run(stop, step, RECORD, exchange, round(grid / step), **how)
    return {name.split(".")[-1]: table[name] for name in table.dtype.names}


def system(fmus: dict[str, Path], parameters: dict[str, float] | None = None, step: float = 0.001) -> System:
    """What suspended_wheel.ssp holds."""
    return System("suspended_wheel", components(fmus, parameters), CONNECTIONS, step, STOP)


def together(stop: float = STOP, grid: float = GRID) -> dict[str, np.ndarray]:
    """The same system as one set of equations."""
    return monolithic.solve(Wheel(s=START["s"]), START["theta_start"], np.arange(round(stop / grid) + 1) * grid)


distance = partial(errors.distance, names=COMPARED, least=0)


def package_distance(package: Path, step: float, truth: dict[str, np.ndarray], stop: float = STOP) -> float:
    """Largest difference over time of X_O, theta and psi_dot in fmpy's run of the package, relative to their ranges."""
    table, names = run_package(package, step, stop, GRID), ("X_O", "theta", "psi_dot")
    columns = {n: np.concatenate([truth[n][:1], table[f"wheel.{n}"], truth[n][1 + len(table) :]]) for n in names}
    return errors.distance(columns, truth, names, 0)


def ends(fmus: dict[str, Path], step: float, exchange: str) -> bool:
    """Whether the coupled run breaks: the hopping wheel leaves the ground and its FMU ends the step."""
    try:
        coupled(fmus, step, exchange, grid=step)
    except Ended:
        return True
    return False


def convergence(
    fmus: dict[str, Path], truth: dict[str, np.ndarray], steps: Sequence[float] = STEPS, stop: float = STOP
) -> errors.Errors:
    """With all inputs held, with positions that follow the velocities beside them, and on straight lines."""
    kinds = {"positions held": ("held", {"follow": 0.0}), "held": ("held", {}), "derivatives": ("derivatives", {})}
    return errors.Errors(
        steps,
        {
            name: [distance(coupled(fmus, h, exchange, stop, parameters=more), truth) for h in steps]
            for name, (exchange, more) in kinds.items()
        },
    )


def drag_share(h: float, k: float = 60e3, mass: float = 334.7, duration: float = 2.5) -> float:
    """Share of the final speed lost to the drag k v h / 2 of a position held over the step.

    mass (kg): sprung mass, wheel and J_z / R^2.  duration (s): of the drive.
    """
    x = k * h / 2 * duration / mass
    return 1 - (1 - exp(-x)) / x
