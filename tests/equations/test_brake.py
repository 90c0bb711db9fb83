"""The dry brake about the axle by closed forms: it acts as rolling friction does, with its capacity beside s N.

Pointwise, for both formulations. Carrier frame; tau is the moment of ground and brake about the axle.
"""

import numpy as np
from support import equations as eq
from support.bounds import EPSILON, beyond, relative_error, within

from equations import random_scenes
from equations.pointwise import Table, distance, draw, dynamics

ROWS = 2000


def braked(law: int) -> tuple[Table, Table]:
    scenes, motions = draw(81, law, symmetric=False, rows=ROWS)
    share = np.random.default_rng(82).uniform(0.1, 0.5, ROWS)
    scenes["load"]["brake"] = share * scenes["wheel"]["m"] * 9.81 * scenes["wheel"]["r_0"]
    return scenes, motions


def upright(law: int) -> tuple[Table, Table]:
    """Straight rolling at omega_z against sigma's friction, no load but the brake."""
    scenes, motions = braked(law)
    scenes["load"]["F"], scenes["load"]["M"] = 0, 0
    random_scenes.level(scenes)
    motions["theta"], motions["psi_dot"], motions["theta_dot"] = np.pi / 2, 0, 0
    scenes["friction"]["sigma"] = np.sign(motions["phi_dot"])
    return scenes, motions


def test_while_the_wheel_turns_a_brake_is_a_moment_against_omega_z(formulation: eq.Formulation) -> None:
    scenes, motions = braked(eq.ROLLING)
    slowed = dynamics(formulation, scenes, motions)
    driven = scenes.copy()
    driven["load"]["M"][:, 2] -= scenes["friction"]["sigma"] * scenes["load"]["brake"]
    driven["load"]["brake"] = 0
    expected = dynamics(formulation, driven, motions)
    expected["tau"] -= scenes["friction"]["sigma"] * scenes["load"]["brake"]
    within(distance(slowed, expected, scenes), 1024 * EPSILON, "error")  # 1/sin(theta) is up to 20
    driven["load"]["M"][:, 2] *= 1 + 1e-6
    expected = dynamics(formulation, driven, motions)
    beyond(distance(slowed, expected, scenes), 0.2, "error")


def test_the_regularized_law_softens_the_brake_as_it_softens_friction(formulation: eq.Formulation) -> None:
    scenes, motions = braked(eq.REGULARIZED)
    soft = dynamics(formulation, scenes, motions)
    omega_z = motions["phi_dot"] + motions["psi_dot"] * np.cos(motions["theta"])
    kappa = np.tanh(omega_z / scenes["friction"]["omega_s"])
    N = np.maximum(soft["lambda_"][:, 2], 0)
    tau = -(scenes["wheel"]["s"] * N + scenes["load"]["brake"]) * kappa
    size = scenes["wheel"]["r_0"] * np.abs(soft["lambda_"]).max(axis=1)
    within((np.abs(soft["tau"] - tau) / size).max(), 64 * EPSILON, "tau")
    beyond((np.abs(soft["tau"] - tau / kappa) / size).max(), 0.5, "tau")


def test_a_held_wheel_asks_for_the_same_moment_whatever_the_brake_can_give(formulation: eq.Formulation) -> None:
    scenes, motions = braked(eq.HELD)
    weak = dynamics(formulation, scenes, motions)
    scenes["load"]["brake"] *= 2
    strong = dynamics(formulation, scenes, motions)
    assert (eq.columns(weak, *weak.dtype.names) == eq.columns(strong, *strong.dtype.names)).all()
    assert (weak["omega_z_dot"] == 0).all()
    drive = scenes["wheel"]["m"] * scenes["wheel"]["r_0"]
    scenes["load"]["M"][:, 2] += drive
    moved = dynamics(formulation, scenes, motions)["tau"] - weak["tau"]
    size = scenes["wheel"]["r_0"] * np.abs(weak["lambda_"]).max(axis=1) + np.abs(weak["tau"])
    within((np.abs(moved + drive) / size).max(), 1024 * EPSILON, "relative error")  # it holds what drives it
    beyond((np.abs(moved) / size).max(), 0.1, "relative error")


def test_a_wheel_held_upright_answers_a_slope_by_its_weight_along_it(formulation: eq.Formulation) -> None:
    """A constant F along e1 at O, as gravity on a slope: tau = R F."""
    scenes, motions = upright(eq.HELD)
    motions["psi"], motions["phi_dot"] = 0, 0
    scenes["load"]["F"][:, 0] = 0.1 * scenes["wheel"]["m"] * 9.81
    held = dynamics(formulation, scenes, motions)
    R = scenes["wheel"]["r_0"] + scenes["wheel"]["r"]
    # a solution for 9 unknowns
    within(relative_error(held["tau"], R * scenes["load"]["F"][:, 0]), 256 * EPSILON, "tau")
    within(np.abs(held["X_O_ddot"]).max(), 256 * EPSILON, "X_O_ddot")  # terms of 1 m/s2
    scenes["friction"]["kind"] = eq.FRICTIONLESS
    beyond((dynamics(formulation, scenes, motions)["X_O_ddot"]).min(), 0.1, "X_O_ddot")


def test_without_friction_the_brake_is_ignored_and_with_brake_zero_nothing_is_left(formulation: eq.Formulation) -> None:
    scenes, motions = braked(eq.FRICTIONLESS)
    released = scenes.copy()
    released["load"]["brake"] = 0
    free, without = (dynamics(formulation, s, motions) for s in (scenes, released))
    assert (eq.columns(free, *free.dtype.names) == eq.columns(without, *without.dtype.names)).all()
    scenes["friction"]["kind"] = eq.ROLLING
    assert (dynamics(formulation, scenes, motions)["tau"] != without["tau"]).all()
    scenes["wheel"]["s"], scenes["load"]["brake"] = 0, 0
    idle = dynamics(formulation, scenes, motions)
    assert (idle["tau"] == 0).all()
    within(distance(idle, free, scenes), 64 * EPSILON, "error")
