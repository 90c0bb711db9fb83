"""method = automatic follows what is tuned: a regularized law that becomes stiff is solved by BDF from there on."""

import numpy as np
import pytest
from support.bounds import absolute_error, beyond, within

FRICTION = 0.03  # m


def counted(wheel, omega_s, tune):
    """Steps and Jacobians of ten seconds in which s is set by `tune`."""
    s = FRICTION if tune == "from the start" else 0.0
    w = wheel().start(friction_law="regularized", omega_s=omega_s, s=s)
    if tune == "before the first step":
        w.set(s=FRICTION)
    if tune == "during the run":
        w.to(0.5)
        w.set(s=FRICTION)
    w.to(10.0)
    return w.get("n_steps", "n_jac")


@pytest.mark.parametrize("tune", ["before the first step", "during the run"])
@pytest.mark.parametrize("omega_s", [1e-5, 1e-7])
def test_a_coefficient_that_is_tuned_later_costs_no_more_steps(wheel, omega_s, tune):
    steps, jacobians = counted(wheel, omega_s, "from the start")
    tuned, of_tuned = counted(wheel, omega_s, tune)
    within(tuned / steps, 1.1, "tuned")
    assert min(jacobians, of_tuned) > 0  # with the first choice kept, 36


def test_a_brake_that_grows_along_one_polynomial_makes_the_law_stiff(wheel):
    """The inputs do not change, only their values do."""
    w = wheel().start(friction_law="regularized", omega_s=1e-4)
    for k in range(40):
        w.give({"M_brake": (1e-6 + 2.0 * k, 20.0)}).to((k + 1) / 10)
    assert w.get("n_jac")[0] > 0
    loose = wheel().start(friction_law="regularized", omega_s=1.0).to(4.0)
    assert loose.get("n_jac") == [0]  # the partner: never stiff


WITHOUT_WEIGHT = {"g": 0.0, "omega_s": 1e-6}, {"M_brake": 30.0}, 1.0
PRESSED = {"s": FRICTION, "omega_s": 2e-3}, {"F_Z": -5e4}, 1.0
UPRIGHT = {"theta_start": np.pi / 2, **PRESSED[0]}, PRESSED[1], 0.1  # sticks soon, and has not fallen yet


@pytest.mark.parametrize(
    ("start", "inputs", "stop"), [WITHOUT_WEIGHT, PRESSED, UPRIGHT], ids=["brake without weight", "pressed", "upright"]
)
def test_the_moment_that_acts_decides_and_not_the_weight(wheel, start, inputs, stop):
    steps = []
    for method in ("automatic", "bdf"):
        w = wheel().start(friction_law="regularized", keep_contact=True, method=method, **start).put(**inputs).to(stop)
        steps.append(w.get("n_steps")[0])
    within(steps[0] / steps[1], 1.5, "steps over those of BDF where the moment acts")


@pytest.mark.parametrize("seed", range(40))
def test_a_law_that_becomes_stiff_inside_a_step_costs_what_bdf_costs_on_any_grid(played, seed):
    rng = np.random.default_rng(seed)
    start = {"phi_dot_start": rng.choice([-1, 1]) * rng.uniform(0.2, 4), "theta_start": rng.uniform(1.2, 1.9)}
    start |= {"s": rng.choice([0.0, 0.01]), "omega_s": 10 ** rng.uniform(-8, -3)}
    start |= {"tolerance": 10 ** rng.uniform(-9, -6), "friction_law": "regularized", "keep_contact": True}
    rise, bend = 10 ** rng.uniform(0, 1.3), rng.uniform(0, 2)

    def end(cuts=(), factor=1.0, **choices):
        brake = [(0.0, {"M_brake": (0.0, factor * rise, bend)})]
        return played(brake, 3.0, cuts, ("n_steps", "omega_z", "theta"), **start, **choices)

    bdf = end(method="bdf")
    for count in (0, 1, 30, 300):
        steps, *found = end(np.sort(rng.uniform(0, 3, count)))
        within((steps - count) / bdf[0], 1.5, "steps over those of BDF")  # an input that varies cuts at each point
        within(absolute_error(found, bdf[1:]), 1e-4, "difference to BDF")
    beyond(absolute_error(end(factor=1.01)[1:], found), 1e-6, "difference to a stronger brake")  # the partner
