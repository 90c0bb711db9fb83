"""Motions whose accelerations are known in closed form, for both formulations.

Upright straight rolling, the standing wheel, release from rest, and steady circles, at a thousand
random wheels each. Carrier axes e1 (rolling), e2 (up the slope), e3 (axle); fixed axes for lambda.
"""

import numpy as np
from support import equations as eq
from support.bounds import EPSILON, beyond, within
from support.closed_forms import circle_spin, rolling_inertia

from equations import random_scenes
from equations.pointwise import Table, dynamics

ROWS = 1000


def still(kind: int) -> tuple[Table, Table]:
    """Random wheels with J_x = J_y, no load, all rates zero."""
    random = np.random.default_rng(11)
    scenes = random_scenes.scenes(random, kind, rows=ROWS)
    scenes["load"] = np.zeros(1, scenes["load"].dtype)
    random_scenes.level(scenes)
    scenes["wheel"]["g"] = random.uniform(1, 20, ROWS)
    motions = random_scenes.motions(random, ROWS)
    for rate in ("psi_dot", "theta_dot", "phi_dot"):
        motions[rate] = 0
    return scenes, motions


def error(found: Table, exact: Table, size: Table | float = 1) -> float:
    return float((np.abs(found - exact) / size).max())


def constants(scenes: Table, **changes: float) -> np.recarray:
    """The wheels with their constants as attributes, as closed_forms.py reads them."""
    wheels = scenes["wheel"].copy()
    for name, value in changes.items():
        wheels[name] = value
    return wheels.view(np.recarray)


def weight(scenes: Table) -> Table:
    return scenes["wheel"]["m"] * scenes["wheel"]["g"]


def test_upright_straight_rolling_slows_down_linearly_under_friction(formulation: eq.Formulation) -> None:
    scenes, motions = still(eq.ROLLING)
    sigma = scenes["friction"]["sigma"]
    motions["theta"], motions["phi_dot"] = np.pi / 2, 3 * sigma
    d = dynamics(formulation, scenes, motions)
    slowing = -sigma * scenes["wheel"]["s"] * weight(scenes) / rolling_inertia(constants(scenes))
    thin = -sigma * scenes["wheel"]["s"] * weight(scenes) / rolling_inertia(constants(scenes, r=0))
    size = np.abs(slowing)
    within(error(d["omega_z_dot"], slowing, size), 32768 * EPSILON, "omega_z_dot")  # s is small in some rows
    beyond(error(d["omega_z_dot"], -slowing, size), 1.9, "omega_z_dot")  # wrong sign of the friction
    beyond(error(d["omega_z_dot"], thin, size), 0.1, "omega_z_dot, 2")  # wheel without tube
    # a solution for 9 unknowns
    within(error(d["lambda_"][:, 2], weight(scenes), weight(scenes)), 256 * EPSILON, "lambda_")
    straight = error(eq.columns(d, "theta_ddot", "psi_ddot"), np.zeros((ROWS, 2)))
    within(straight, 128 * 10 * EPSILON, "error")  # terms of 10 1/s2


def test_an_upright_wheel_answers_a_drive_torque_and_a_push_as_a_roller_or_is_held_against_both(
    formulation: eq.Formulation,
) -> None:
    scenes, motions = still(eq.FRICTIONLESS)
    motions["theta"], motions["psi"] = np.pi / 2, 0  # rolling direction along X
    torque, push = weight(scenes) * scenes["wheel"]["r_0"], 0.3 * weight(scenes)
    radius = scenes["wheel"]["r_0"] + scenes["wheel"]["r"]
    scenes["load"]["M"][:, 2], scenes["load"]["F"][:, 0] = torque, push
    inertia = rolling_inertia(constants(scenes))
    d = dynamics(formulation, scenes, motions)
    spin_up = (torque - radius * push) / inertia
    within(error(d["omega_z_dot"], spin_up, np.abs(spin_up)), 1024 * EPSILON, "omega_z_dot")  # drive and push cancel
    within(error(d["X_O_ddot"], -radius * spin_up, np.abs(radius * spin_up)), 256 * EPSILON, "X_O_ddot")
    beyond(error(d["omega_z_dot"], spin_up + 2 * radius * push / inertia), 7, "omega_z_dot")
    scenes["friction"]["kind"] = eq.HELD
    d = dynamics(formulation, scenes, motions)
    assert (d["omega_z_dot"] == 0).all()
    within(error(d["tau"], radius * push - torque, torque), 512 * EPSILON, "tau")  # drive and push cancel
    beyond(error(d["tau"], -radius * push - torque, torque), 0.3, "tau")  # push the other way
    within(error(d["X_O_ddot"], np.zeros(ROWS)), 256 * 20 * EPSILON, "X_O_ddot, held")  # terms of 20 m/s2


