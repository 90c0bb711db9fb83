"""What is known of the torus wheel without integrating its equations of motion, derived by hand; J_x = J_y unless said.

Symbols of the paper, SI. Carrier axes e1 (line of nodes), e2 (up the slope), e3 (axle); omega_1 = theta_dot,
omega_2 = psi_dot sin(theta), omega_3 = omega_z; R = r_0 + r is the height of O when upright.
"""

from collections.abc import Callable
from itertools import pairwise
from math import asin, cos, exp, sin, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, minimize_scalar

from wheelfmu.truth.reference import Start, Wheel

Array = NDArray[np.float64]


def rolling_inertia(wheel: Wheel) -> float:
    """J_z + m R^2: about the contact, upright, about the axle's direction."""
    return wheel.J_z + wheel.m * (wheel.r_0 + wheel.r) ** 2


def tipping_inertia(wheel: Wheel) -> float:
    """J_x + m R^2: about the contact, upright, about the rolling direction."""
    return wheel.J_x + wheel.m * (wheel.r_0 + wheel.r) ** 2


def upright_deceleration(wheel: Wheel) -> float:
    """|d omega_z/dt| of upright straight rolling: N = m g, so (J_z + m R^2) omega_z' = -s m g sign(omega_z)."""
    return wheel.s * wheel.m * wheel.g / rolling_inertia(wheel)


def upright_stiffness(wheel: Wheel, omega_z: float) -> float:
    """kappa^2 in e'' = -kappa^2 e, where e = theta - pi/2 is a small lean off upright straight rolling, s = 0.

    To first order in e, e' and omega_2, with omega_3 = omega_z constant:
      about e2:  J_x omega_2' = J_z omega_z e'  (the contact lies r cos(theta) = -r e off the plane of O: second order),
                 hence omega_2 = J_z omega_z e / J_x, if the wheel does not turn while upright;
      about e1 through the contact:  (J_x + m R^2) e'' = -(J_z + m R^2) omega_z omega_2 + m g r_0 e.
    In the last term the weight acts at O, which a lean moves (r_0 + r) e to the side, while the contact rolls r e
    along the tube to the same side: the lever is r_0 e, not R e. Together
      kappa^2 = ((J_z + m R^2) J_z omega_z^2 / J_x - m g r_0) / (J_x + m R^2).
    """
    gyroscopic = rolling_inertia(wheel) * wheel.J_z * omega_z**2 / wheel.J_x
    return (gyroscopic - wheel.m * wheel.g * wheel.r_0) / tipping_inertia(wheel)


def critical_spin(wheel: Wheel) -> float:
    """|omega_z| above which upright straight rolling is stable: kappa^2 = 0.

    omega_z^2 = m g r_0 J_x / (J_z (J_z + m (r_0 + r)^2)); r = 0 is the textbook's thin disc.
    """
    weight = wheel.m * wheel.g * wheel.r_0
    return (weight * wheel.J_x / (wheel.J_z * rolling_inertia(wheel))) ** 0.5


def leaning_turn(wheel: Wheel, omega_z: float, lean: float) -> float:
    """psi_dot that goes with a small lean: omega_2 = J_z omega_z e / J_x (see upright_stiffness)."""
    return wheel.J_z * omega_z * lean / wheel.J_x / cos(lean)


def circle_spin(wheel: Wheel, theta: float, psi_dot: float) -> float:
    """omega_z of the steady circle at theta and psi_dot, s = 0.

    theta' = 0, omega_2 = psi_dot sin, Omega_3 = psi_dot cos; with the contact rho = r_0 + r sin below O along e2
    and eta = r cos along e3, O at the height Z = r_0 sin + r moves at v = eta omega_2 - rho omega_3 along e1 and
    accelerates by psi_dot v horizontally. Moments about e1 through the contact:
      (J_z omega_3 - J_x Omega_3) omega_2 = m Z psi_dot v - m g r_0 cos, which gives
      (J_z sin + m rho Z) omega_3 psi_dot = (J_x cos + m eta Z) psi_dot^2 sin - m g r_0 cos.
    With r = 0: the textbook's (J_z + m r_0^2) omega_3 psi_dot sin = J_x psi_dot^2 sin cos - m g r_0 cos.
    """
    s, c = np.sin(theta), np.cos(theta)
    rho, eta, Z = wheel.r_0 + wheel.r * s, wheel.r * c, wheel.r_0 * s + wheel.r
    turning = (wheel.J_x * c + wheel.m * eta * Z) * psi_dot**2 * s
    return (turning - wheel.m * wheel.g * wheel.r_0 * c) / ((wheel.J_z * s + wheel.m * rho * Z) * psi_dot)


def circle_speed(wheel: Wheel, theta: float, psi_dot: float) -> float:
    """v of O along e1 on the steady circle, as in circle_spin."""
    s, c = np.sin(theta), np.cos(theta)
    return wheel.r * c * psi_dot * s - (wheel.r_0 + wheel.r * s) * circle_spin(wheel, theta, psi_dot)


def circle(wheel: Wheel, theta: float, psi_dot: float) -> Start:
    """The start of the steady circle."""
    return Start(theta=theta, psi_dot=psi_dot, phi_dot=circle_spin(wheel, theta, psi_dot) - psi_dot * cos(theta))


