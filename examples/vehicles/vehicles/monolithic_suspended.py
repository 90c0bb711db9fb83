"""Wheel and quarter car as one set of equations: the yardstick of the coupled run.

The quarter car is written again from its equations (quarter_car.cpp); the FMUs give nothing but the start values of
their tables. Its own states: position and velocity of the sprung mass B.
"""

import numpy as np
from reference.model import Wheel

from .monolithic import Answer, Joint, Load, Z, cross, lever
from .options import starts

TOLERANCE = 1e-11  # relative, of each step: the solution is then good to about 1e-9
CAR = starts("quarter_car")
K, C = (np.array([CAR[f"{name}_h"], CAR[f"{name}_h"], CAR[f"{name}_v"]]) for name in "kc")


class Suspended(Joint):
    """From rest, at the lean `theta`."""

    n, size = 1, 6

    def __init__(self, s: float, theta: float) -> None:
        self.kind, self.theta = Wheel(s=s), theta

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
