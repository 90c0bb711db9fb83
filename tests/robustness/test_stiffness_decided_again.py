"""method = automatic follows what is tuned: a regularized law that becomes stiff is solved by BDF from there on."""

import pytest
from support.bounds import within

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


WITHOUT_WEIGHT = {"g": 0.0, "omega_s": 1e-6}, {"M_brake": 30.0}
PRESSED = {"s": FRICTION, "omega_s": 2e-3}, {"F_Z": -5e4}


@pytest.mark.parametrize(("start", "inputs"), [WITHOUT_WEIGHT, PRESSED], ids=["brake without weight", "pressed"])
def test_the_moment_that_acts_decides_and_not_the_weight(wheel, start, inputs):
    steps = []
    for method in ("automatic", "bdf"):
        w = wheel().start(friction_law="regularized", keep_contact=True, method=method, **start).put(**inputs).to(1.0)
        steps.append(w.get("n_steps")[0])
    assert steps[0] < 1.5 * steps[1]
