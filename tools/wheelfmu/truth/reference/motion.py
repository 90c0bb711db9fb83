"""State of the wheel, its start, and the pointwise accelerations of one that rolls.

State, 21 floats: unit quaternion (w, x, y, z) of the body; angular velocity w in body axes;
position and velocity of O in fixed axes; then quadratures: psi and phi (they only choose the
turn of the angles read from the attitude), work of the inputs, of rolling resistance, of sliding
friction; the slip u; the time. While friction acts against the slip it is |u| and its direction
from X about Z: near |u| = 0 the direction is what stays finite. Without friction it is u_X and
u_Y, which pass zero smoothly. The velocity of O is integrated for itself, so v_O - w x p - u
shows the drift.
"""

from dataclasses import dataclass
from math import atan2, cos, hypot, sin

import numpy as np
from numpy.typing import NDArray

from .frames import cross, quaternion, rotation, slope, to_body, to_fixed
from .model import ZERO, Road, Start, Vector, Wheel
from .newton_euler import Contact, Law, arm, axle_moment, carrier_moment

State = NDArray[np.float64]
OMEGA_Z, SPEED, CHI, TIME = 6, 18, 19, 20
ZERO_SPIN = 4e-16  # psi' cos(theta) + phi' below this fraction of its terms is meant to be 0


@dataclass(frozen=True)
class Accelerations:
    """Second derivatives and reactions at one instant, fixed axes and Euler angles."""

    X_O_ddot: float
    Y_O_ddot: float
    Z_O_ddot: float
    psi_ddot: float
    theta_ddot: float
    phi_ddot: float
    lambda_1: float
    lambda_2: float
    lambda_3: float
    tau: float  # moment of rolling resistance and brake about the axle, N.m


def angle_rates(n: Vector, w: Vector) -> Vector:
    """(psi', theta', phi') from w = theta' e1 + psi' n + phi' k."""
    ux, uy, s = slope(n)
    psi_dot = (w[0] * ux + w[1] * uy) / s
    return psi_dot, w[0] * uy - w[1] * ux, w[2] - psi_dot * n[2]


def angle_accelerations(n: Vector, w: Vector, alpha: Vector) -> Vector:
    """Time derivative of angle_rates, with dn/dt = n x w in body axes."""
    _, _, s = slope(n)
    dx, dy, dz = cross(n, w)
    ds = (n[0] * dx + n[1] * dy) / s
    up, across = w[0] * n[0] + w[1] * n[1], w[0] * n[1] - w[1] * n[0]
    d_up = alpha[0] * n[0] + alpha[1] * n[1] + w[0] * dx + w[1] * dy
    d_across = alpha[0] * n[1] - alpha[1] * n[0] + w[0] * dy - w[1] * dx
    psi_ddot = (d_up - 2 * up * ds / s) / (s * s)
    theta_ddot = (d_across - across * ds / s) / s
    return psi_ddot, theta_ddot, alpha[2] - psi_ddot * n[2] - up / (s * s) * dz


def body_rates(n: Vector, psi_dot: float, theta_dot: float, phi_dot: float) -> Vector:
    """w in body axes from Euler rates: the inverse of angle_rates."""
    ux, uy, s = slope(n)
    return (theta_dot * uy + psi_dot * s * ux, psi_dot * s * uy - theta_dot * ux, phi_dot + psi_dot * n[2])


def initial_state(wheel: Wheel, start: Start, road: Road | None = None, t: float = 0.0) -> State:
    """The start on the ground: Z_O from the height of O, v_O = w x p ((32), (33)) and the slip on top."""
    road = road or Road()
    q = quaternion(start.psi, start.theta, start.phi)
    R = rotation(*q)
    w = body_rates(R[2], start.psi_dot, start.theta_dot, start.phi_dot)
    if abs(w[2]) <= ZERO_SPIN * (abs(start.psi_dot) + abs(start.phi_dot)):
        w = (w[0], w[1], 0.0)
    p, (along, left), c, s = arm(wheel, R[2]), road.slip, cos(start.psi), sin(start.psi)
    u_X, u_Y = along * c - left * s, along * s + left * c
    x, y, z = to_fixed(R, cross(w, p))
    place, velocity = (start.X_O, start.Y_O, to_fixed(R, p)[2]), (x + u_X, y + u_Y, z)
    slip = (u_X, u_Y) if road.mu_max == 0 else (hypot(u_X, u_Y), atan2(u_Y, u_X) if u_X or u_Y else 0.0)
    return np.array([*q, *w, *place, *velocity, start.psi, start.phi, 0.0, 0.0, 0.0, *slip, t])


def with_weight(wheel: Wheel, F: Vector) -> Vector:
    """F and the weight, fixed axes."""
    x, y, z = wheel.gravity
    return (F[0] + wheel.m * x, F[1] + wheel.m * y, F[2] + wheel.m * z)


def accelerations(wheel: Wheel, angles: Vector, rates: Vector, F=ZERO, M=ZERO, sigma=0.0, brake=0.0) -> Accelerations:
    """Accelerations and reactions at (psi, theta, phi) and their rates.

    The moment of ground and brake about the axle is -(s N + brake) sigma, sigma in [-1, 1]; sigma
    None is the moment that holds w_z, whatever its size.
    """
    R = rotation(*quaternion(*angles))
    n = R[2]
    w = body_rates(n, *rates)
    answer = Contact(wheel).respond(n, w, to_body(R, with_weight(wheel, F)), carrier_moment(n, M))
    law = Law(wheel.s, hold=True) if sigma is None else Law(wheel.s, sigma, brake=brake)
    tau = axle_moment(law, answer)
    x = [b + tau * u for b, u in zip(answer.base, answer.unit, strict=True)]
    a, reaction = to_fixed(R, tuple(x[0:3])), to_fixed(R, tuple(x[6:9]))
    return Accelerations(*a, *angle_accelerations(n, w, tuple(x[3:6])), *reaction, tau)
