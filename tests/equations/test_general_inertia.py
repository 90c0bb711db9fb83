"""The reduced form for any principal moments of inertia: against the multibody form, and N's answer to the axle moment.

Twenty thousand random scenes for each law of friction, with loads and brakes (random_scenes.py). Carrier frame.
"""

from __future__ import annotations

import numpy as np
import pytest
from support import equations as eq
from support.bounds import beyond, within

from equations import random_scenes

ROWS = 20_000
BOUND = 1e-11
Table = np.ndarray
each_law = pytest.mark.parametrize("law", eq.LAWS.values(), ids=eq.LAWS.keys())


def draw(law: int, symmetric: bool = False, rows: int = ROWS) -> tuple[Table, Table]:
    random = np.random.default_rng(71)
    return random_scenes.scenes(random, law, symmetric, rows), random_scenes.motions(random, rows)


def dynamics(formulation: eq.Formulation, scenes: Table, motions: Table) -> Table:
    return eq.dynamics_each(formulation, scenes, eq.start_each(formulation, scenes, motions))


def errors(found: Table, expected: Table, scenes: Table) -> dict[str, float]:
    """Largest errors, relative to the row's accelerations, reaction, and reaction times r_0."""
    groups = {"O": expected.dtype.names[:3], "angles": expected.dtype.names[3:7], "lambda": ("lambda_",)}
    out = {}
    for name, fields in groups.items():
        a, b = eq.columns(found, *fields), eq.columns(expected, *fields)
        out[name] = (np.abs(a - b).max(axis=1) / np.abs(b).max(axis=1)).max()
    arm = scenes["wheel"]["r_0"] * np.abs(expected["lambda_"]).max(axis=1) + np.abs(expected["tau"])
    out["tau"] = (np.abs(found["tau"] - expected["tau"]) / arm).max()
    return out


@each_law
@pytest.mark.parametrize("symmetric", [True, False], ids=["J_x = J_y", "any J"])
def test_reduced_and_multibody_agree_for_any_inertia(law: int, symmetric: bool) -> None:
    scenes, motions = draw(law, symmetric)
    multibody, reduced = (dynamics(f, scenes, motions) for f in (eq.MULTIBODY, eq.REDUCED))
    found = errors(reduced, multibody, scenes)
    within(max(found.values()), 9e-13, "relative error")
    scenes["wheel"]["J_y"] *= 1 + 1e-9
    motions["phi"] += 1e-9
    beyond(max(errors(dynamics(eq.REDUCED, scenes, motions), multibody, scenes).values()), 2e-9, "relative error")


@each_law
def test_a_difference_of_rounding_between_J_x_and_J_y_changes_nothing_but_rounding(law: int) -> None:
    """The simpler elimination for J_x = J_y is the limit of the general one."""
    scenes, motions = draw(law, symmetric=True)
    equal = dynamics(eq.REDUCED, scenes, motions)
    scenes["wheel"]["J_y"] *= 1 + 1e-15
    assert (scenes["wheel"]["J_x"] != scenes["wheel"]["J_y"]).all()
    within(max(errors(dynamics(eq.REDUCED, scenes, motions), equal, scenes).values()), 7e-13, "relative error")
    scenes["wheel"]["J_y"] *= 1 + 1e-8
    beyond(max(errors(dynamics(eq.REDUCED, scenes, motions), equal, scenes).values()), 2e-8, "relative error")


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


@pytest.mark.parametrize("formulation", [eq.REDUCED, eq.MULTIBODY], ids=["reduced", "multibody"])
def test_N_answers_a_moment_about_the_axle_by_alpha(formulation: eq.Formulation) -> None:
    scenes, motions = draw(eq.FRICTIONLESS, rows=5000)
    free = dynamics(formulation, scenes, motions)["lambda_"][:, 2]
    moment = scenes["wheel"]["m"] * scenes["wheel"]["r_0"] * 100
    scenes["load"]["M"][:, 2] += moment
    driven = dynamics(formulation, scenes, motions)["lambda_"]
    alpha = answer_of_N(scenes, motions)
    size = np.abs(driven).max(axis=1) / moment
    within((np.abs((driven[:, 2] - free) / moment - alpha) / size).max(), 5e-14, "relative error")
    beyond(np.abs(alpha * scenes["wheel"]["r_0"]).max(), 0.1, "r_0")  # it does answer
    beyond((np.abs((driven[:, 2] - free) / moment + alpha) / size).max(), 0.05, "relative error")  # the other sign
    scenes["wheel"]["J_y"] = scenes["wheel"]["J_x"]
    assert (answer_of_N(scenes, motions) == 0).all()


@pytest.mark.parametrize("formulation", [eq.REDUCED, eq.MULTIBODY], ids=["reduced", "multibody"])
def test_N_under_rolling_friction_and_brake_follows_from_that_of_the_free_wheel(formulation: eq.Formulation) -> None:
    """N = (N_free - alpha kappa M_b)/(1 + alpha kappa s), tau = -(s N + M_b) kappa."""
    scenes, motions = draw(eq.ROLLING)
    found = dynamics(formulation, scenes, motions)
    free = scenes.copy()
    free["friction"]["kind"] = eq.FRICTIONLESS
    N_free = dynamics(formulation, free, motions)["lambda_"][:, 2]
    alpha, kappa, s = answer_of_N(scenes, motions), scenes["friction"]["sigma"], scenes["wheel"]["s"]
    brake = scenes["load"]["brake"]
    size = np.abs(found["lambda_"]).max(axis=1)
    unpressed = N_free - alpha * kappa * brake
    N = np.where(unpressed > 0, unpressed / (1 + alpha * kappa * s), unpressed)
    within((np.abs(found["lambda_"][:, 2] - N) / size).max(), 5e-14, "lambda_")
    tau = -kappa * (s * np.maximum(N, 0) + brake)
    within((np.abs(found["tau"] - tau) / (scenes["wheel"]["r_0"] * size)).max(), 6e-15, "r_0")
    without_alpha = np.abs(found["lambda_"][:, 2] - N_free) / size
    beyond(without_alpha.max(), 1e-2, "without alpha")
    without_brake = np.where(N_free > 0, N_free / (1 + alpha * kappa * s), N_free)
    beyond((np.abs(found["lambda_"][:, 2] - without_brake) / size).max(), 1e-2, "lambda_")


def test_phi_matters_where_J_x_differs_from_J_y_and_only_there() -> None:
    for symmetric in (True, False):
        scenes, motions = draw(eq.ROLLING, symmetric, 2000)
        before = dynamics(eq.REDUCED, scenes, motions)
        motions["phi"] += np.pi  # half a turn of the body changes nothing, but its rounding
        within(max(errors(dynamics(eq.REDUCED, scenes, motions), before, scenes).values()), 5e-14, "relative error")
        motions["phi"] += 1.0
        change = max(errors(dynamics(eq.REDUCED, scenes, motions), before, scenes).values())
        assert change == 0 if symmetric else change > 0.1
