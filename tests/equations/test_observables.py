"""Required friction, contact point and force in wheel axes against their definitions.

Judged by the numpy transcription of the paper's matrices and by differences; fixed axes.
"""

from ctypes import byref, c_double

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, relative_error, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.paper_transcription import Paper, times
from wheelfmu.truth.pointwise import Table, draw, relative

ROWS = 2000


def rolling() -> tuple[Table, Table, Table]:
    """Scenes, the multibody form's kinematics and its dynamics, any inertia."""
    scenes, motions = draw(91, eq.ROLLING, symmetric=False, rows=ROWS)
    y = eq.start_each(eq.MULTIBODY, scenes, motions)
    return scenes, eq.kinematics_each(eq.MULTIBODY, scenes, y), eq.dynamics_each(eq.MULTIBODY, scenes, y)


def state(k: Table) -> Table:
    """q, q_dot of (25)."""
    return eq.columns(k, *k.dtype.names[:12])


def required_friction(*reaction: float) -> float:
    return eq.LIBRARY.wheel_required_friction((c_double * 3)(*reaction))


def required_friction_rate(reaction: tuple[float, ...], rate: tuple[float, ...]) -> float:
    return eq.LIBRARY.wheel_required_friction_rate((c_double * 3)(*reaction), (c_double * 3)(*rate))


def test_required_friction_changes_as_its_quotient_and_is_least_where_no_force_is_tangential() -> None:
    assert required_friction_rate((3, 4, 10), (5, 0, -2)) == pytest.approx(0.4)
    assert required_friction_rate((0, 0, 10), (5, 0, -2)) == 0


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


# ---- the contact ----


def contacts(scenes: Table, k: Table) -> Table:
    """X_C, Y_C, X_C_dot, Y_C_dot row by row."""
    wheels, motions = map(eq.Parameters.from_buffer_copy, scenes["wheel"]), map(eq.Kinematics.from_buffer_copy, k)
    rows = zip(wheels, motions, strict=True)
    return np.array([eq.values(eq.LIBRARY.wheel_contact(byref(wheel), byref(motion))) for wheel, motion in rows])


def horizontal(k: Table, force: Table) -> Table:
    """wheel_horizontal_force row by row."""
    out = np.zeros((len(k), 2))
    eq.each(eq.LIBRARY.wheel_horizontal_force, k, np.ascontiguousarray(force), out)
    return out


def test_the_contact_is_the_lowest_point_of_the_torus() -> None:
    scenes, k, _ = rolling()
    paper = Paper(scenes["wheel"], state(k))
    place = eq.columns(k, "X_O", "Y_O", "Z_O") + times(paper.A, paper.contact)
    found = contacts(scenes, k)
    within(np.abs(found[:, :2] - place[:, :2]).max(), 32 * 5 * EPSILON, "contact point, m")  # places of 5 m
    within(np.abs(place[:, 2]).max(), 32 * 5 * EPSILON, "height of the lowest point, m")
    k["theta"] += 1e-9
    beyond(np.abs(contacts(scenes, k)[:, :2] - place[:, :2]).max(), 1e-10, "contact point of another tilt, m")


def test_the_force_in_wheel_axes_is_lambda_along_e1_and_to_its_left() -> None:
    _, k, d = rolling()
    e1 = np.column_stack([np.cos(k["psi"]), np.sin(k["psi"]), np.zeros(ROWS)])
    left = np.cross([0, 0, 1], e1)
    expected = np.column_stack([(d["lambda_"] * e1).sum(axis=1), (d["lambda_"] * left).sum(axis=1)])
    found = horizontal(k, d["lambda_"])
    within(relative(found, expected), 64 * EPSILON, "force in wheel axes, relative")
    beyond(relative(found, expected * [1, -1]), 0.1, "force to the right of e1, relative")
    within(relative_error(np.hypot(*found.T), np.hypot(*d["lambda_"][:, :2].T)), 64 * EPSILON, "size of it, relative")
