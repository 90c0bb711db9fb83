"""How far a solution is from the contact and from the laws of mechanics: 0 for the exact motion.

Momentum and angular momentum are written with the Euler angles and the non-spinning axes of the outputs: nothing in
them is shared with the equations that are judged. Fixed axes unless said.
"""

import numpy as np
from numpy.typing import NDArray

from .integrate import solve
from .model import Inputs, Road, Start, Wheel
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
    """Total force, and total moment about O, of ground, weight, inputs and rolling resistance."""
    e1, e2, e3 = carrier_axes(run["psi"], run["theta"])
    ground = np.stack([run["lambda_1"], run["lambda_2"], run["lambda_3"]], axis=1)
    F = np.array([inputs.force(t) for t in run.t])
    M = np.array([inputs.moment(t) for t in run.t])
    to_contact = -wheel.r_0 * e2 - np.array([0, 0, wheel.r])
    moment = np.cross(to_contact, ground) + run["tau"][:, None] * e3
    moment += M[:, :1] * e1 + M[:, 1:2] * e2 + M[:, 2:] * e3
    return ground + F + wheel.m * np.array(wheel.gravity), moment


def contact_gap(got: Solution) -> float:
    """Drift off the contact: |v_O - w x p - u| (m/s) and height of O (m)."""
    return max(got["residual_velocity"].max(), np.abs(got["residual_height"]).max())


def energy_gap(got: Solution, *works: str) -> float:
    """Change of energy less these works, relative to the energy at the start."""
    gap = got["E"] - got["E"][0] - sum(got[f"work_{work}"] for work in works)
    return np.abs(gap).max() / np.abs(got["E"][0])


def impulse_gap(wheel: Wheel, inputs: Inputs, judged: Wheel, duration: float = 1.0, road: Road | None = None) -> float:
    """Change of (angular) momentum less the impulse of all loads, by Gauss's rule.

    judged: the wheel with whose inertia the momenta are formed.
    """
    nodes, weights = np.polynomial.legendre.leggauss(60)
    times = duration * np.concatenate([[0], (nodes + 1) / 2, [1]])
    got = solve(wheel, Start(phi=0.3, psi_dot=0.4, theta_dot=0.3), times, inputs, road)
    assert (got["contact_mode"] == (road is not None)).all()
    gaps = []
    for held, load in zip(momenta(judged, got), loads(wheel, got, inputs), strict=True):
        gaps.append(held[-1] - held[0] - duration * weights @ load[1:-1] / 2)
    return np.abs(gaps).max()
