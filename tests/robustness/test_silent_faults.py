"""What no error and no wrong motion shows at once: pulls of the ground in the log, the digits of times and angles,
small changes of an input, and what a step that fails leaves behind."""

from math import pi

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within
from support.playing import play

from wheelfmu.fmu.driver import COUNTERS, ERROR, OK
from wheelfmu.truth.scenes import PAPER, PULLED

WEIGHT = PAPER.m * PAPER.g


def pulls_of(w):
    return [sentence for sentence in w.sentences if "pull" in sentence]


def instants_of_pulls(w):
    return [float(sentence.split(" = ")[1].split()[0]) for sentence in pulls_of(w)]


@pytest.mark.parametrize("method", [1, 2, 4], ids=["unfolded", "Adams", "stepped"])
def test_a_ground_that_pulls_often_is_logged_once_per_run_at_an_instant_that_no_grid_changes(wheel, method):
    logs = []
    for step in (0.25, 4.0, 100.0):
        w = wheel().start(method=method, **PULLED).to(*np.arange(step, 100.0 + step / 2, step))
        restored = wheel().back(w.serialized()).to(200.0)
        assert w.terminate() == w.reset() == OK and pulls_of(restored) == []
        logs.append(pulls_of(w))
        w.start(method=method, **PULLED).to(100.0)  # each in a new run
        assert pulls_of(w) == 2 * logs[-1]
    assert logs[0] == logs[1] == logs[2] and len(logs[0]) == 1


@pytest.mark.parametrize("phi_dot", [-2.0, -2e4])
def test_a_ground_that_pulls_by_rounding_alone_is_not_logged(wheel, phi_dot):
    """Without weight N is zero but for rounding."""
    w = wheel().start(g=0.0, keep_contact=True, formulation=3, phi_dot_start=phi_dot, theta_start=pi / 2)
    assert pulls_of(w.to(0.01, 0.1)) == []


def test_a_run_whose_orbit_is_built_where_the_ground_pulls_has_the_state_of_one_that_finds_it_built(wheel):
    """At its highest, where the orbit has been followed to, the ground pulls; at the start it presses."""
    start = {"theta_start": 0.2978, "psi_dot_start": -11.7446, "theta_dot_start": -4.4802, "phi_dot_start": 18.5632}
    w, states = wheel(), []
    for _ in range(2):
        states.append(w.start(keep_contact=True, **start).to(0.3, 1.0).serialized())
        assert w.terminate() == w.reset() == OK
    assert len(pulls_of(w)) == 2
    assert states[0] == states[1]


# Of a step of 1.3 units in the last place of the time a quarter is lost, of 1.6 a quarter is added, of 7.5 a fifteenth.
UNIT = float(np.spacing(1e9))
LOST = [(1e17, 1.0, ERROR), (1e17, 1e9, OK), (1e9, 1e-8, ERROR), (1e9, 10.0, OK)]
LOST += [(1e9, 1.3 * UNIT, ERROR), (1e9, 1.6 * UNIT, ERROR), (1e9, 7.5 * UNIT, OK), (1e9, 8.0 * UNIT, OK)]


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(("start", "step", "status"), LOST)
def test_a_step_that_is_lost_in_part_or_whole_in_the_rounding_of_time_is_refused(wheel, side, start, step, status):
    w = wheel().start(start=side * start)
    before = w.bits()
    assert w.ask("DoStep", side * start, step, 0) == status
    assert (w.bits() == before) == (status == ERROR)
    assert status == OK or "the step is lost in the rounding of the time" in w.sentences[-1]


@pytest.mark.parametrize("angle", ["psi", "phi"])
def test_a_step_past_the_digits_of_either_angle_is_refused(wheel, angle):
    """An upright wheel on its edge, and one that rolls straight: 1e12 rad at 9 rad/s."""
    w = wheel().start(theta_start=pi / 2, **{"phi_dot_start": 0.0, f"{angle}_dot_start": 9.0}).to(0.99e12 / 9)
    before = w.get("psi", "phi")
    assert w.step(0.02e12 / 9) == ERROR
    assert "too few digits" in w.sentences[-1] and w.get("psi", "phi") == before


def test_a_start_after_many_turns_does_not_shorten_how_far_a_free_wheel_goes(wheel):
    """Only what psi and phi turn from there on takes digits."""
    for far, status in ((1e5, OK), (1e12, ERROR)):
        assert wheel().start(psi_start=1e9, phi_start=-1e9).step(far) == status


