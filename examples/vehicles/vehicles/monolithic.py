"""Wheel and quarter car as one set of equations, integrated by SciPy: the yardstick of the coupled run.

The wheel is rolling_wheels.py, the quarter car is written again from its equations (quarter_car.c); the FMUs give
nothing but the start values of their tables. Fixed axes, SI units.

State: position and velocity of the sprung mass B; the wheel's centre O, axle a and angular velocity w.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from reference.model import Wheel
from scipy.integrate import solve_ivp

from .options import starts
from .rolling_wheels import Answer, Law, cross, lever, respond

TOLERANCE = 1e-11  # relative, of each step: the solution is then good to about 1e-9
CAR = starts("quarter_car")
K, C = (np.array([CAR[f"{name}_h"], CAR[f"{name}_h"], CAR[f"{name}_v"]]) for name in "kc")
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Phase:
    """From `begin` on [s]. Until the motor pulls, the friction holds the wheel; then it rolls forward."""

    wheel: Wheel
    begin: float
    coupled: bool
    driven: bool

    def load(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Force and moment on the wheel."""
        r, v, centre, a, w = y.reshape(5, 3)
        motor = CAR["M_drive"] * self.driven * a
        if not self.coupled:
            return np.zeros(3), motor
        v_O = cross(w, lever(self.wheel, a[None], w[None])[0][0])
        psi, theta, psi_dot, theta_dot = attitude(a, w)
        e1 = np.array([np.cos(psi), np.sin(psi), 0.0])
        M_1 = -CAR["k_theta"] * (theta - CAR["theta_0"]) - CAR["c_theta"] * theta_dot
        M_2 = -CAR["k_psi"] * (psi - CAR["psi_0"]) - CAR["c_psi"] * psi_dot
        return K * (r - centre - CAR["l_0"] * UP) + C * (v - v_O), motor + M_1 * e1 + M_2 * cross(a, e1)

    def answer(self, y: np.ndarray) -> tuple[np.ndarray, Answer]:
        """The force of the links on the wheel, and what the wheel does."""
        F, M = self.load(y)
        law = Law(np.array([-1.0 * self.driven]), np.zeros(1))
        return F, respond(self.wheel, y[None, 9:12], y[None, 12:], (F[None], M[None]), law)

    def rate(self, _t: float, y: np.ndarray) -> np.ndarray:
        """dy/dt of wheel and sprung mass."""
        _, v, _, a, w = y.reshape(5, 3)
        F, wheel = self.answer(y)
        body = self.coupled * np.concatenate([v, -F / CAR["m_B"] - CAR["g"] * UP])
        return np.concatenate([body, wheel.v[0], cross(w, a), wheel.w_dot[0]])

    def columns(self, t: float, y: np.ndarray) -> dict[str, float]:
        """What is compared, at one instant; refuses a wheel for which the phase's branch of the friction is wrong."""
        r, _, centre, a, w = y.reshape(5, 3)
        psi, theta, psi_dot, theta_dot = attitude(a, w)
        (F, answer), spin = self.answer(y), a @ w
        N = answer.force[0, 2]
        if N <= 0 or (spin > 0 if self.driven else abs(answer.tau[0]) >= self.wheel.s * N):
            raise RuntimeError(f"the assumed branch of the friction does not hold at t = {t} s")
        return {
            **{"time": t, "X_O": centre[0], "theta": theta, "phi_dot": spin - psi_dot * a[2], "psi_dot": psi_dot},
            **{"psi": psi, "theta_dot": theta_dot, "omega_z": spin, "lambda_3": N},
            **dict(zip(("X_B", "Y_B", "Z_B", "F_X", "F_Y", "F_Z"), (*r, *F), strict=True)),
        }


def attitude(a: np.ndarray, w: np.ndarray) -> tuple[float, float, float, float]:
    """psi, theta and their rates of an axle a = (sin psi sin theta, -cos psi sin theta, cos theta)."""
    a_dot, flat = cross(w, a), np.hypot(a[0], a[1])
    psi_dot = (a[0] * a_dot[1] - a[1] * a_dot[0]) / flat**2
    return np.arctan2(a[0], -a[1]), np.arctan2(flat, a[2]), psi_dot, -a_dot[2] / flat


def solve(s: float, theta: float, times: np.ndarray) -> dict[str, np.ndarray]:
    """The motion from rest at `times` (rising from 0), phase by phase."""
    wheel = Wheel(s=s)
    B = [CAR[f"{axis}_B_start"] for axis in "XYZ"]
    centre, a = [0.0, 0.0, wheel.r_0 * np.sin(theta) + wheel.r], [0.0, -np.sin(theta), np.cos(theta)]
    y, rows = np.concatenate([B, np.zeros(3), centre, a, np.zeros(3)]), []
    begins = (0.0, CAR["t_couple"], CAR["t_drive"])
    phases = [Phase(wheel, begin, k >= 1, k >= 2) for k, begin in enumerate(begins)]
    for phase, end in zip(phases, (*begins[1:], float(times[-1])), strict=True):
        inside = times[(times >= phase.begin) & ((times < end) | (phase.driven & (times == end)))]
        at = np.union1d(inside, [end])
        found = solve_ivp(phase.rate, (phase.begin, end), y, "DOP853", at, rtol=TOLERANCE, atol=TOLERANCE)
        rows += [phase.columns(t, state) for t, state in zip(inside, found.y.T, strict=False)]
        y = found.y[:, -1]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}
