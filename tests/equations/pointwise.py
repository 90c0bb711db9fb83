"""What the pointwise tests share: parametrizations, drawn states, answers, and how far two answers are apart.

Errors are relative to the largest entry of their group: accelerations of O, of the angles and the axle, reactions.
"""

from dataclasses import replace

import numpy as np
from reference import Wheel, accelerations
from support import equations as eq

from equations import random_scenes

Table = np.ndarray
GROUPS = (("X_O_ddot", "Y_O_ddot", "Z_O_ddot"), ("psi_ddot", "theta_ddot", "phi_ddot", "omega_z_dot"), ("lambda_",))
ACCELERATIONS = (*GROUPS[0], *GROUPS[1][:3])


def draw(
    seed: int, law: int | None = None, symmetric: bool = True, rows: int = random_scenes.COUNT
) -> tuple[Table, Table]:
    """Scenes and motions."""
    random = np.random.default_rng(seed)
    return random_scenes.scenes(random, law, symmetric, rows), random_scenes.motions(random, rows)


def dynamics(formulation: eq.Formulation, scenes: Table, motions: Table) -> Table:
    return eq.dynamics_each(formulation, scenes, eq.start_each(formulation, scenes, motions))


def relative(a: Table, b: Table) -> float:
    """Largest error over the rows, each relative to the row's largest entry."""
    size = np.abs(b).max(axis=1)
    return float((np.abs(a - b).max(axis=1) / np.where(size > 0, size, 1)).max())


def distance(a: Table, b: Table, scenes: Table) -> float:
    """Largest relative error over all groups of WheelDynamics; tau is measured by r_0 lambda."""
    errors = [relative(eq.columns(a, *names), eq.columns(b, *names)) for names in GROUPS]
    force = scenes["wheel"]["r_0"] * np.abs(b["lambda_"]).max(axis=1)
    errors.append(float((np.abs(a["tau"] - b["tau"]) / (force + np.abs(b["tau"]))).max()))
    return max(errors)


def reference_wheel(wheel: np.ndarray) -> Wheel:
    """One row of constants, its gravity as slope and direction."""
    *constants, g, s, g_X, g_Y = wheel.tolist()
    along = np.hypot(g_X, g_Y)
    return Wheel(*constants, np.hypot(g, along), s, np.arctan2(along, g), np.arctan2(-g_Y, -g_X))


def referenced(scenes: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """WheelDynamics from the reference; without pressure there is no friction but the brake's."""
    out = eq.table(eq.Dynamics, len(scenes))
    y = eq.start_each(eq.MULTIBODY, scenes, motions)
    omega_z = eq.kinematics_each(eq.MULTIBODY, scenes, y)["omega_z"]
    for row, scene, motion, spin in zip(out, scenes, motions, omega_z.tolist(), strict=True):
        wheel, friction = reference_wheel(scene["wheel"]), scene["friction"]
        sigma = [0.0, friction["sigma"], None, np.tanh(spin / friction["omega_s"])][friction["kind"] - eq.FRICTIONLESS]
        angles, rates = motion.tolist()[:3], motion.tolist()[3:6]
        *loads, brake = scene["load"].tolist()
        found = accelerations(wheel, angles, rates, *loads, sigma, brake)
        if friction["kind"] in (eq.ROLLING, eq.REGULARIZED) and found.lambda_3 <= 0:
            found = accelerations(replace(wheel, s=0.0), angles, rates, *loads, sigma, brake)
        for name in (*ACCELERATIONS, "tau"):
            row[name] = getattr(found, name)
        row["lambda_"] = found.lambda_1, found.lambda_2, found.lambda_3
    s, c = np.sin(motions["theta"]), np.cos(motions["theta"])
    turning = out["psi_ddot"] * c - motions["psi_dot"] * motions["theta_dot"] * s
    out["omega_z_dot"] = out["phi_ddot"] + turning
    return out
