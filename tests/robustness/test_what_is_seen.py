"""What a master sees of inputs between two steps, of pulls, of counts: small things that are easily lost."""

from math import pi

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within
from support.driver import OK
from support.scenes import PAPER
from support.schedule import play

WEIGHT = PAPER.m * PAPER.g


def rate_of(w):
    return w.rates(["lambda_3"])()[0]


def test_the_rate_of_a_reaction_follows_all_orders_of_the_input(wheel):
    """Upright, N = m g - F_Z: the rate of lambda_3 at the end of a step is that of the input, cubic term and all."""
    for order in (1, 2, 3):
        w = wheel().start(theta_start=pi / 2, phi_dot_start=0.0)
        shape = [0.0, 0.0, 0.0, 0.0]
        shape[order] = 50.0
        for k in range(2):  # the second step goes on along the same polynomial
            w.give({"F_Z": shape}, 0.5 * k)
            within(abs(rate_of(w) + 50.0 * order * (0.5 * k) ** (order - 1)), 64 * 50 * EPSILON, "rate of")
            w.to(0.5 * (k + 1))


def test_a_derivative_that_is_set_is_seen_at_once(wheel):
    w = wheel().start(theta_start=pi / 2, phi_dot_start=0.0).to(0.1)
    assert rate_of(w) == 0
    assert w.set_input_derivatives(["F_Z"], [[7.0]]) == OK
    within(abs(rate_of(w) + 7.0), 64 * 7 * EPSILON, "rate of")
    assert w.set_input_derivatives(["F_Z"], [[0.0]]) == OK
    assert rate_of(w) == 0


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("method", [1, 2, 3, 4])
def test_a_change_of_one_derivative_alone_is_taken(wheel, method, order):
    """M_3 goes on with the same value and the same other derivatives."""
    ends = []
    for change in (0.0, 1e-3):
        shape = [0.3 + 0.1 + 0.025 + 0.00625, 0.2 + 0.1 + 0.0375, 0.1 + 0.075, 0.05]
        shape[order] += change
        w = wheel().start(theta_start=1.2, s=0.0, method=method).give({"M_3": (0.3, 0.2, 0.1, 0.05)}).to(0.5)
        ends += w.give({"M_3": shape}).to(1.0).get("phi_dot")
    beyond(abs(ends[1] - ends[0]), 1e-6, "ends")


def test_a_small_change_of_a_value_is_taken(wheel):
    ends = []
    for torque in (1.0, 1.0 + 1e-6):
        w = wheel().start(theta_start=pi / 2, phi_dot_start=0.0, method=2)
        ends += w.put(M_3=1.0).to(0.5).put(M_3=torque).to(1.0).get("phi_dot")
    assert ends[1] > ends[0]


def pulls(w):
    return [float(m.split(" = ")[1].split()[0]) for m in w.sentences if "pulls" in m]


@pytest.mark.parametrize("kind", [(2, 1, 0.03), (2, 2, 0.0), (3, 2, 0.0), (3, 4, 0.03)], ids=str)
def test_each_pull_is_logged_at_its_instant_and_none_that_an_input_prevents(wheel, kind):
    formulation, method, s = kind
    values = {"theta_start": pi / 2, "phi_dot_start": -8.0, "keep_contact": True, "formulation": formulation}
    w = wheel().start(method=method, s=s, **values)
    ramps = {0.0: 0.0, 0.1: WEIGHT / 0.025, 0.15: 0.0, 0.3: WEIGHT / 0.05, 0.4: 0.0}
    assert play(w, [(begin, {"F_Z": (0.0, ramp)}) for begin, ramp in ramps.items()], 0.5) == OK
    assert np.allclose(pulls(w), [0.125, 0.35], rtol=0, atol=1e-8)
    prevented = wheel().start(method=method, s=s, **values)
    for k in range(20):  # a ramp that would lift the wheel, taken back at every step
        prevented.give({"F_Z": (0.0, WEIGHT / 0.006)}).to(0.005 * (k + 1))
    assert pulls(prevented) == []


