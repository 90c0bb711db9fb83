"""Wheel and quarter car as one set of equations, integrated by SciPy: the yardstick of the coupled run.

The wheel is tests/reference (Newton-Euler with a quaternion), the quarter car is written here again from its
equations (quarter_car.c); nothing of the FMUs is used. Fixed axes, SI units.

State: the 17 of the reference (reference.motion), then position and velocity of the sprung mass B.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2

import numpy as np
from reference.model import Inputs, Start, Wheel
from reference.motion import angle_rates, derivative, initial_state, respond
from reference.newton_euler import Contact, Law, rotation, slope, stick_margins
from scipy.integrate import solve_ivp

WHEEL_STATES = 17
TOLERANCE = 1e-11  # relative, of each step: the solution is then good to about 1e-9


@dataclass(frozen=True)
class Car:
    """Parameters of the quarter car, with the defaults of its modelDescription.xml."""

    m_B: float = 300.0
    g: float = 9.81
    k: tuple[float, float, float] = (60e3, 60e3, 20e3)
    c: tuple[float, float, float] = (2000.0, 2000.0, 1500.0)
    l_0: float = 0.5
    k_theta: float = 8000.0
    c_theta: float = 150.0
    theta_0: float = 1.5358897417550099
    k_psi: float = 2000.0
    c_psi: float = 40.0
    M_drive: float = -150.0
    t_drive: float = 0.5
    t_couple: float = 0.1
    B_start: tuple[float, float, float] = (0.0, 0.0, 0.72)


class Links:
    """Load on the wheel as a function of the joint state; what the reference reads as its inputs."""

    def __init__(self, car: Car, coupled: bool, driven: bool) -> None:
        self.car, self.coupled, self.driven = car, coupled, driven
        self.F = self.M = (0.0, 0.0, 0.0)
        self.inputs = Inputs(force=lambda _t: self.F, moment=lambda _t: self.M)

    def update(self, y: np.ndarray) -> None:
        """F and M at the joint state y."""
        car = self.car
        M_3 = car.M_drive if self.driven else 0.0
        if not self.coupled:
            self.M = (0.0, 0.0, M_3)
            return
        stretch = y[17:20] - y[7:10] - (0.0, 0.0, car.l_0)
        self.F = tuple((np.array(car.k) * stretch + np.array(car.c) * (y[20:23] - y[10:13])).tolist())
        psi, theta, psi_dot, theta_dot = attitude(y)
        M_1 = -car.k_theta * (theta - car.theta_0) - car.c_theta * theta_dot
        self.M = (M_1, -car.k_psi * psi - car.c_psi * psi_dot, M_3)


def attitude(y: np.ndarray) -> tuple[float, float, float, float]:
    """psi, theta and their rates; psi as long as it stays within half a turn."""
    R = rotation(*y[:4].tolist())
    n = R[2]
    ux, uy, s = slope(n)
    line = [row[0] * uy - row[1] * ux for row in R]  # e1 in fixed axes
    psi_dot, theta_dot, _ = angle_rates(n, tuple(y[4:7].tolist()))
    return atan2(line[1], line[0]), atan2(s, n[2]), psi_dot, theta_dot


def joint_rate(contact: Contact, links: Links, law: Law) -> Callable[[float, np.ndarray], np.ndarray]:
    """dy/dt of wheel and sprung mass on one branch of the friction."""
    wheel_rate = derivative(contact, links.inputs, law)
    weight = np.array([0.0, 0.0, links.car.g])

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        links.update(y)
        body = np.zeros(6)
        if links.coupled:
            body[:3], body[3:] = y[20:23], -np.array(links.F) / links.car.m_B - weight
        return np.concatenate([wheel_rate(t, y[:WHEEL_STATES]), body])

    return rate


def columns(t: float, y: np.ndarray, contact: Contact, links: Links) -> dict[str, float]:
    """What is compared, at one instant."""
    links.update(y)
    psi, theta, psi_dot, theta_dot = attitude(y)
    _, _, phi_dot = angle_rates(rotation(*y[:4].tolist())[2], tuple(y[4:7].tolist()))
    _, answer = respond(contact, links.inputs, t, y[:WHEEL_STATES].tolist())
    return {
        **{"time": t, "X_O": y[7], "theta": theta, "phi_dot": phi_dot, "psi_dot": psi_dot},
        **{"psi": psi, "theta_dot": theta_dot, "omega_z": y[6], "lambda_3": answer.N_0},
        **dict(zip(("X_B", "Y_B", "Z_B"), y[17:20], strict=True)),
        **dict(zip(("F_X", "F_Y", "F_Z"), links.F, strict=True)),
    }


def solve(wheel: Wheel, start: Start, times: np.ndarray, car: Car | None = None) -> dict[str, np.ndarray]:
    """The joint motion at `times` (rising from 0), phase by phase: free, coupled and standing, driven and rolling.

    Refuses a scene in which friction does not hold the wheel at rest until the drive, or holds it afterwards.
    """
    car = car or Car()
    contact = Contact(wheel)
    y = np.concatenate([initial_state(wheel, start), car.B_start, np.zeros(3)])
    rows = []
    edges = [0.0, car.t_couple, car.t_drive, float(times[-1])]
    for phase, (begin, end) in enumerate(zip(edges, edges[1:], strict=False)):
        links = Links(car, coupled=phase >= 1, driven=phase >= 2)
        law = Law(wheel.s, sigma=-1.0) if links.driven else Law(wheel.s, hold=True)
        inside = times[(times >= begin) & (times < end) | (times == end) & (end == edges[-1])]
        solution = solve_ivp(
            joint_rate(contact, links, law), (begin, end), y, "DOP853", np.union1d(inside, [end]),
            rtol=TOLERANCE, atol=TOLERANCE,
        )  # fmt: skip
        for t, state in zip(inside, solution.y.T, strict=False):
            check_branch(contact, links, law, t, state)
            rows.append(columns(t, state, contact, links))
        y = solution.y[:, -1]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def check_branch(contact: Contact, links: Links, law: Law, t: float, y: np.ndarray) -> None:
    """The friction's branch is the right one at (t, y)."""
    links.update(y)
    _, answer = respond(contact, links.inputs, t, y[:WHEEL_STATES].tolist())
    holds = min(stick_margins(law, answer)) > 0 if law.hold else y[6] <= 0
    if not holds or answer.N_0 <= 0:
        raise RuntimeError(f"the assumed branch of the friction does not hold at t = {t} s")