def fall_inertia(wheel: Wheel, theta: float) -> float:
    """About the contact, across the axle."""
    return wheel.J_x + wheel.m * (wheel.r_0**2 + wheel.r**2 + 2 * wheel.r_0 * wheel.r * sin(theta))


def fall_rate_squared(wheel: Wheel, theta_0: float, gone: float) -> float:
    """theta_dot^2 after the fall from rest through the angle `gone`: energy; the drop as a product keeps its digits."""
    drop = 2 * wheel.r_0 * sin(asin(cos(theta_0)) + gone / 2) * sin(gone / 2)  # from a lean of 6e-17 rad, too
    return 2 * wheel.m * wheel.g * drop / fall_inertia(wheel, theta_0 - gone)


def fall_time(wheel: Wheel, theta_0: float, theta: float = 0.0) -> float:
    """Time of the fall from rest at theta_0 < pi/2 to theta: the integral of d theta / theta_dot, by quadrature.

    theta_0 - theta = span e^(2 u): takes out the root at rest, and spreads the slow start near upright.
    """
    span = theta_0 - theta

    def per_u(u: float) -> float:
        gone = span * exp(2 * u)
        return 2 * gone / sqrt(fall_rate_squared(wheel, theta_0, gone))

    cuts = (-40.0, -25.0, -16.0, -12.0, -9.0, -7.0, -5.0, -3.0, -1.5, -0.5, 0.0)
    return sum(quad(per_u, *ends, epsabs=1e-14, epsrel=1e-12)[0] for ends in pairwise(cuts))


def fall_normal_force(wheel: Wheel, theta_0: float, theta: float) -> float:
    """N = m (g + Z_O'') of that fall."""
    rate2, inertia = fall_rate_squared(wheel, theta_0, theta_0 - theta), fall_inertia(wheel, theta)
    growth = 2 * wheel.m * wheel.r_0 * wheel.r * cos(theta)
    acceleration = -(wheel.m * wheel.g * wheel.r_0 * cos(theta) + growth * rate2 / 2) / inertia
    return wheel.m * (wheel.g + wheel.r_0 * (cos(theta) * acceleration - sin(theta) * rate2))


def lowest_fall_force(wheel: Wheel, theta_0: float) -> tuple[float, float]:
    """(theta, N) where the falling wheel presses least."""
    thetas = np.linspace(1e-3, theta_0, 201)
    i = int(np.argmin([fall_normal_force(wheel, theta_0, t) for t in thetas]))
    near = (thetas[max(i - 1, 0)], thetas[min(i + 1, 200)])
    found = minimize_scalar(lambda t: fall_normal_force(wheel, theta_0, t), bounds=near, method="bounded")
    return float(found.x), float(found.fun)


def fall_lift_off(wheel: Wheel, theta_0: float) -> float:
    """Time at which the wheel falling from rest at theta_0 leaves the ground."""
    low, _ = lowest_fall_force(wheel, theta_0)
    angle = brentq(lambda t: fall_normal_force(wheel, theta_0, t), low, theta_0, xtol=1e-15)
    return fall_time(wheel, theta_0, angle)


def linear_matrix(wheel: Wheel, theta: float) -> Array:
    """d(omega_2, omega_3)/d theta = matrix (omega_2, omega_3) of the free wheel (Chaplygin)."""
    s, c = sin(theta), cos(theta)
    rho, eta, m = wheel.r_0 + wheel.r * s, wheel.r * c, wheel.m
    inertia = np.array([[wheel.J_x + m * eta**2, -m * eta * rho], [-m * eta * rho, wheel.J_z + m * rho**2]])
    pull = m * np.array([wheel.r_0 + eta * c / s, -eta])  # m times the velocity-dependent part of a_1 per omega_1
    right = np.array([[-wheel.J_x * c / s, wheel.J_z], [0.0, 0.0]]) + np.outer([-eta, rho], pull)
    return np.linalg.solve(inertia, right)


def linear_integrals(wheel: Wheel, theta: Array, omega_2: Array, omega_3: Array) -> Array:
    """(omega_2, omega_3) of each row carried back along the linear system to theta[0]: constant along the motion."""
    rates = np.column_stack([omega_2, omega_3])
    constants = rates.copy()
    for rows, stop in ((theta < theta[0], theta.min()), (theta > theta[0], theta.max())):
        if rows.any():
            basis = _fundamental(wheel, float(theta[0]), float(stop))
            constants[rows] = [
                np.linalg.solve(basis(t), rate) for t, rate in zip(theta[rows], rates[rows], strict=True)
            ]
    return constants


def _fundamental(wheel: Wheel, start: float, stop: float) -> Callable[[float], Array]:
    """theta -> fundamental matrix, identity at `start`; in log(tan(theta/2)) the singular ends are far away."""

    def rate(x: float, flat: Array) -> Array:
        theta = 2 * np.arctan(np.exp(x))
        return (linear_matrix(wheel, theta) @ flat.reshape(2, 2)).ravel() * sin(theta)

    def place(theta: float) -> float:
        return float(np.log(np.tan(theta / 2)))

    span = (place(start), place(stop))
    found = solve_ivp(rate, span, np.eye(2).ravel(), "DOP853", dense_output=True, rtol=1e-13, atol=1e-16)
    return lambda theta: found.sol(place(theta)).reshape(2, 2)
