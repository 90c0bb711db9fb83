"""A wheel on a body: the wheel's angles and axes from the axle's direction, and their rates. SI units.

The body carries the axle n, a unit vector to the right of a wheel that rolls forward, and turns with the angular
velocity omega, that of the steering included. Fixed axes, Z up; docs/vehicle.md. python carrier.py prints the rates
on a body that yaws and rolls.
"""

from math import acos, atan2, cos, sin

import numpy as np


def angles(n):
    """psi and theta of a wheel with the axle n = (sin theta sin psi, -sin theta cos psi, cos theta)."""
    return atan2(n[0], -n[1]), acos(n[2])


def axes(psi, theta):
    """e1, the rolling direction; e2, in the wheel's plane, up; e3, the axle: moments on the wheel are along them."""
    e1 = np.array([cos(psi), sin(psi), 0.0])
    e2 = np.array([-cos(theta) * sin(psi), cos(theta) * cos(psi), sin(theta)])
    return e1, e2, np.cross(e1, e2)


def rates(n, omega):
    """psi' and theta', which a guided wheel takes as psi_dot_guide and theta_dot_guide."""
    psi, theta = angles(n)
    e1, e2, _ = axes(psi, theta)
    return omega @ e2 / sin(theta), omega @ e1


def camber(gamma, side):
    """theta_start of an upright wheel with a camber: ISO 8855 counts it positive if the top leans outwards. side: 1 on
    the left of the vehicle, -1 on its right."""
    return acos(side * sin(gamma))


if __name__ == "__main__":
    lean = 0.1  # rad, to the left: the axle rises
    psi_dot, theta_dot = rates(np.array([0, -cos(lean), sin(lean)]), np.array([0.3, 0.0, 0.5]))
    print(f"psi_dot = {psi_dot:.4f} rad/s, theta_dot = {theta_dot:.4f} rad/s")
    print(
        f"theta of 1 degree of camber: {camber(np.radians(1), 1):.4f} rad left, {camber(np.radians(1), -1):.4f} right"
    )