def test_a_wheel_released_from_rest_tips_about_its_contact(formulation: eq.Formulation) -> None:
    scenes, motions = still(eq.HELD)
    w = scenes["wheel"]
    s, c = np.sin(motions["theta"]), np.cos(motions["theta"])
    lever = w["r_0"] ** 2 + 2 * w["r_0"] * w["r"] * s + w["r"] ** 2  # contact to O, squared
    tipping = -weight(scenes) * w["r_0"] * c / (w["J_x"] + w["m"] * lever)
    size = weight(scenes) * w["r_0"] / w["J_x"]
    d = dynamics(formulation, scenes, motions)
    within(error(d["theta_ddot"], tipping, size), 32 * EPSILON, "theta_ddot")
    beyond(error(d["theta_ddot"], tipping * (1 + w["r"] / w["r_0"] * s), size), 0.01, "theta_ddot")  # r counts


def circling(kind: int) -> tuple[Table, Table]:
    scenes, motions = still(kind)
    random = np.random.default_rng(12)
    motions["psi_dot"] = random.choice([-1, 1], ROWS) * random.uniform(0.5, 5, ROWS)
    spin = circle_spin(constants(scenes), motions["theta"], motions["psi_dot"])
    motions["phi_dot"] = spin - motions["psi_dot"] * np.cos(motions["theta"])
    return scenes, motions


def test_the_torus_circles_steadily_with_friction_balanced_by_the_drive(formulation: eq.Formulation) -> None:
    scenes, motions = circling(eq.ROLLING)
    sigma = scenes["friction"]["sigma"]
    scenes["load"]["M"][:, 2] = sigma * scenes["wheel"]["s"] * weight(scenes)
    within(unsteadiness(formulation, scenes, motions), 4096 * EPSILON, "unsteadiness")  # gyroscopic moments cancel
    scenes["friction"]["sigma"] = -sigma
    beyond(unsteadiness(formulation, scenes, motions), 0.1, "unsteadiness")  # friction drives


def unsteadiness(formulation: eq.Formulation, scenes: Table, motions: Table) -> float:
    """How far from: no angular acceleration, N = m g, ground pulls inwards by m v psi_dot."""
    d = dynamics(formulation, scenes, motions)
    k = eq.kinematics_each(formulation, scenes, eq.start_each(formulation, scenes, motions))
    rates = np.abs(eq.columns(motions, "psi_dot", "phi_dot")).max(axis=1) ** 2
    turning = eq.columns(d, "psi_ddot", "theta_ddot", "omega_z_dot")
    turning[:, 0] *= np.sin(motions["theta"])
    size = rates + scenes["wheel"]["g"] / scenes["wheel"]["r_0"]
    speed = np.hypot(k["X_O_dot"], k["Y_O_dot"])
    pull = scenes["wheel"]["m"] * speed * np.abs(motions["psi_dot"])
    along_the_ground = np.hypot(d["lambda_"][:, 0], d["lambda_"][:, 1])
    return max(
        error(turning, np.zeros((ROWS, 3)), size[:, None]),
        error(d["lambda_"][:, 2], weight(scenes), weight(scenes)),
        error(along_the_ground, pull, pull + weight(scenes)),
    )
