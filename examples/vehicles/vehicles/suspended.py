"""Suspended wheel: a quarter car on its wheel, launched from rest by a step of the drive torque.

Coupled through F_X, F_Y, F_Z, M_1, M_2, M_3 and the pose and velocity of O, by values held over the communication
step or by straight lines (derivatives of first order). In the end both move on together: with m all masses, R the
wheel's rolling radius,

    (m + J_z / R^2) a = (M_drive - s m g) / R
"""

from collections.abc import Sequence
from math import exp, pi, sin
from pathlib import Path

import numpy as np

from . import ssp
from .options import Manoeuvre, manoeuvres
from .vehicle import DRY_ROAD, Errors, Fmus, Table, Vehicle, beyond_dry, road

LAUNCH = manoeuvres("suspended")["launch"]
GRID = 0.05  # s, where runs are compared; every step below divides it
STEPS = (0.005, 0.0025, 0.00125, 0.000625, 0.0003125)  # s
LARGE_STEPS = (0.0125, 0.015, 0.02, 0.025)  # s, around the limit of stability
START = {"s": 0.01, "psi_start": 0.0, "theta_start": 88 * pi / 180, "phi_dot_start": 0.0, "X_O_start": 0.0}
MASS, J_Z, RADIUS, GRAVITY = 300.0 + 20.0, 1.8, 0.3 + 0.05 * sin(START["theta_start"]), 9.81  # SI


def start(run: Manoeuvre) -> dict[str, dict[str, float]]:
    """Of the wheel."""
    return {"wheel": START | road(run)}


def verdict(table: Table, _run: Manoeuvre) -> tuple[bool, list[str]]:
    """Its state at the end; no road has the grip for a wheel that requires more than a dry one."""
    least, most = table["lambda_3"].min(), grip(table)
    speed = f"Speed at the end: {-0.35 * table['omega_z'][-1]:.4f} m/s; smallest normal force: {least:.1f} N"
    if most > DRY_ROAD:
        return False, [f"Failed: the wheel requires a friction coefficient of {beyond_dry(most)}."]
    return True, [f"{speed}; friction required: {most:.2f}."]


def grip(table: Table) -> float:
    """Of the wheel."""
    return float(np.nanmax(table["mu_required"]))


SUSPENDED = Vehicle("suspended", start, verdict, grip=grip)


def package_distance(package: Path, step: float, truth: Table, stop: float = LAUNCH.stop) -> float:
    """Largest difference over time of X_O, theta and psi_dot in fmpy's run of the package, relative to their ranges."""
    run, names = ssp.run(package, step, stop, GRID), ("X_O", "theta", "psi_dot")
    driven = slice(1, 1 + len(run["time"]))
    return max(float(np.abs(run[f"wheel.{n}"] - truth[n][driven]).max() / np.ptp(truth[n])) for n in names)


def acceleration(torque: float, s: float = START["s"]) -> float:
    """Of wheel and sprung mass together, m/s2."""
    return (torque - s * MASS * GRAVITY) / RADIUS / (MASS + J_Z / RADIUS**2)


def fine(fmus: Fmus, step: float) -> Table:
    """The reference of the coupled runs: the launch on straight lines at a small step. (With rollback the cubics would
    smear the step of the torque over the communication step before it.)"""
    return SUSPENDED.drive(fmus, LAUNCH, step, "derivatives", GRID).whole


def convergence(fmus: Fmus, truth: Table, steps: Sequence[float] = STEPS) -> Errors:
    """With all inputs held, with positions that follow the velocities beside them, and on straight lines."""
    kinds = {"positions held": ("held", {"follow": 0.0}), "held": ("held", {}), "derivatives": ("derivatives", {})}
    return {
        name: {h: SUSPENDED.error(fmus, LAUNCH.changed(**more), truth, h, exchange) for h in steps}
        for name, (exchange, more) in kinds.items()
    }


def drag_share(h: float, k: float = 60e3, mass: float = 334.7, duration: float = 2.5) -> float:
    """Share of the final speed lost to the drag k v h / 2 of a position held over the step.

    mass (kg): sprung mass, wheel and J_z / R^2.  duration (s): of the drive.
    """
    x = k * h / 2 * duration / mass
    return 1 - (1 - exp(-x)) / x
