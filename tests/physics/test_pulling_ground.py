"""A ground that pulls, with rolling resistance: at N = 0 the law has a corner, and each such instant is an event.

Violent starts: two to eight times the rates of the paper's wheel, keep_contact, exact law. Judged by the reference,
which ends each mode at N = 0 too; errors relative to the range of each headline output. Regularized law: closed forms
of a guided wheel.
"""

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.truth.closed_forms import rolling_inertia
from wheelfmu.truth.errors import range_error
from wheelfmu.truth.motion import Library, Run, start_values
from wheelfmu.truth.reference import Start, Wheel
from wheelfmu.truth.scenes import Scene
from wheelfmu.truth.schedule import Schedule

TIMES = np.linspace(0, 2, 41)
WHEEL = Wheel(s=0.03)


def violent(seed: int) -> Start:
    random = np.random.default_rng(seed)
    times = random.uniform(2, 8)
    psi_dot, theta_dot = times * random.normal(0, (1, 0.7))
    rates = {"psi_dot": psi_dot, "theta_dot": theta_dot, "phi_dot": 2 * times * random.choice([-1, 1])}
    return Start(theta=random.uniform(0.6, np.pi - 0.6), **rates)


def motion(library: Library, start: Start, tolerance: float) -> Run:
    return library.simulate(TIMES, tolerance, keep_contact=True, **start_values(WHEEL, start))


def distance(one: Run, other: Run) -> float:
    rows = min(len(one.t), len(other.t)) - 1  # an ending is not a row of TIMES
    first, second = ({name: run[name][:rows] for name in HEADLINE} for run in (one, other))
    return range_error(first, second, HEADLINE)


def pulled(run: Run) -> bool:
    return bool((run["lambda_3"] < 0).any())


@pytest.mark.parametrize("seed", [3, 8, 9, 10])  # in the last three the ground pulls
def test_the_reference_goes_the_same_way(library: Library, seed: int) -> None:
    start = violent(seed)
    got = motion(library, start, 1e-11)
    scene = Scene({**start_values(WHEEL, start), "keep_contact": True})
    want, other = (scene.solved(TIMES[: len(got.t) - 1], rtol=1e-12, pulled=share) for share in (0, 1))
    within(distance(got, want), 1e-10, "distance from the reference / range")
    assert pulled(got) == (seed != 3)
    if pulled(got):
        beyond(distance(got, other), 1e-2, "distance with s |N| while the ground pulls / range")


# Upright on a wheel carrier: s, inputs, the instant from which rolling resistance has no moment, the rate of the spin
# then. A slide on ground that presses turns the wheel by mu N R.
MU, R, LIFT, TORQUE = 0.1, WHEEL.r_0 + WHEEL.r, 500.0, 0.01
SLIDES = {"slip_x_start": 3.0, "mu_max": MU, "mu_slide": MU, "omega_s": 1.0}
VANISHING = {
    "slides": (SLIDES, 0.003, Schedule(((0.0, {}), (0.15, {"F_Z": LIFT}))), 0.15, 0.0),
    "rolls": (
        {"phi_dot_start": 0.0, "omega_s": 1e-6},
        *(0.003, Schedule(((0.0, {}), (0.15, {"F_Z": LIFT, "M_3": TORQUE}))), 0.15, TORQUE / rolling_inertia(WHEEL)),
    ),
    "brake": (
        SLIDES,
        0.0,
        Schedule(((0.0, {"M_brake": (10.0, -50.0)}), (0.3, {}))),
        0.2,
        -MU * WHEEL.m * WHEEL.g * R / WHEEL.J_z,
    ),
}


@pytest.mark.parametrize("scene", VANISHING)
def test_a_regularized_law_is_solved_where_it_has_no_moment(library: Library, scene: str, formulation: int) -> None:
    start, s, inputs, since, expected = VANISHING[scene]
    law = {"friction_law": 2, "s": s, "keep_contact": True, "guided": True, "formulation": formulation}
    run = library.simulate([0, since, 0.4], 1e-8, inputs, theta_start=np.pi / 2, **start, **law)
    _, before, after = run["omega_z"]
    within(abs((after - before) / (0.4 - since) - expected), 1e-6, "rate of the spin, rad/s2")
    assert scene == "rolls" or run["contact_mode"][-1] == 1
