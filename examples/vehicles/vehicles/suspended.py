"""Suspended wheel: a quarter car on its wheel, launched from rest by a step of the drive torque.

Coupled through F_X, F_Y, F_Z, M_1, M_2, M_3 and the pose and velocity of O, by values held over the communication
step or by straight lines (derivatives of first order); compared with the same system as one set of equations.
"""

from collections.abc import Sequence
from functools import partial
from math import exp, pi
from pathlib import Path

import numpy as np

from . import errors, ssp
from .component import Component
from .monolithic_suspended import TOLERANCE, Suspended
from .options import Manoeuvre, manoeuvres
from .vehicle import Fmus, Table, Vehicle, recorded, road, wire

LAUNCH = manoeuvres("suspended")["launch"]
GRID = 0.05  # s, where runs are compared; every step below divides it
STEPS = (0.005, 0.0025, 0.00125, 0.000625, 0.0003125)  # s
LARGE_STEPS = (0.0125, 0.015, 0.02, 0.025)  # s, around the limit of stability
START = {"s": 0.01, "psi_start": 0.0, "theta_start": 88 * pi / 180, "phi_dot_start": 0.0, "X_O_start": 0.0}
COMPARED = ("X_O", "theta", "phi_dot", "psi_dot", "X_B", "Z_B")


def parts(fmus: Fmus, run: Manoeuvre) -> list[Component]:
    """Wheel and quarter car. The parameters k and c are those along X and Y."""
    links = {f"{name}_h": run[name] for name in ("k", "c") if name in run.given}
    wheel = Component("wheel", fmus["wheel"], {**START, **road(run)})
    return [wheel, Component("quarter_car", fmus["quarter_car"], {**run.of("quarter_car"), **links})]


def verdict(table: Table, _run: Manoeuvre) -> tuple[bool, list[str]]:
    """Its state at the end."""
    least, grip = table["lambda_3"].min(), np.nanmax(table["mu_required"])
    speed = f"Speed at the end: {-0.35 * table['omega_z'][-1]:.4f} m/s; smallest normal force: {least:.1f} N"
    return True, [f"{speed}; friction required: {grip:.2f}."]


SUSPENDED = Vehicle("suspended_wheel", parts, wire("quarter_car", "wheel", ""), recorded("suspended"), verdict)


def coupled(fmus: Fmus, step: float, exchange: str, grid: float = GRID, **changed: float) -> Table:
    """The whole co-simulation on the comparison grid."""
    return SUSPENDED.drive(fmus, LAUNCH.changed(**changed), step, exchange, grid).whole


def together(s: float = START["s"]) -> Table:
    """The same system as one set of equations."""
    times = np.arange(round(LAUNCH.stop / GRID) + 1) * GRID
    return Suspended(s, START["theta_start"]).solve(times, TOLERANCE)[0]


distance = partial(errors.distance, names=COMPARED, least=0)


def package_distance(package: Path, step: float, truth: Table, stop: float = LAUNCH.stop) -> float:
    """Largest difference over time of X_O, theta and psi_dot in fmpy's run of the package, relative to their ranges."""
    table, names = ssp.run(package, step, stop, GRID), ("X_O", "theta", "psi_dot")
    count = len(table["time"])
    columns = {n: np.concatenate([truth[n][:1], table[f"wheel.{n}"], truth[n][1 + count :]]) for n in names}
    return errors.distance(columns, truth, names, 0)


def ends(fmus: Fmus, step: float, exchange: str) -> bool:
    """Whether the coupled run breaks: the hopping wheel leaves the ground and its FMU ends the step."""
    return SUSPENDED.drive(fmus, LAUNCH, step, exchange, step).ending is not None


def convergence(fmus: Fmus, truth: Table, steps: Sequence[float] = STEPS) -> errors.Errors:
    """With all inputs held, with positions that follow the velocities beside them, and on straight lines."""
    kinds = {"positions held": ("held", {"follow": 0.0}), "held": ("held", {}), "derivatives": ("derivatives", {})}
    return {
        name: {h: distance(coupled(fmus, h, exchange, **more), truth) for h in steps}
        for name, (exchange, more) in kinds.items()
    }


def drag_share(h: float, k: float = 60e3, mass: float = 334.7, duration: float = 2.5) -> float:
    """Share of the final speed lost to the drag k v h / 2 of a position held over the step.

    mass (kg): sprung mass, wheel and J_z / R^2.  duration (s): of the drive.
    """
    x = k * h / 2 * duration / mass
    return 1 - (1 - exp(-x)) / x
