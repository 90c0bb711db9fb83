"""wheel_equations.h against the wheel by Kane's method, at random states; the wheels and loads of random_scenes.py."""

from dataclasses import replace

import numpy as np
from equations.pointwise import draw
from reference import Wheel
from support import equations as eq

from . import kane

NAMES = ("psi_ddot", "theta_ddot", "phi_ddot")


def by_kane(scene: np.void, motion: np.void) -> kane.Motion:
    """One random scene; where the ground pulls there is no rolling friction, only the brake's."""
    *constants, g_X, g_Y = scene["wheel"].tolist()
    wheel, friction = Wheel(*constants), scene["friction"]
    F, M, brake = scene["load"].tolist()
    F = (F[0] + wheel.m * g_X, F[1] + wheel.m * g_Y, F[2])  # the weight along a slope
    angles, rates = motion.tolist()[:3], motion.tolist()[3:6]
    spin = rates[2] + rates[0] * np.cos(angles[1])
    laws = {eq.FRICTIONLESS: 0.0, eq.ROLLING: friction["sigma"], eq.REGULARIZED: np.tanh(spin / friction["omega_s"])}
    sigma = laws.get(friction["kind"])  # None: held
    found = kane.accelerations(wheel, angles, rates, F, M, sigma, brake)
    if sigma is not None and found.lambda_3 <= 0:
        found = kane.accelerations(replace(wheel, s=0.0), angles, rates, F, M, sigma, brake)
    return found


def distance(rows: int = 200, symmetric: bool = False, stretched: float = 1.0) -> float:
    """Largest difference: accelerations relative to the largest of a state, N to the ground's force.

    stretched: factor on the tube radius that Kane's method is given.
    """
    scenes, motions = draw(24, None, symmetric, rows)
    found = eq.dynamics_each(eq.REDUCED, scenes, eq.start_each(eq.REDUCED, scenes, motions))
    scenes["wheel"]["r"] *= stretched
    other = np.array([by_kane(*pair) for pair in zip(scenes, motions, strict=True)])
    ours = eq.columns(found, *NAMES)
    angles = np.abs(ours - other[:, :3]).max(axis=1) / np.abs(ours).max(axis=1)
    forces = np.abs(found["lambda_"][:, 2] - other[:, 3]) / np.abs(found["lambda_"]).max(axis=1)
    return float(max(angles.max(), forces.max()))
