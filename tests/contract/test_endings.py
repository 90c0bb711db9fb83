"""How a run ends, flat on the ground or lifted off: Discard, the instant, the outputs there, and nothing goes on."""

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.driver import DISCARD, DO_STEP_STATUS, ERROR, LAST_SUCCESSFUL_TIME, OK, TERMINATED, WARNING, FMU2Wheel
from wheelfmu.truth.scenes import PAPER, THETA_0
from wheelfmu.truth.sliding import gripping_torque

DROP = {"theta_start": THETA_0, "phi_dot_start": 0.0}  # let go at rest
LIFT = {"F_Z": 250.0}  # more than the weight
HINT = "F_Z > 0 lifts the wheel; a load on it is a negative F_Z."


def ended(w: FMU2Wheel) -> float:
    """The instant at which the run ended, after a check of all that a master can ask for."""
    assert (w.status(DO_STEP_STATUS), w.status(TERMINATED)) == (DISCARD, 1)
    assert np.isfinite(w.get(*(name for name in w.reals if name != "mu_required"))).all()  # infinite where N vanishes
    return w.status(LAST_SUCCESSFUL_TIME)


def test_the_end_does_not_depend_on_the_communication_grid(wheel):
    at_once, in_steps = wheel().start(**DROP), wheel().start(**DROP)
    assert at_once.step(10.0) == DISCARD
    while (status := in_steps.step(0.01)) == OK:
        pass
    assert (status, in_steps.time) == (DISCARD, pytest.approx(0.59))
    assert ended(at_once) == ended(in_steps)
    assert at_once.bits() == in_steps.bits()
    assert at_once.bits() != wheel().start(**DROP).run([0.59])[0]


@pytest.mark.parametrize(("values", "what"), [(DROP, "lies flat"), (LIFT, "lifted off the road")])
def test_an_ending_is_logged_with_every_digit_of_its_instant_and_no_later_step_is_answered_with_ok(wheel, values, what):
    w = wheel().start(start=0.1, **values)
    assert w.step(10.0) == DISCARD
    end, bits = ended(w), w.bits()
    logged = f"{what} at t = {np.format_float_positional(end, trim='-')} s"  # the shortest decimal that is this number
    *hints, message = w.take_messages()
    assert [hint.text for hint in hints] == ([HINT] if "F_Z" in values else [])
    assert (message.status, message.category) == (WARNING, "logStatusDiscard")
    assert message.text == f"The wheel {logged}, theta = {w.get('theta')[0]:.6g} rad: the run ends there."
    w.time = end
    for h in (0.0, 1e-300, 1e-12, 0.1, 1e6):
        assert w.step(h) == ERROR
        assert w.said() == f"fmi2DoStep: the wheel {logged}. Restore a state or reset."
    assert w.set(s=0.01) == ERROR and what in w.said()
    for leaving in (lambda: OK, w.terminate):
        assert leaving() == OK
        assert (w.bits(), w.status(TERMINATED), w.status(LAST_SUCCESSFUL_TIME)) == (bits, 1, end)
    assert w.reset() == OK
    assert w.start().run([2.0]) == wheel().start().run([2.0])


@pytest.mark.parametrize("values", [{}, {"s": 0.03}], ids=["unfolded", "stepped"])
def test_a_terminated_wheel_is_read_where_it_stopped(wheel, values):
    read, unread = (wheel().start(**values).by(1.0) for _ in range(2))
    want = read.bits()
    assert unread.terminate() == OK and unread.bits() == want


def test_a_wheel_pulled_up_lifts_off_where_the_normal_force_vanishes(wheel):
    """F_Z grows by 30 N/s against the weight of 196.2 N; the wheel's own motion shifts the instant."""
    w, before, kept = (wheel().start(keep_contact=k).give({"F_Z": (0.0, 30.0)}) for k in (0, 0, 1))
    assert w.step(10.0) == DISCARD
    t = ended(w)
    within(abs(w.get("lambda_3")[0]), 3e-6, "normal force, N")
    hint, ending = w.texts()
    assert hint == HINT and "lifted off" in ending
    beyond(before.by(t - 0.01).get("lambda_3")[0], 0.1, "normal force before, N")
    assert kept.by(t + 0.2).get("lambda_3")[0] < 0  # the partner: the ground pulls


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-10])
def test_a_wheel_off_the_ground_at_the_start_ends_there_however_soon_it_would_be_pressed_again(wheel, tolerance):
    """The force is back long before the solver's first step ends: both its ends, or its end alone, tell nothing."""
    motion = {"theta_start": 1.0, "psi_dot_start": 6.0, "theta_dot_start": 4.0, "phi_dot_start": 2.0}
    w, kept = (wheel().start(tolerance=tolerance, keep_contact=k, **motion).put(F_Z=-10.5) for k in (0, 1))
    within(abs(w.get("lambda_3")[0] + 2.5), 0.5, "normal force at the start + 2.5 N, N")
    beyond(kept.by(0.005).get("lambda_3")[0], 5, "normal force soon after, N")
    assert w.step(0.1) == DISCARD
    assert ended(w) == 0
    wheel().start(tolerance=tolerance, **motion).put(F_Z=-15.0).by(0.1)  # the partner: N = 0.7 N at the start


