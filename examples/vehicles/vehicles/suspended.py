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
from .component import Component
from .hubs import FORCE, MOMENT, POSE, road
from .master import Run, Signal, System, simulate, whole
from .options import Manoeuvre, manoeuvres
from .ssp import run as run_package

LAUNCH = manoeuvres("suspended")["launch"]
STOP = LAUNCH.stop  # s
GRID = 0.05  # s, where runs are compared; every step below divides it
STEPS = (0.005, 0.0025, 0.00125, 0.000625, 0.0003125)  # s
LARGE_STEPS = (0.0125, 0.015, 0.02, 0.025)  # s, around the limit of stability
LOAD = FORCE + MOMENT
START = {"s": 0.01, "psi_start": 0.0, "theta_start": 88 * pi / 180, "phi_dot_start": 0.0, "X_O_start": 0.0}
COMPARED = ("X_O", "theta", "phi_dot", "psi_dot", "X_B", "Z_B")
OF_WHEEL = ("theta", "phi_dot", "psi_dot", "psi", "theta_dot", "omega_z", "lambda_3", "mu_required")
RECORD: list[Signal] = [
    *(("wheel", name) for name in ("X_O", "Y_O", "phi", "X_O_dot", *OF_WHEEL)),  # scripts/view needs the first three
    *(("quarter_car", name) for name in ("X_B", "Y_B", "Z_B", "X_B_dot", *LOAD)),
]
CONNECTIONS: list[tuple[Signal, Signal]] = [
    *((("wheel", name), ("quarter_car", name)) for name in POSE),
    *((("quarter_car", name), ("wheel", name)) for name in LOAD),
]
WHEELS: dict[str, str] = {}  # the wheel's columns go by their names alone


def system(fmus: dict[str, Path], run: Manoeuvre = LAUNCH, step: float = 0.001) -> System:
    """Wheel and quarter car. The parameters k and c are those along X and Y."""
    links = {f"{name}_h": run[name] for name in ("k", "c") if name in run.given}
    wheel = Component("wheel", fmus["wheel"], {**START, **road(run)})
    car = Component("quarter_car", fmus["quarter_car"], {**run.of("quarter_car"), **links})
    return System("suspended_wheel", [wheel, car], CONNECTIONS, step, run.stop, ("wheel", "quarter_car"))


package = system  # the quarter car waits until t_couple anyway


def run(fmus: dict[str, Path], run: Manoeuvre, step: float, exchange: str, grid: float = 0.01, **how: bool) -> Run:
    """The co-simulation; columns by variable name."""
    return simulate(system(fmus, run, step), RECORD, exchange, grid, **how)


def coupled(
    fmus: dict[str, Path],
    step: float,
    exchange: str,
    stop: float = STOP,
    grid: float = GRID,
    parameters: dict[str, float] | None = None,
    **how: bool,
) -> dict[str, np.ndarray]:
    """The whole co-simulation on the comparison grid."""
    return whole(run(fmus, LAUNCH.changed(stop=stop, **(parameters or {})), step, exchange, grid, **how))


def verdict(table: dict[str, np.ndarray], _run: Manoeuvre) -> tuple[bool, list[str]]:
    """Its state at the end."""
    least, grip = table["lambda_3"].min(), np.nanmax(table["mu_required"])
    speed = f"Speed at the end: {-0.35 * table['omega_z'][-1]:.4f} m/s; smallest normal force: {least:.1f} N"
    return True, [f"{speed}; friction required: {grip:.2f}."]


def together(stop: float = STOP, grid: float = GRID) -> dict[str, np.ndarray]:
    """The same system as one set of equations."""
    return monolithic.solve(Wheel(s=START["s"]), START["theta_start"], np.arange(round(stop / grid) + 1) * grid)


distance = partial(errors.distance, names=COMPARED, least=0)


def package_distance(package: Path, step: float, truth: dict[str, np.ndarray], stop: float = STOP) -> float:
    """Largest difference over time of X_O, theta and psi_dot in fmpy's run of the package, relative to their ranges."""
    table, names = run_package(package, step, stop, GRID), ("X_O", "theta", "psi_dot")
    count = len(table["time"])
    columns = {n: np.concatenate([truth[n][:1], table[f"wheel.{n}"], truth[n][1 + count :]]) for n in names}
    return errors.distance(columns, truth, names, 0)


def ends(fmus: dict[str, Path], step: float, exchange: str) -> bool:
    """Whether the coupled run breaks: the hopping wheel leaves the ground and its FMU ends the step."""
    return run(fmus, LAUNCH, step, exchange, step).ending is not None


def convergence(
    fmus: dict[str, Path], truth: dict[str, np.ndarray], steps: Sequence[float] = STEPS, stop: float = STOP
) -> errors.Errors:
    """With all inputs held, with positions that follow the velocities beside them, and on straight lines."""
    kinds = {"positions held": ("held", {"follow": 0.0}), "held": ("held", {}), "derivatives": ("derivatives", {})}
    found = {
        name: [distance(coupled(fmus, h, exchange, stop, parameters=more), truth) for h in steps]
        for name, (exchange, more) in kinds.items()
    }
    return errors.Errors(steps, found)


def drag_share(h: float, k: float = 60e3, mass: float = 334.7, duration: float = 2.5) -> float:
    """Share of the final speed lost to the drag k v h / 2 of a position held over the step.

    mass (kg): sprung mass, wheel and J_z / R^2.  duration (s): of the drive.
    """
    x = k * h / 2 * duration / mass
    return 1 - (1 - exp(-x)) / x
