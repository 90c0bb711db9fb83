"""Energy, height, required friction and constraint residuals against their definitions.

Judged by the numpy transcription of the paper's matrices; fixed axes, body axes for omega.
"""

from ctypes import c_double

import numpy as np
import pytest
from equations.paper_transcription import Paper, times
from equations.pointwise import Table, draw
from support import equations as eq
from support.bounds import EPSILON, beyond, relative_error, within

ROWS = 2000


def rolling_states(seed: int) -> tuple[Table, Table]:
    """Wheels and their kinematics on the constraints, any inertia."""
    scenes, motions = draw(seed, eq.FRICTIONLESS, symmetric=False, rows=ROWS)
    y = eq.start_each(eq.MULTIBODY, scenes, motions)
    return scenes["wheel"].copy(), eq.kinematics_each(eq.MULTIBODY, scenes, y)


def state(k: Table) -> Table:
    """q, q_dot of (25)."""
    return eq.columns(k, *k.dtype.names[:12])


def energies(wheels: Table, k: Table) -> np.ndarray:
    return np.array(eq.each(eq.LIBRARY.wheel_energy, wheels, k))


def required_friction(*reaction: float) -> float:
    return eq.LIBRARY.wheel_required_friction((c_double * 3)(*reaction))


def residuals(wheels: Table, k: Table) -> tuple[Table, Table]:
    velocity, height = np.zeros((len(k), 1)), np.zeros((len(k), 1))
    eq.each(eq.LIBRARY.wheel_constraint_residuals, wheels, k, velocity, height)
    return velocity[:, 0], height[:, 0]


def test_energy_is_that_of_translation_rotation_and_height() -> None:
    wheels, k = rolling_states(41)
    expected = Paper(wheels, state(k)).energy
    # kinetic and potential energy may cancel
    within(relative_error(energies(wheels, k), expected), 4096 * EPSILON, "energies")
    k["phi"] += 1e-6  # J_x != J_y: the turn of the body counts
    beyond(relative_error(energies(wheels, k), expected), 9e-7, "energies")


def test_height_of_O_is_that_of_a_torus_on_the_ground() -> None:
    wheels, k = rolling_states(42)
    constants = map(eq.Parameters.from_buffer_copy, wheels)
    heights = np.array([*map(eq.LIBRARY.wheel_height, constants, k["theta"].tolist())])
    paper = Paper(wheels, state(k))
    below = times(paper.A, paper.contact)[:, 2]
    within(relative_error(heights, -below), 64 * EPSILON, "heights")
    within(relative_error(heights, k["Z_O"]), 64 * EPSILON, "heights, 2")
    beyond(relative_error(heights, -below - wheels["r"] * 1e-6), 7e-8, "heights")


def test_required_friction_is_tangential_over_normal_force() -> None:
    assert required_friction(3, 4, 10) == 0.5
    assert required_friction(-3, 4, 10) == 0.5
    assert required_friction(0, 0, 10) == 0
    assert required_friction(3, 4, 20) != 0.5


@pytest.mark.parametrize("normal", [0.0, -1.0])
def test_a_ground_that_does_not_press_needs_infinite_friction(normal: float) -> None:
    assert required_friction(3, 4, normal) == np.inf
    assert required_friction(0, 0, normal) == np.inf
    assert np.isfinite(required_friction(3, 4, 1e-300 - normal))


def test_residuals_are_the_slip_B_q_dot_and_the_error_in_height() -> None:
    wheels, k = rolling_states(44)
    random = np.random.default_rng(45)
    for name in k.dtype.names[6:12]:
        k[name] += random.normal(size=ROWS)
    k["Z_O"] += random.normal(size=ROWS)
    k["omega_z"] = k["phi_dot"] + k["psi_dot"] * np.cos(k["theta"])
    paper = Paper(wheels, state(k))
    velocity, height = residuals(wheels, k)
    slip = np.abs(paper.slip).max(axis=1)
    off = np.abs(k["Z_O"] - wheels["r_0"] * paper.sin_theta - wheels["r"])
    within(np.abs(velocity - slip).max() / slip.max(), 64 * EPSILON, "slip")
    assert height == pytest.approx(off, rel=1e-12, abs=64 * EPSILON)
    beyond(np.abs(velocity - np.linalg.norm(paper.slip, axis=1)).max(), 0.2, "norm")
