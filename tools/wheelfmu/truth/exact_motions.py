"""Whole motions of the FMU against closed forms: how far apart they are; the critical spin measured from both sides.

`judged`: the wheel with whose constants the closed form is written (closed_forms.py).
"""

from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from wheelfmu.truth.closed_forms import (
    circle,
    circle_speed,
    circle_spin,
    critical_spin,
    fall_normal_force,
    fall_time,
    leaning_turn,
    upright_deceleration,
)
from wheelfmu.truth.motion import Library, start_values
from wheelfmu.truth.reference import Start, Wheel
from wheelfmu.truth.scenes import PAPER as TORUS

UPRIGHT = {"theta_start": pi / 2, "psi_start": 0.0, "X_O_start": 0.0}  # e1 along X


def straight_error(library: Library, formulation: int, s: float, judged: Wheel) -> float:
    """omega_z and X_O of upright rolling at 2 rad/s against uniform deceleration to rest, up to 2 s."""
    times = np.linspace(0, 2, 201)
    run = library.simulate(times, s=s, formulation=formulation, **UPRIGHT)
    slowing, R = upright_deceleration(judged), judged.r_0 + judged.r
    rolled = np.minimum(times, 2 / slowing)
    omega_z = -2 + slowing * rolled
    X_O = R * (2 * rolled - slowing * rolled**2 / 2)
    return float(max(np.abs(run["omega_z"] - omega_z).max(), np.abs(run["X_O"] - X_O).max()))


def fall_error(library: Library, formulation: int, judged: Wheel) -> float:
    """Instant at which the wheel released from rest lies flat, s; nan if it does not."""
    run = library.simulate([0.0, 2.0], formulation=formulation, phi_dot_start=0.0)
    if run.ended is None or "lies flat" not in run.ended:
        return np.nan
    return abs(run.t[-1] - fall_time(judged, 5 * pi / 12, 1e-7))  # the model ends at sin(theta) = 1e-7


def lift_off_error(library: Library, formulation: int, shift: float) -> float:
    """Instant (s) and angle (rad) at which a falling light rim loses contact; nan if it does not.

    shift: added to the angle at which N of the closed form is zero.
    """
    rim = Wheel(J_x=0.05, J_y=0.05, J_z=0.1)
    theta = brentq(lambda angle: fall_normal_force(rim, 1.4, angle), 0.3, 1.3) + shift
    run = library.simulate([0.0, 2.0], formulation=formulation, **start_values(rim, Start(theta=1.4, phi_dot=0.0)))
    if run.ended is None or "lifted off" not in run.ended:
        return np.nan
    return float(max(abs(run.t[-1] - fall_time(rim, 1.4, theta)), abs(run["theta"][-1] - theta)))


def circle_error(library: Library, disc: Wheel, judged: Wheel, formulation: int, psi_dot: float, theta: float) -> float:
    """theta, the rates and the circle of O over 5 s from the steady circle of `judged`."""
    omega_z, times = circle_spin(judged, theta, psi_dot), np.linspace(0, 5, 101)
    start = start_values(disc, circle(judged, theta, psi_dot))
    run = library.simulate(times, 1e-11, formulation=formulation, **start)
    speed = abs(circle_speed(judged, theta, psi_dot))
    v, place = (run[f"X_O{dot}"] + 1j * run[f"Y_O{dot}"] for dot in ("_dot", ""))
    wander = [run["theta"] - theta, run["psi_dot"] - psi_dot, run["omega_z"] - omega_z, np.abs(v) - speed]
    wander.append(run["psi"] - run["psi"][0] - psi_dot * times)
    wander.append(place - place[0] - v[0] * np.expm1(1j * psi_dot * times) / (1j * psi_dot))
    return float(np.abs(wander).max())


LEAN = 1e-6


def lean_of(library: Library, omega_z: float, times: NDArray[np.float64], wheel: Wheel = TORUS) -> NDArray[np.float64]:
    """Lean over time from LEAN, at the turning rate that belongs to it, as a multiple of LEAN."""
    turn = leaning_turn(wheel, omega_z, LEAN)
    theta = pi / 2 + LEAN
    start = Start(theta=theta, psi_dot=turn, phi_dot=omega_z - turn * np.cos(theta))
    return (library.simulate(times, 1e-13, **start_values(wheel, start))["theta"] - pi / 2) / LEAN


def stiffness(library: Library, omega_z: float, tau: float = 2.0, wheel: Wheel = TORUS) -> float:
    """kappa^2 from the lean at tau (s), cos(kappa tau) or cosh(|kappa| tau) of that at the start; |kappa| tau < pi."""
    e = lean_of(library, omega_z, np.array([0.0, tau]), wheel)[1]
    return float(np.sign(1 - e) * (np.arccos(e) if e < 1 else np.arccosh(e)) ** 2 / tau**2)


def measured_critical_spin(library: Library, wheel: Wheel = TORUS) -> float:
    """Zero of kappa^2 over omega_z^2, by the line through a point 1 % below and one above the limit."""
    x = np.array([0.99, 1.01]) ** 2 * critical_spin(wheel) ** 2
    k = np.array([stiffness(library, float(np.sqrt(value)), wheel=wheel) for value in x])
    return float(np.sqrt(x[0] - k[0] * (x[1] - x[0]) / (k[1] - k[0]))) if k[0] < 0 < k[1] else np.nan
