"""Motions of the torus wheel known in closed form, derived by hand; J_x = J_y. Symbols of the paper, SI.

Carrier axes e1 (line of nodes), e2 (up the slope), e3 (axle); R = r_0 + r is the height of O when upright.
"""

from __future__ import annotations

from math import cos, sin

from reference import Wheel


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
    s, c = sin(theta), cos(theta)
    rho, eta, Z = wheel.r_0 + wheel.r * s, wheel.r * c, wheel.r_0 * s + wheel.r
    turning = (wheel.J_x * c + wheel.m * eta * Z) * psi_dot**2 * s
    return (turning - wheel.m * wheel.g * wheel.r_0 * c) / ((wheel.J_z * s + wheel.m * rho * Z) * psi_dot)
