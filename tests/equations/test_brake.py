"""The dry brake about the axle by closed forms: it acts as rolling friction does, with its capacity beside s N.

Pointwise, for both formulations. Carrier frame; tau is the moment of ground and brake about the axle.
"""

from __future__ import annotations

import numpy as np
import pytest
from support import equations as eq
from support.bounds import beyond, relative_error, within

from equations import random_scenes

ROWS = 2000
Table = np.ndarray
FORMULATIONS = pytest.mark.parametrize("formulation", [eq.REDUCED, eq.MULTIBODY], ids=["reduced", "multibody"])


def draw(law: int, seed: int = 81) -> tuple[Table, Table]:
    random = np.random.default_rng(seed)
    scenes = random_scenes.scenes(random, law, symmetric=False, rows=ROWS)
    weight = scenes["wheel"]["m"] * 9.81
    scenes["load"]["brake"] = weight * scenes["wheel"]["r_0"] * random.uniform(0.1, 0.5, ROWS)
    return scenes, random_scenes.motions(random, ROWS)


def dynamics(formulation: eq.Formulation, scenes: Table, motions: Table) -> Table:
    return eq.dynamics_each(formulation, scenes, eq.start_each(formulation, scenes, motions))


def error(found: Table, expected: Table) -> float:
    a, b = (eq.columns(d, *d.dtype.names) for d in (found, expected))
    return float((np.abs(a - b).max(axis=1) / np.abs(b).max(axis=1)).max())


def upright(law: int) -> tuple[Table, Table]:
    """Straight rolling at omega_z against sigma's friction, no load but the brake."""
    scenes, motions = draw(law)
    scenes["load"]["F"], scenes["load"]["M"] = 0, 0
    random_scenes.level(scenes)
    motions["theta"], motions["psi_dot"], motions["theta_dot"] = np.pi / 2, 0, 0
    scenes["friction"]["sigma"] = np.sign(motions["phi_dot"])
    return scenes, motions


@FORMULATIONS
def test_an_upright_wheel_brakes_at_constant_deceleration(formulation: eq.Formulation) -> None:
    scenes, motions = upright(eq.ROLLING)
    found = dynamics(formulation, scenes, motions)
    w, brake = scenes["wheel"], scenes["load"]["brake"]
    inertia = w["J_z"] + w["m"] * (w["r_0"] + w["r"]) ** 2
    stopping = -np.sign(motions["phi_dot"]) * (w["s"] * w["m"] * w["g"] + brake) / inertia
    within(relative_error(found["omega_z_dot"], stopping), 3e-13, "omega_z_dot")
    without_brake = -np.sign(motions["phi_dot"]) * w["s"] * w["m"] * w["g"] / inertia
    beyond((np.abs(found["omega_z_dot"]) > 1.1 * np.abs(without_brake)).mean(), 0.9, "omega_z_dot")


@FORMULATIONS
def test_while_the_wheel_turns_a_brake_is_a_moment_against_omega_z(formulation: eq.Formulation) -> None:
    scenes, motions = draw(eq.ROLLING)
    braked = dynamics(formulation, scenes, motions)
    driven = scenes.copy()
    driven["load"]["M"][:, 2] -= scenes["friction"]["sigma"] * scenes["load"]["brake"]
    driven["load"]["brake"] = 0
    expected = dynamics(formulation, driven, motions)
    expected["tau"] -= scenes["friction"]["sigma"] * scenes["load"]["brake"]
    within(error(braked, expected), 7e-14, "error")
    driven["load"]["M"][:, 2] *= 1 + 1e-6
    expected = dynamics(formulation, driven, motions)
    beyond(error(braked, expected), 0.2, "error")


