"""Unequal moments of inertia: how N answers the moment about the axle.

Random scenes with loads and brakes (pointwise.py). Carrier frame.
"""

import numpy as np
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.pointwise import Table, draw, dynamics

ROWS = 20_000


def answer_of_N(scenes: Table, motions: Table) -> Table:
    """alpha = dN/dtau by its closed form, 1/m."""
    w, theta, phi = scenes["wheel"], motions["theta"], motions["phi"]
    rho, eta = w["r_0"] + w["r"] * np.sin(theta), w["r"] * np.cos(theta)
    mean, D = (w["J_x"] + w["J_y"]) / 2, (w["J_x"] - w["J_y"]) / 2
    q, p = D * np.cos(2 * phi), D * np.sin(2 * phi)
    a_11, a_22 = mean + q + w["m"] * (rho**2 + eta**2), mean - q + w["m"] * eta**2
    a_23, a_33 = -w["m"] * eta * rho, w["J_z"] + w["m"] * rho**2
    b_22 = a_22 - p**2 / a_11
    return w["m"] * w["r_0"] * np.cos(theta) * p * a_23 / (a_11 * (b_22 * a_33 - a_23**2))


def test_N_answers_a_moment_about_the_axle_by_alpha(formulation: eq.Formulation, symmetric: bool) -> None:
    scenes, motions = draw(71, eq.FRICTIONLESS, symmetric, 5000)
    free = dynamics(formulation, scenes, motions)["lambda_"][:, 2]
    moment = scenes["wheel"]["m"] * scenes["wheel"]["r_0"] * 100
    scenes["load"]["M"][:, 2] += moment
    driven = dynamics(formulation, scenes, motions)["lambda_"]
    alpha = answer_of_N(scenes, motions)
    size = np.abs(driven).max(axis=1) / moment
    within((np.abs((driven[:, 2] - free) / moment - alpha) / size).max(), 256 * EPSILON, "answer of N, relative")
    if symmetric:
        assert (alpha == 0).all()
        return
    beyond(np.abs(alpha * scenes["wheel"]["r_0"]).max(), 0.1, "largest alpha r_0")  # N does answer
    beyond((np.abs((driven[:, 2] - free) / moment + alpha) / size).max(), 0.05, "answer of N off -alpha, relative")


def test_N_under_rolling_resistance_and_brake_follows_from_that_of_the_free_wheel(formulation: eq.Formulation) -> None:
    """N = (N_free - alpha kappa M_b)/(1 + alpha kappa s), tau = -(s N + M_b) kappa."""
    scenes, motions = draw(71, eq.ROLLING, symmetric=False, rows=ROWS)
    found = dynamics(formulation, scenes, motions)
    free = scenes.copy()
    free["friction"]["kind"] = eq.FRICTIONLESS
    N_free = dynamics(formulation, free, motions)["lambda_"][:, 2]
    alpha, kappa, s = answer_of_N(scenes, motions), scenes["friction"]["sigma"], scenes["wheel"]["s"]
    brake = scenes["load"]["brake"]
    size = np.abs(found["lambda_"]).max(axis=1)
    unpressed = N_free - alpha * kappa * brake
    N = np.where(unpressed > 0, unpressed / (1 + alpha * kappa * s), unpressed)
    within((np.abs(found["lambda_"][:, 2] - N) / size).max(), 256 * EPSILON, "N, relative")
    tau = -kappa * (s * np.maximum(N, 0) + brake)
    within((np.abs(found["tau"] - tau) / (scenes["wheel"]["r_0"] * size)).max(), 64 * EPSILON, "tau over r_0, relative")
    without_alpha = np.abs(found["lambda_"][:, 2] - N_free) / size
    beyond(without_alpha.max(), 1e-2, "N off that of the free wheel, relative")
    without_brake = np.where(N_free > 0, N_free / (1 + alpha * kappa * s), N_free)
    beyond((np.abs(found["lambda_"][:, 2] - without_brake) / size).max(), 1e-2, "N without the brake, relative")
