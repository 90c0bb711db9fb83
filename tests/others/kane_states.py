"""wheel_equations.h against the wheel by Kane's method, at random states; the wheels and loads of random_scenes.py."""

import numpy as np
from equations.pointwise import answers, draw
from support import equations as eq

from . import kane

NAMES = ("psi_ddot", "theta_ddot", "phi_ddot")


def distance(rows: int = 200, symmetric: bool = False, stretched: float = 1.0) -> float:
    """Largest difference: accelerations relative to the largest of a state, N to the ground's force.

    stretched: factor on the tube radius that Kane's method is given.
    """
    scenes, motions = draw(24, None, symmetric, rows)
    found = eq.dynamics_each(eq.REDUCED, scenes, eq.start_each(eq.REDUCED, scenes, motions))
    scenes["wheel"]["r"] *= stretched
    other = np.array([*answers(kane.accelerations, scenes, motions)])
    ours = eq.columns(found, *NAMES)
    angles = np.abs(ours - other[:, :3]).max(axis=1) / np.abs(ours).max(axis=1)
    forces = np.abs(found["lambda_"][:, 2] - other[:, 3]) / np.abs(found["lambda_"]).max(axis=1)
    return float(max(angles.max(), forces.max()))