@FORMULATIONS
def test_the_regularized_law_softens_the_brake_as_it_softens_friction(formulation: eq.Formulation) -> None:
    scenes, motions = draw(eq.REGULARIZED)
    soft = dynamics(formulation, scenes, motions)
    omega_z = motions["phi_dot"] + motions["psi_dot"] * np.cos(motions["theta"])
    kappa = np.tanh(omega_z / scenes["friction"]["omega_s"])
    N = np.maximum(soft["lambda_"][:, 2], 0)
    tau = -(scenes["wheel"]["s"] * N + scenes["load"]["brake"]) * kappa
    size = scenes["wheel"]["r_0"] * np.abs(soft["lambda_"]).max(axis=1)
    within((np.abs(soft["tau"] - tau) / size).max(), 1e-14, "tau")
    beyond((np.abs(soft["tau"] - tau / kappa) / size).max(), 0.5, "tau")


@FORMULATIONS
def test_a_held_wheel_asks_for_the_same_moment_whatever_the_brake_can_give(formulation: eq.Formulation) -> None:
    scenes, motions = draw(eq.HELD)
    weak = dynamics(formulation, scenes, motions)
    scenes["load"]["brake"] *= 2
    strong = dynamics(formulation, scenes, motions)
    assert (eq.columns(weak, *weak.dtype.names) == eq.columns(strong, *strong.dtype.names)).all()
    assert (weak["omega_z_dot"] == 0).all()
    drive = scenes["wheel"]["m"] * scenes["wheel"]["r_0"]
    scenes["load"]["M"][:, 2] += drive
    moved = dynamics(formulation, scenes, motions)["tau"] - weak["tau"]
    size = scenes["wheel"]["r_0"] * np.abs(weak["lambda_"]).max(axis=1) + np.abs(weak["tau"])
    within((np.abs(moved + drive) / size).max(), 2e-13, "relative error")  # it holds what drives it
    beyond((np.abs(moved) / size).max(), 0.1, "relative error")


@FORMULATIONS
def test_a_wheel_held_upright_answers_a_slope_by_its_weight_along_it(formulation: eq.Formulation) -> None:
    """A constant F along e1 at O, as gravity on a slope: tau = R F."""
    scenes, motions = upright(eq.HELD)
    motions["psi"], motions["phi_dot"] = 0, 0
    scenes["load"]["F"][:, 0] = 0.1 * scenes["wheel"]["m"] * 9.81
    held = dynamics(formulation, scenes, motions)
    R = scenes["wheel"]["r_0"] + scenes["wheel"]["r"]
    within(relative_error(held["tau"], R * scenes["load"]["F"][:, 0]), 4e-14, "tau")
    within(np.abs(held["X_O_ddot"]).max(), 3e-14, "X_O_ddot")
    scenes["friction"]["kind"] = eq.FRICTIONLESS
    beyond((dynamics(formulation, scenes, motions)["X_O_ddot"]).min(), 0.1, "X_O_ddot")


@FORMULATIONS
def test_without_friction_the_brake_is_ignored_and_with_brake_zero_nothing_is_left(formulation: eq.Formulation) -> None:
    scenes, motions = draw(eq.FRICTIONLESS)
    released = scenes.copy()
    released["load"]["brake"] = 0
    free, without = (dynamics(formulation, s, motions) for s in (scenes, released))
    assert (eq.columns(free, *free.dtype.names) == eq.columns(without, *without.dtype.names)).all()
    scenes["friction"]["kind"] = eq.ROLLING
    assert (dynamics(formulation, scenes, motions)["tau"] != without["tau"]).all()
    scenes["wheel"]["s"], scenes["load"]["brake"] = 0, 0
    idle = dynamics(formulation, scenes, motions)
    assert (idle["tau"] == 0).all()
    within(error(idle, free), 1e-14, "error")


@FORMULATIONS
def test_the_brake_takes_its_capacity_times_the_spin_from_the_energy(formulation: eq.Formulation) -> None:
    scenes, motions = draw(eq.ROLLING)
    scenes["wheel"]["s"] = 0
    y = eq.start_each(formulation, scenes, motions)
    omega_z = eq.kinematics_each(formulation, scenes, y)["omega_z"]
    scenes["friction"]["sigma"] = np.sign(omega_z)
    power = eq.dynamics_each(formulation, scenes, y)["tau"] * omega_z
    within(relative_error(power, -scenes["load"]["brake"] * np.abs(omega_z)), 1e-15, "power")
    assert (power < 0).all()