def test_cuts_of_a_polynomial_at_a_late_start_time_are_no_changes(wheel):
    """At 1e9 s the times of the caller are rounded to 1e-7 s, and so are the values that it sets."""
    w = wheel().start(start=1e9, method=4, theta_start=pi / 2, phi_dot_start=-8.0)
    for k in range(20):
        w.give({"M_3": (1.0 + 3.0 * 0.03 * k, 3.0)}).to(1e9 + 0.03 * (k + 1))
    assert w.get("n_restarts") == [0]


def test_a_small_change_at_a_late_start_time_is_taken(wheel):
    """At 1e6 s, where times are rounded to 1e-10 s: the ramp goes on, higher by 1e-8 N."""
    ends = []
    for change in (0.0, 1e-8):
        w = wheel().start(start=1e6, theta_start=pi / 2, phi_dot_start=0.0).give({"F_Z": (0.0, 1.0)}).to(1e6 + 1.0)
        ends += w.give({"F_Z": (1.0 + change, 1.0)}).to(1e6 + 1.5).get("lambda_3")
    within(abs(ends[0] - ends[1] - 1e-8), 32 * WEIGHT * EPSILON, "change of lambda_3 off that of F_Z, N")


# ---- what a master sees of inputs between two steps, and of pulls ----


@pytest.mark.parametrize("order", [0, 1, 2, 3])
@pytest.mark.parametrize("method", [1, 2, 3, 4])
def test_a_small_change_of_the_value_or_of_one_derivative_alone_is_taken(wheel, method, order):
    """M_3 goes on with all else as it was."""
    ends = []
    for change in (0.0, 1e-6):
        shape = [0.3 + 0.1 + 0.025 + 0.00625, 0.2 + 0.1 + 0.0375, 0.1 + 0.075, 0.05]
        shape[order] += change
        w = wheel().start(theta_start=1.2, s=0.0, method=method).give({"M_3": (0.3, 0.2, 0.1, 0.05)}).to(0.5)
        ends += w.give({"M_3": shape}).to(1.0).get("phi_dot")
    beyond(abs(ends[1] - ends[0]), 1e-10, "change of phi_dot, rad/s")  # not taken: 0


@pytest.mark.parametrize("kind", [(2, 1, 0.03), (2, 2, 0.0), (3, 2, 0.0), (3, 4, 0.03)], ids=str)
def test_the_first_pull_is_logged_at_its_instant_and_none_that_an_input_prevents(wheel, kind):
    formulation, method, s = kind
    values = {"theta_start": pi / 2, "phi_dot_start": -8.0, "keep_contact": True, "formulation": formulation}
    w = wheel().start(method=method, s=s, **values)
    ramps = {0.0: 0.0, 0.1: WEIGHT / 0.025, 0.15: 0.0, 0.3: WEIGHT / 0.05, 0.4: 0.0}
    assert play(w, [(begin, {"F_Z": (0.0, ramp)}) for begin, ramp in ramps.items()], 0.5) == OK
    assert np.allclose(instants_of_pulls(w), [0.125], rtol=0, atol=1e-8)
    prevented = wheel().start(method=method, s=s, **values)
    for k in range(20):  # a ramp that would lift the wheel, taken back at every step
        prevented.give({"F_Z": (0.0, WEIGHT / 0.006)}).to(0.005 * (k + 1))
    assert instants_of_pulls(prevented) == []


def test_each_of_two_failures_has_its_own_message(wheel):
    """Of two runs of one instance: too many turns, then a force that no step follows."""
    w = wheel()
    before = w.start().serialized()
    for _ in range(2):
        assert w.back(before).step(1e14) == ERROR and "the angle has too few digits" in w.said()
        assert w.back(before).put(M_3=1e280).step(0.1) == ERROR
        assert "too few digits" not in w.said()


def test_a_step_that_fails_counts_nothing_and_the_counts_stay_when_the_run_is_closed(wheel):
    for values in ({}, {"s": 0.03}, {"s": 0.03, "friction_law": 2, "omega_s": 1e-6}):
        w = wheel().start(**values).to(1.5)
        counts = w.get(*COUNTERS)
        before = w.serialized()
        answer = w.put(M_3=1e280).get("omega_z_dot", "M_3")
        assert w.step(0.1) == ERROR and w.get(*COUNTERS) == counts
        assert w.get("omega_z_dot", "M_3") == answer and answer[0] > 1e270  # what was set still acts
        assert w.back(before).terminate() == OK and w.get(*COUNTERS) == counts
        beyond(wheel().start(**values).put(M_3=1.0).to(0.5).get("n_rhs")[0], 0, "evaluations")
