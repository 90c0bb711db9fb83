"""What the plane, the wheel and the direction of time leave unchanged, pointwise.

Each symmetry maps scenes, motions and accelerations; the mapped answer must equal the answer to
the mapped question. Fixed axes for forces, carrier axes for moments. Partners break the map.
"""

from __future__ import annotations

import pytest
from support import equations as eq
from support.bounds import beyond, within
from support.symmetries import SYMMETRIES, Symmetry

from equations.pointwise import Table, distance, draw, dynamics

FORMULATIONS = pytest.mark.parametrize(
    "formulation", [eq.REDUCED, eq.EULER, eq.MULTIBODY], ids=["reduced", "Euler", "multibody"]
)
ROWS = 2000


def on_plane(symmetry: Symmetry, table: Table, x: str, y: str) -> None:
    for name, column in symmetry.on_plane(table, x, y).items():
        table[name] = column


def map_scenes(symmetry: Symmetry, scenes: Table) -> Table:
    out = scenes.copy()
    out["load"]["F"][:, :2] = scenes["load"]["F"][:, :2] @ symmetry.plane.T
    on_plane(symmetry, out["wheel"], "g_X", "g_Y")
    out["load"]["M"] *= symmetry.moment
    out["friction"]["sigma"] *= symmetry.signs[2]
    return out


def map_motions(symmetry: Symmetry, motions: Table) -> Table:
    out = motions.copy()
    for name, sign, shift in symmetry.angles:
        out[name] = sign * motions[name] + shift
        out[f"{name}_dot"] *= sign
    on_plane(symmetry, out, "X_O", "Y_O")
    out["X_O"] += symmetry.move[0]
    out["Y_O"] += symmetry.move[1]
    return out


def map_dynamics(symmetry: Symmetry, dynamics: Table) -> Table:
    out = dynamics.copy()
    on_plane(symmetry, out, "X_O_ddot", "Y_O_ddot")
    out["lambda_"][:, :2] = dynamics["lambda_"][:, :2] @ symmetry.plane.T
    for name, sign, _ in symmetry.angles:
        out[f"{name}_ddot"] *= sign
    out["omega_z_dot"] *= symmetry.signs[2]
    out["tau"] *= symmetry.signs[2]
    return out


@FORMULATIONS
@pytest.mark.parametrize("symmetry", SYMMETRIES.values(), ids=SYMMETRIES.keys())
def test_the_equations_keep_the_symmetries_of_plane_wheel_and_time(
    formulation: eq.Formulation, symmetry: Symmetry
) -> None:
    scenes, motions = draw(21, None, False, ROWS)
    mapped = dynamics(formulation, map_scenes(symmetry, scenes), map_motions(symmetry, motions))
    before = dynamics(formulation, scenes, motions)
    expected = map_dynamics(symmetry, before)
    within(distance(mapped, expected, scenes), 5e-13, "error")
    wrong = map_scenes(symmetry, scenes)
    wrong["friction"]["sigma"] *= -1
    wrong["load"]["M"][:, 2] *= -1
    beyond(distance(dynamics(formulation, wrong, map_motions(symmetry, motions)), expected, scenes), 1, "error")


@FORMULATIONS
@pytest.mark.parametrize("kind", [eq.FRICTIONLESS, eq.ROLLING, eq.HELD])
def test_reversed_velocities_give_the_same_accelerations_under_the_same_moment(
    formulation: eq.Formulation, kind: int
) -> None:
    scenes, motions = draw(26, kind, False, ROWS)
    before = dynamics(formulation, scenes, motions)
    for rate in ("psi_dot", "theta_dot", "phi_dot"):
        motions[rate] *= -1
    within(distance(dynamics(formulation, scenes, motions), before, scenes), 1e-14, "error")
    motions["psi_dot"] *= -1
    beyond(distance(dynamics(formulation, scenes, motions), before, scenes), 4, "error")


@FORMULATIONS
def test_the_place_on_the_plane_does_not_matter(formulation: eq.Formulation) -> None:
    scenes, motions = draw(22, None, False, ROWS)
    before = dynamics(formulation, scenes, motions)
    motions["X_O"] += 1000
    motions["Y_O"] -= 0.1
    assert (dynamics(formulation, scenes, motions) == before).all()
    motions["psi"] += 1e-9
    assert (dynamics(formulation, scenes, motions) != before).any()


@FORMULATIONS
def test_with_equal_J_x_and_J_y_the_turn_phi_of_the_body_does_not_matter(
    formulation: eq.Formulation,
) -> None:
    scenes, motions = draw(23, None, True, ROWS)
    before = dynamics(formulation, scenes, motions)
    motions["phi"] += 0.7
    within(distance(dynamics(formulation, scenes, motions), before, scenes), 3e-13, "error")
    scenes["wheel"]["J_y"] *= 1 + 1e-6
    beyond(distance(dynamics(formulation, scenes, motions), before, scenes), 8e-7, "error")


@FORMULATIONS
def test_holding_is_a_moment_about_the_axle_like_any_other(formulation: eq.Formulation) -> None:
    scenes, motions = draw(25, eq.HELD, False, ROWS)
    held = dynamics(formulation, scenes, motions)
    scenes["friction"]["kind"] = eq.FRICTIONLESS
    scenes["load"]["M"][:, 2] += held["tau"]
    driven = dynamics(formulation, scenes, motions)
    driven["tau"] = held["tau"]
    within(distance(driven, held, scenes), 2e-13, "error")
    scenes["load"]["M"][:, 2] -= 2 * held["tau"]
    beyond(distance(dynamics(formulation, scenes, motions), held, scenes), 3, "error")