ROLLING = {"theta_start": np.pi / 2, "phi_dot_start": -60.0}
FULL = gripping_torque(PAPER, 1.0)  # N m: an upright wheel that brakes so requires lambda_x = N


def onto(w: FMU2Wheel, mu_max: float, before: float) -> FMU2Wheel:
    """A wheel that requires 0.5 rolls onto another road after 0.25 s."""
    return w.start(mu_max=before, **ROLLING).put(M_brake=FULL / 2).to(0.25).put(mu_max=mu_max)


def test_a_road_that_becomes_too_slippery_ends_the_run_at_once_and_one_with_the_grip_does_not(wheel):
    for before in (0.0, 0.9):
        w = onto(wheel(), 0.3, before)
        w.take_messages()
        assert (w.step(0.01), w.status(LAST_SUCCESSFUL_TIME)) == (DISCARD, 0.25)
        assert "needs a friction coefficient above mu_max = 0.3 at t = 0.25 s" in w.said()
    w = onto(wheel(), 0.6, 0.9)
    assert (w.step(0.5), w.status(TERMINATED)) == (OK, 0)
    w.put(M_brake=0.62 * FULL)
    before = w.serialized()
    assert w.step(0.01) == DISCARD and "mu_max = 0.6" in w.said()
    for mu_max in (0.7, 0.0):  # a limit that is raised or taken away in time ends nothing
        assert w.back(before).put(mu_max=mu_max).step(0.01) == OK


def test_a_limit_set_between_steps_is_that_of_a_run_which_had_it_from_the_start(wheel):
    """In a brake that grows: the same instant, in one step or many."""
    always = wheel().start(mu_max=0.8, **ROLLING).give({"M_brake": (0.0, FULL)})
    assert always.step(2.0) == DISCARD
    w = wheel().start(**ROLLING).give({"M_brake": (0.0, FULL)}).by(0.3)
    w.put(mu_max=0.8).give({"M_brake": (0.3 * FULL, FULL)})
    while (status := w.step(0.05)) == OK:
        w.give({"M_brake": (w.time * FULL, FULL)})
    assert status == DISCARD
    within(abs(ended(w) - ended(always)), 32 * EPSILON, "instants apart, s")
    within(abs(ended(always) - 0.8), 3e-11, "instant off 0.8, s")


def test_an_unfolded_wheel_takes_another_limit_and_ends_where_it_requires_more(wheel):
    """The paper's free wheel requires 0.3 after 0.35 s for the first time."""
    always, later, never = wheel().start(mu_max=0.3), wheel().start().to(0.2), wheel().start().to(0.2)
    assert always.step(1.0) == later.put(mu_max=0.3).step(1.0) == DISCARD
    assert never.step(1.0) == OK
    within(abs(ended(later) - ended(always)), 3e-9, "instants apart, s")


@pytest.mark.parametrize("weights", [1.5, 500.0])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-13])
@pytest.mark.parametrize("start", [{"guided": True}, {"s": 0.003}, {"friction_law": 2, "s": 0.003}], ids=str)
@pytest.mark.parametrize("formulation", [2, 3])
def test_a_jump_of_the_force_that_lifts_a_wheel_is_no_loss_of_grip(wheel, formulation, start, tolerance, weights):
    road = {"mu_max": 0.5, "mu_slide": 0.5, "formulation": formulation}
    w = wheel(logging=True).start(tolerance=tolerance, **road, **start).to(0.2)
    w.take_messages()
    assert w.put(F_Z=weights * 196.2).step(0.1) == DISCARD
    hint, ending = w.texts()
    assert hint == HINT and ending.startswith("The wheel lifted off the road at t = 0.2 s")
    assert w.get("contact_mode") == [0]
