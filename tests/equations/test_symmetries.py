"""What leaves the answers unchanged, pointwise: reversed velocities, the place, a round body's turn, a holding moment.

The plane's and the wheel's symmetries are judged over whole motions, tests/physics/test_symmetries_fmu.py.
"""

import pytest
from support import equations as eq
from support.bounds import EPSILON, beyond, within

from equations.pointwise import distance, draw, dynamics

FORMULATIONS = pytest.mark.parametrize(
    "formulation", [eq.REDUCED, eq.EULER, eq.MULTIBODY], ids=["reduced", "Euler", "multibody"]
)
ROWS = 2000


@FORMULATIONS
@pytest.mark.parametrize("kind", [eq.FRICTIONLESS, eq.ROLLING, eq.HELD])
def test_reversed_velocities_give_the_same_accelerations_under_the_same_moment(
    formulation: eq.Formulation, kind: int
) -> None:
    scenes, motions = draw(26, kind, False, ROWS)
    before = dynamics(formulation, scenes, motions)
    for rate in ("psi_dot", "theta_dot", "phi_dot"):
        motions[rate] *= -1
    within(distance(dynamics(formulation, scenes, motions), before, scenes), 64 * EPSILON, "error")
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
def test_with_equal_J_x_and_J_y_the_turn_phi_of_the_body_does_not_matter(formulation: eq.Formulation) -> None:
    scenes, motions = draw(23, None, True, ROWS)
    before = dynamics(formulation, scenes, motions)
    motions["phi"] += 0.7
    # 1/sin(theta) is up to 20
    within(distance(dynamics(formulation, scenes, motions), before, scenes), 1024 * EPSILON, "error")
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
    within(distance(driven, held, scenes), 4096 * EPSILON, "error")  # two eliminations
    scenes["load"]["M"][:, 2] -= 2 * held["tau"]
    beyond(distance(dynamics(formulation, scenes, motions), held, scenes), 3, "error")