def test_a_ground_that_pulls_from_the_start_is_logged_once_by_the_unfolded_wheel_too(wheel):
    """A wheel that tips fast is off the ground at once; unfolded (method automatic) or stepped through, seven pulls."""
    fast = {"theta_start": 1.48, "psi_dot_start": -1.52, "theta_dot_start": -6.5, "phi_dot_start": 4.4}
    logged = []
    for method in (1, 1, 2, 4):
        w = wheel().start(keep_contact=True, method=method, **fast)
        steps = 1 if logged else 20  # twice unfolded: whatever the steps
        assert [w.step(2.0 / steps) for _ in range(steps)] == [OK] * steps
        logged.append(pulls(w))
    assert logged[0][0] == 0.0 and len(logged[0]) == 7
    for other in logged[1:]:
        within(absolute_error(other, logged[0]), 2e-8, "other")


def test_a_polynomial_that_takes_the_brake_below_zero_takes_it_off(wheel):
    """A brake cannot push: M_brake = 1 - 10 t is none from 0.1 s on, and a wheel without a torque then rolls freely."""
    braked, off = (wheel().start(theta_start=pi / 2, phi_dot_start=-8.0) for _ in range(2))
    braked.give({"M_brake": (1.0, -10.0)}).to(1.0)
    off.give({"M_brake": (1.0, -10.0)}).to(0.1).give({"M_brake": (0.0,)}).to(1.0)
    within(abs(braked.get("phi_dot")[0] - off.get("phi_dot")[0]), 2e-7, "phi_dot")
    assert off.get("phi_dot")[0] > -8.0


def test_a_derivative_lasts_for_one_step(wheel):
    w = wheel().start(theta_start=pi / 2, phi_dot_start=0.0).give({"F_Z": (0.0, 10.0)}).to(1.0, 2.0)
    assert w.get("F_Z") == [10.0]
    within(abs(w.get("lambda_3")[0] - (WEIGHT - 10.0)), 64 * WEIGHT * EPSILON, "lambda_3")


def test_a_brake_that_is_set_stops_the_wheel_though_nothing_braked_before(wheel):
    w = wheel().start(theta_start=pi / 2, phi_dot_start=-1.0).to(0.5).put(M_brake=20.0).to(3.0)
    assert w.get("n_events") == [1]
    within(abs(w.get("phi_dot")[0]), 64 * EPSILON, "phi_dot")


def test_a_sensitivity_belongs_to_the_friction_that_was_just_set(wheel):
    """d tau / d F_Z: the friction moment is s N."""
    w = wheel().start(theta_start=1.2, phi_dot_start=-5.0, s=0.05).to(0.1)
    known, unknown = [w.references["F_Z"]], [w.references["tau"]]
    for s, least in ((0.05, 1e-3), (0.0, 0.0), (0.1, 2e-3)):
        w.set(s=s)
        slope = w.getDirectionalDerivative(unknown, known, [1.0])[0]
        ends = []
        for force in (1.0, 0.0):
            w.set(F_Z=force)
            ends += w.get("tau")
        within(abs(slope - (ends[0] - ends[1])), 64 * 10 * EPSILON, "slope")  # moments of 10 N m
        assert abs(slope) >= least  # the partner: they differ by far more than that bound


@pytest.mark.parametrize("method", [1, 3])
def test_counts_are_the_same_after_a_return(wheel, method):
    """Of a run that goes back to its start, and of one that never left it; the Jacobians of a new start too."""
    counts = []
    for returns in (False, True):
        w = wheel().start(friction_law=2, s=0.03, omega_s=1e-5, method=method)
        before = w.serialized()
        if returns:
            w.to(1.4).back(before)
        w.to(2.0)  # the wheel has stuck: there automatic takes BDF
        counts.append(w.get("n_steps", "n_rhs", "n_jac", "n_restarts"))
    assert counts[0] == counts[1] and counts[0][2] > 0
