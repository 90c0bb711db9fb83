"""Integral laws that judge a motion by its outputs alone: momentum and angular momentum.

Written with the Euler angles and the carrier axes of the outputs, on purpose: nothing here is
shared with the equations that are judged. Fixed axes unless said.
"""

import numpy as np
from numpy.typing import NDArray

from .model import Inputs, Wheel
from .outputs import Solution

Array = NDArray[np.float64]


def carrier_axes(psi: Array, theta: Array) -> tuple[Array, Array, Array]:
    """e1 (line of nodes), e2 (up the slope), e3 (axle); rows are instants."""
    zero = np.zeros_like(psi)
    e1 = np.stack([np.cos(psi), np.sin(psi), zero], axis=1)
    e3 = np.stack([np.sin(psi) * np.sin(theta), -np.cos(psi) * np.sin(theta), np.cos(theta)], 1)
    return e1, np.cross(e3, e1), e3


def momenta(wheel: Wheel, run: Solution) -> tuple[Array, Array]:
    """Momentum and angular momentum about O; w = [Q] q' of (8) in body axes, general J."""
    phi, theta = run["phi"], run["theta"]
    e1, e2, e3 = carrier_axes(run["psi"], theta)
    across = run["psi_dot"] * np.sin(theta)
    L_x = wheel.J_x * (across * np.sin(phi) + run["theta_dot"] * np.cos(phi))
    L_y = wheel.J_y * (across * np.cos(phi) - run["theta_dot"] * np.sin(phi))
    x, y = (np.sin(phi), np.cos(phi))
    L = (L_x * y - L_y * x)[:, None] * e1 + (L_x * x + L_y * y)[:, None] * e2
    L += (wheel.J_z * run["omega_z"])[:, None] * e3
    v = np.stack([run["X_O_dot"], run["Y_O_dot"], run["Z_O_dot"]], axis=1)
    return wheel.m * v, L


def loads(wheel: Wheel, run: Solution, inputs: Inputs) -> tuple[Array, Array]:
    """Total force, and total moment about O, of ground, weight, inputs and rolling friction."""
    e1, e2, e3 = carrier_axes(run["psi"], run["theta"])
    ground = np.stack([run["lambda_1"], run["lambda_2"], run["lambda_3"]], axis=1)
    F = np.array([inputs.force(t) for t in run.t])
    M = np.array([inputs.moment(t) for t in run.t])
    to_contact = -wheel.r_0 * e2 - np.array([0, 0, wheel.r])
    moment = np.cross(to_contact, ground) + run["tau"][:, None] * e3
    moment += M[:, :1] * e1 + M[:, 1:2] * e2 + M[:, 2:] * e3
    return ground + F + wheel.m * np.array(wheel.gravity), moment
