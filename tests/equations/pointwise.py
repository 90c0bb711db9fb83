"""What the pointwise tests share: parametrizations, drawn states, answers, and how far two answers are apart.

Errors are relative to the largest entry of their group: accelerations of O, of the angles and the axle, reactions.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from equations import random_scenes
from reference import Wheel, accelerations
from support import equations as eq

Table = np.ndarray
GROUPS = (("X_O_ddot", "Y_O_ddot", "Z_O_ddot"), ("psi_ddot", "theta_ddot", "phi_ddot", "omega_z_dot"), ("lambda_",))
ACCELERATIONS = (*GROUPS[0], *GROUPS[1][:3])


def draw(seed: int, law=None, symmetric: bool = True, rows: int = random_scenes.COUNT) -> tuple[Table, Table]:
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


def answers(accelerations: Callable, scenes: np.ndarray, motions: np.ndarray) -> Iterator:
    """By a function of (wheel, angles, rates, F, M, sigma, brake), which counts the weight of a level road: row by row.

    Without pressure there is no friction but the brake's.
    """
    omega_z = motions["phi_dot"] + motions["psi_dot"] * np.cos(motions["theta"])
    for scene, motion, spin in zip(scenes, motions, omega_z.tolist(), strict=True):
        constants, friction = scene["wheel"], scene["friction"]
        wheel = Wheel(**{name: float(constants[name]) for name in ("m", "r_0", "r", "J_x", "J_y", "J_z", "g", "s")})
        sigma = [0.0, friction["sigma"], None, np.tanh(spin / friction["omega_s"])][friction["kind"] - eq.FRICTIONLESS]
        angles = [float(motion[name]) for name in ("psi", "theta", "phi")]
        rates = [float(motion[name]) for name in ("psi_dot", "theta_dot", "phi_dot")]
        (F_X, F_Y, F_Z), M, brake = (scene["load"][name].tolist() for name in ("F", "M", "brake"))
        F = (F_X + wheel.m * constants["g_X"], F_Y + wheel.m * constants["g_Y"], F_Z)  # with the weight along a slope
        found = accelerations(wheel, angles, rates, F, M, sigma, brake)
        if sigma is not None and found.lambda_3 <= 0:
            found = accelerations(replace(wheel, s=0.0), angles, rates, F, M, sigma, brake)
        yield found


def referenced(scenes: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """WheelDynamics from the reference."""
    out = eq.table(eq.Dynamics, len(scenes))
    for row, found in zip(out, answers(accelerations, scenes, motions), strict=True):
        for name in (*ACCELERATIONS, "tau"):
            row[name] = getattr(found, name)
        row["lambda_"] = found.lambda_1, found.lambda_2, found.lambda_3
    s, c = np.sin(motions["theta"]), np.cos(motions["theta"])
    turning = out["psi_ddot"] * c - motions["psi_dot"] * motions["theta_dot"] * s
    out["omega_z_dot"] = out["phi_ddot"] + turning
    return out
