"""The reference of the sliding wheel judged where a slide begins, turns, or jams, and by another derivation's numbers.

Every bound has a partner that breaks a law or a parameter, and must exceed the bound.
"""

from dataclasses import replace
from math import hypot, sqrt

import numpy as np
import pytest
from support.bounds import absolute_error, beyond, within

from wheelfmu.truth.reference import Inputs, Road, Start, Wheel, solve
from wheelfmu.truth.reference.model import Options
from wheelfmu.truth.reference.modes import SLIDES, Contacts, Mode
from wheelfmu.truth.reference.motion import initial_state
from wheelfmu.truth.reference.sliding_contact import resting_directions
from wheelfmu.truth.sliding import SLIDES as SCENES
from wheelfmu.truth.sliding import jamming

PAPER = Wheel()


def lost(road: Road) -> float:
    """The instant at which the paper's wheel begins to slide."""
    return next(t for t, slides in solve(PAPER, Start(), [0.0, 1.0], road=road).contacts if slides)


@pytest.mark.parametrize(("mu_slide", "power"), [(0.4, 2), (0.36, 1)])
def test_slip_grows_with_time_or_where_the_coefficients_are_equal_with_its_square(mu_slide: float, power: int) -> None:
    road = Road(0.4, mu_slide)
    t = lost(road)
    got = solve(PAPER, Start(), [0.0, t + 1e-5, t + 2e-5], road=road)
    slip = np.hypot(got["slip_x"], got["slip_y"])
    within(abs(np.log2(slip[2] / slip[1]) - power), 1e-3, "power of the slip's growth off that stated")
    beyond(abs(np.log2(slip[2] / slip[1]) - (3 - power)), 0.9, "power of the slip's growth off the other")


def test_a_wheel_that_cannot_grip_slides_on_in_another_direction() -> None:
    """A long roller: the slip reaches zero where grip needs more than mu_max, and grows again from there."""
    scene = SCENES["turns at once"]
    got = scene.solved()
    (t, first), (again, second) = got.contacts
    assert (t, first, second) == (0.0, 1, 1) and 0 < again < 0.01
    near = scene.solved([0.0, again - 1e-7, again + 1e-7])
    speed = np.hypot(near["slip_x"], near["slip_y"])[1:]
    turned = np.arctan2(near["slip_y"], near["slip_x"])[1:]
    within(speed.max(), 1e-5, "slip within 1e-7 s of its zero, m/s")
    beyond(abs(np.angle(np.exp(1j * (turned[1] - turned[0])))), 0.5, "turn of the slip, rad")
    able = replace(scene, start={**scene.start, "mu_max": 5.0})
    assert able.solved([0.0, 0.05]).contacts[1][1] == 0


def test_friction_jams_a_wheel_that_it_rights_where_no_normal_force_is_left() -> None:
    scene = SCENES["jams"]
    got, wheel = scene.solved(), scene.wheel
    assert got.ended and got.ended.kind == "jams"
    across = -got["lambda_y"][-1] / got["lambda_3"][-1]  # of mu: the slip turns, too
    within(abs(-across / jamming(wheel, got["theta"][-1]) - 1), 5e-11, "coefficient across, relative")
    beyond(got["lambda_3"][-1] / (wheel.m * wheel.g), 1e6, "normal force over the weight")
    least = 2 * sqrt(0.05 * 1.05)  # of a thin wheel with J_x = 0.05 m r_0^2
    below = replace(scene, start={**scene.start, "mu_max": least, "mu_slide": least})
    assert below.solved([0.0, 0.2]).ended is None


def test_usual_wheels_have_one_direction_to_start_in() -> None:
    """J_x = J_y <= J_z: no state with mu |dN/df| < 1 has two roots that draw neighbours in and let the slip grow."""
    random, counts = np.random.default_rng(5), []
    for _ in range(200):
        J_z = random.uniform(0.4, 1.8)
        J = J_z * random.uniform(0.5, 1)
        wheel = Wheel(r=random.uniform(0, 0.1), J_x=J, J_y=J, J_z=J_z)
        motion = dict(zip(("psi_dot", "theta_dot", "phi_dot"), random.normal(0, 3, 3), strict=True))
        mu = random.uniform(0.1, 0.8)
        y = initial_state(wheel, Start(theta=random.uniform(0.5, 2.6), **motion))
        found = Contacts(wheel, Road(mu, mu), Inputs(), Options()).sliding_at(Mode(SLIDES, 1, 1), y)
        X, Y = found.grip()
        N = found.at(X, Y)[6]
        if N <= 0 or found.base[6] <= 0 or mu * hypot(found.by_X[6], found.by_Y[6]) >= 1 or hypot(X, Y) < mu * N:
            continue
        roots = resting_directions(found, mu)
        grows = [chi for chi in roots if found.push(mu, chi).grow > 0]
        counts.append((len(grows), sum(found.turning(mu, chi) < 0 for chi in grows), len(roots)))
    assert len(counts) > 40 and {count[:2] for count in counts} == {(1, 1)}
    assert max(count[2] for count in counts) == 4  # others arrive


def test_the_papers_wheel_slides_when_another_derivation_has_it_slide() -> None:
    got = SCENES["paper's wheel"].solved()
    assert [mode for _, mode in got.contacts] == [0, 1, 0, 1, 0]
    found = [t for t, _ in got.contacts[1:]]
    within(absolute_error(found, [0.57083, 0.955, 1.87418, 2.19016]), 6e-6, "instants of loss and return of grip, s")
    within(abs(got["E"][-1] - 66.557), 6e-4, "energy that is left, J")
    beyond(abs(lost(Road(0.451, 0.4)) - 0.57083), 1e-4, "instant of the loss with another mu_max, s")
