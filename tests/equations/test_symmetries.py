"""What the plane, the wheel and the direction of time leave unchanged, pointwise.

Each symmetry maps scenes, motions and accelerations; the mapped answer must equal the answer to
the mapped question. Fixed axes for forces, carrier axes for moments. Partners break the map.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from support import equations as eq
from support.bounds import beyond, within

from equations import random_scenes

FORMULATIONS = pytest.mark.parametrize(
    "formulation", [eq.REDUCED, eq.EULER, eq.MULTIBODY], ids=["reduced", "Euler", "multibody"]
)
Table = np.ndarray


class Symmetry(NamedTuple):
    """plane: 2 x 2 on (X, Y); angles and rates: z -> sign z + shift; moment: signs of M_1..3.

    spin: sign of omega_z, sigma and tau.
    """

    plane: np.ndarray
    signs: tuple[int, int, int] = (1, 1, 1)  # of psi, theta, phi
    shifts: tuple[float, float, float] = (0, 0, 0)
    moment: tuple[int, int, int] = (1, 1, 1)
    spin: int = 1


def rotation(angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


SYMMETRIES = {
    "rotation about Z": Symmetry(rotation(0.7), shifts=(0.7, 0, 0)),
    "mirror Y -> -Y": Symmetry(np.diag([1, -1]), (-1, 1, -1), (np.pi, 0, 0), moment=(1, -1, -1), spin=-1),
    "axle named the other way": Symmetry(np.eye(2), (1, -1, -1), (np.pi, np.pi, np.pi), moment=(-1, 1, -1), spin=-1),
    "half a turn of the body": Symmetry(np.eye(2), shifts=(0, 0, np.pi)),
}


def on_plane(symmetry: Symmetry, table: Table, x: str, y: str) -> None:
    table[x], table[y] = symmetry.plane @ np.array([table[x], table[y]])


def map_scenes(symmetry: Symmetry, scenes: Table) -> Table:
    out = scenes.copy()
    out["load"]["F"][:, :2] = scenes["load"]["F"][:, :2] @ symmetry.plane.T
    on_plane(symmetry, out["wheel"], "g_X", "g_Y")
    out["load"]["M"] *= symmetry.moment
    out["friction"]["sigma"] *= symmetry.spin
    return out


def map_motions(symmetry: Symmetry, motions: Table) -> Table:
    out = motions.copy()
    for name, sign, shift in zip(("psi", "theta", "phi"), symmetry.signs, symmetry.shifts, strict=True):
        out[name] = sign * motions[name] + shift
        out[f"{name}_dot"] *= sign
    on_plane(symmetry, out, "X_O", "Y_O")
    return out


def map_dynamics(symmetry: Symmetry, dynamics: Table) -> Table:
    out = dynamics.copy()
    on_plane(symmetry, out, "X_O_ddot", "Y_O_ddot")
    out["lambda_"][:, :2] = dynamics["lambda_"][:, :2] @ symmetry.plane.T
    for name, sign in zip(("psi", "theta", "phi"), symmetry.signs, strict=True):
        out[f"{name}_ddot"] *= sign
    out["omega_z_dot"] *= symmetry.spin
    out["tau"] *= symmetry.spin
    return out


def dynamics(formulation: eq.Formulation, scenes: Table, motions: Table) -> Table:
    return eq.dynamics_each(formulation, scenes, eq.start_each(formulation, scenes, motions))


def draw(seed: int, kind: int | None = None, symmetric: bool = False) -> tuple[Table, Table]:
    random = np.random.default_rng(seed)
    scenes = random_scenes.scenes(random, kind, symmetric, 2000)
    return scenes, random_scenes.motions(random, 2000)


def error(found: Table, expected: Table) -> float:
    """Largest error of a row, relative to its accelerations or reactions."""
    groups = (expected.dtype.names[:3], expected.dtype.names[3:7], ("lambda_",))
    errors = []
    for names in groups:
        a, b = eq.columns(found, *names), eq.columns(expected, *names)
        errors.append((np.abs(a - b).max(axis=1) / np.abs(b).max(axis=1)).max())
    tau_size = np.abs(expected["tau"]) + np.abs(expected["lambda_"]).max(axis=1)
    errors.append((np.abs(found["tau"] - expected["tau"]) / tau_size).max())
    return float(max(errors))


@FORMULATIONS
@pytest.mark.parametrize("symmetry", SYMMETRIES.values(), ids=SYMMETRIES.keys())
def test_the_equations_keep_the_symmetries_of_plane_wheel_and_time(
    formulation: eq.Formulation, symmetry: Symmetry
) -> None:
    scenes, motions = draw(21)
    mapped = dynamics(formulation, map_scenes(symmetry, scenes), map_motions(symmetry, motions))
    before = dynamics(formulation, scenes, motions)
    expected = map_dynamics(symmetry, before)
    within(error(mapped, expected), 5e-13, "error")
    wrong = map_scenes(symmetry, scenes)
    wrong["friction"]["sigma"] *= -1
    wrong["load"]["M"][:, 2] *= -1
    beyond(error(dynamics(formulation, wrong, map_motions(symmetry, motions)), expected), 1, "error")


@FORMULATIONS
@pytest.mark.parametrize("kind", [eq.FRICTIONLESS, eq.ROLLING, eq.HELD])
def test_reversed_velocities_give_the_same_accelerations_under_the_same_moment(
    formulation: eq.Formulation, kind: int
) -> None:
    scenes, motions = draw(26, kind)
    before = dynamics(formulation, scenes, motions)
    for rate in ("psi_dot", "theta_dot", "phi_dot"):
        motions[rate] *= -1
    within(error(dynamics(formulation, scenes, motions), before), 1e-14, "error")
    motions["psi_dot"] *= -1
    beyond(error(dynamics(formulation, scenes, motions), before), 4, "error")


@FORMULATIONS
def test_the_place_on_the_plane_does_not_matter(formulation: eq.Formulation) -> None:
    scenes, motions = draw(22)
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
    scenes, motions = draw(23, symmetric=True)
    before = dynamics(formulation, scenes, motions)
    motions["phi"] += 0.7
    within(error(dynamics(formulation, scenes, motions), before), 3e-13, "error")
    scenes["wheel"]["J_y"] *= 1 + 1e-6
    beyond(error(dynamics(formulation, scenes, motions), before), 8e-7, "error")


@FORMULATIONS
def test_with_equal_J_x_and_J_y_the_moment_about_the_axle_does_not_change_N(
    formulation: eq.Formulation,
) -> None:
    def change_of_N(scenes: Table, motions: Table) -> float:
        before = dynamics(formulation, scenes, motions)["lambda_"]
        scenes["load"]["M"][:, 2] += 10
        change = dynamics(formulation, scenes, motions)["lambda_"][:, 2] - before[:, 2]
        return float((np.abs(change) / np.abs(before).max(axis=1)).max())

    scenes, motions = draw(24, eq.FRICTIONLESS, symmetric=True)
    within(change_of_N(scenes, motions), 2e-13, "change of N")
    scenes, motions = draw(24, eq.FRICTIONLESS)
    beyond(change_of_N(scenes, motions), 0.3, "change of N")  # J_x != J_y couples N to it


@FORMULATIONS
def test_holding_is_a_moment_about_the_axle_like_any_other(formulation: eq.Formulation) -> None:
    scenes, motions = draw(25, eq.HELD)
    held = dynamics(formulation, scenes, motions)
    scenes["friction"]["kind"] = eq.FRICTIONLESS
    scenes["load"]["M"][:, 2] += held["tau"]
    driven = dynamics(formulation, scenes, motions)
    driven["tau"] = held["tau"]
    within(error(driven, held), 2e-13, "error")
    scenes["load"]["M"][:, 2] -= 2 * held["tau"]
    beyond(error(dynamics(formulation, scenes, motions), held), 3, "error")
