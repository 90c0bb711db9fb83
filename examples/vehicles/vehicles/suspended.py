"""Suspended wheel: a quarter car on its wheel, launched from rest by a step of the drive torque.

Coupled through F_X, F_Y, F_Z, M_1, M_2, M_3 and the pose and velocity of O, by values held over the communication
step or by straight lines (derivatives of first order); compared with the same system as one set of equations, in which
the quarter car is written again (quarter_car.cpp), and which takes nothing from the FMUs but their start values.
"""

from collections.abc import Sequence
from math import exp, pi
from pathlib import Path

import numpy as np
from reference.model import Wheel

from . import errors, ssp
from .monolithic import Answer, Joint, Load, Z, cross, lever
from .options import Manoeuvre, manoeuvres, starts
from .vehicle import Fmus, Table, Vehicle, road

LAUNCH = manoeuvres("suspended")["launch"]
GRID = 0.05  # s, where runs are compared; every step below divides it
STEPS = (0.005, 0.0025, 0.00125, 0.000625, 0.0003125)  # s
LARGE_STEPS = (0.0125, 0.015, 0.02, 0.025)  # s, around the limit of stability
TOLERANCE = 1e-11  # relative, of each step of the one set of equations, which is then good to about 1e-9
START = {"s": 0.01, "psi_start": 0.0, "theta_start": 88 * pi / 180, "phi_dot_start": 0.0, "X_O_start": 0.0}
CAR = starts("quarter_car")
K, C = (np.array([CAR[f"{name}_h"], CAR[f"{name}_h"], CAR[f"{name}_v"]]) for name in "kc")


def start(run: Manoeuvre) -> dict[str, dict[str, float]]:
    """Of the wheel."""
    return {"wheel": START | road(run)}


def verdict(table: Table, _run: Manoeuvre) -> tuple[bool, list[str]]:
    """Its state at the end."""
    least, grip = table["lambda_3"].min(), np.nanmax(table["mu_required"])
    speed = f"Speed at the end: {-0.35 * table['omega_z'][-1]:.4f} m/s; smallest normal force: {least:.1f} N"
    return True, [f"{speed}; friction required: {grip:.2f}."]


SUSPENDED = Vehicle("suspended", start, verdict)


class Together(Joint):
    """Wheel and quarter car as one set of equations; its own states: position and velocity of the sprung mass B."""

    n, size = 1, 6

    def __init__(self, s: float) -> None:
        self.kind, self.theta = Wheel(s=s), START["theta_start"]

    def start(self) -> np.ndarray:
        axle, height = [0.0, -np.sin(self.theta), np.cos(self.theta)], self.kind.r_0 * np.sin(self.theta) + self.kind.r
        B = [CAR[f"{axis}_B_start"] for axis in "XYZ"]
        return np.concatenate([B, np.zeros(3), [0.0, 0.0, height], axle, np.zeros(3)])

    def load(self, t: float, y: np.ndarray) -> Load:
        """By the links, which carry from t_couple on, and by the motor, which pulls from t_drive on."""
        r, v, centre, a, w = y.reshape(5, 3)
        psi, theta, psi_dot, theta_dot = attitude(a, w)
        e1 = np.array([np.cos(psi), np.sin(psi), 0.0])
        M_1 = -CAR["k_theta"] * (theta - CAR["theta_0"]) - CAR["c_theta"] * theta_dot
        M_2 = -CAR["k_psi"] * (psi - CAR["psi_0"]) - CAR["c_psi"] * psi_dot
        v_O = cross(w, lever(self.kind, a[None], w[None])[0][0])
        F = K * (r - centre - CAR["l_0"] * Z) + C * (v - v_O)
        coupled, driven = (t >= CAR[name] for name in ("t_couple", "t_drive"))
        M = coupled * (M_1 * e1 + M_2 * cross(a, e1)) + driven * CAR["M_drive"] * a
        return Load(F=coupled * F[None], M=M[None], brake=np.zeros(1))

    def own_rates(self, t: float, y: np.ndarray, load: Load, _answer: Answer) -> np.ndarray:
        """Of the sprung mass, which waits until t_couple."""
        coupled = t >= CAR["t_couple"]
        return coupled * np.concatenate([y[3:6], -load.F[0] / CAR["m_B"] - CAR["g"] * Z])

    def columns(self, _t: float, y: np.ndarray, _load: Load, answer: Answer) -> dict[str, float]:
        """What is compared, at one instant."""
        r, _, centre, a, w = y.reshape(5, 3)
        psi, theta, psi_dot, _ = attitude(a, w)
        of_wheel = {"X_O": centre[0], "theta": theta, "phi_dot": a @ w - psi_dot * a[2], "psi": psi, "psi_dot": psi_dot}
        return of_wheel | {"lambda_3": answer.force[0, 2], "X_B": r[0], "Z_B": r[2]}


def attitude(a: np.ndarray, w: np.ndarray) -> tuple[float, float, float, float]:
    """psi, theta and their rates of an axle a = (sin psi sin theta, -cos psi sin theta, cos theta)."""
    a_dot, flat = cross(w, a), np.hypot(a[0], a[1])
    psi_dot = (a[0] * a_dot[1] - a[1] * a_dot[0]) / flat**2
    return np.arctan2(a[0], -a[1]), np.arctan2(flat, a[2]), psi_dot, -a_dot[2] / flat


def together(s: float = START["s"]) -> Table:
    """The launch as one set of equations."""
    return Together(s).solve(np.arange(round(LAUNCH.stop / GRID) + 1) * GRID, TOLERANCE)[0]


def package_distance(package: Path, step: float, truth: Table, stop: float = LAUNCH.stop) -> float:
    """Largest difference over time of X_O, theta and psi_dot in fmpy's run of the package, relative to their ranges."""
    run, names = ssp.run(package, step, stop, GRID), ("X_O", "theta", "psi_dot")
    driven = slice(1, 1 + len(run["time"]))
    return max(float(np.abs(run[f"wheel.{n}"] - truth[n][driven]).max() / np.ptp(truth[n])) for n in names)


def convergence(fmus: Fmus, truth: Table, steps: Sequence[float] = STEPS) -> errors.Errors:
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
