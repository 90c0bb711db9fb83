"""Small leans of the upright rolling wheel: their growth or swing, and the critical speed measured from both sides."""

from math import pi

import numpy as np
from numpy.typing import NDArray
from reference import Start, Wheel
from support.closed_forms import critical_spin, leaning_turn
from support.motion import Library, start_values
from support.scenes import PAPER as TORUS

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
