"""What a master changes and reads while the wheel slides: the road, the brake, states of two sizes."""

import resource
from ctypes import byref
from math import pi

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, WARNING
from wheelfmu.truth.sliding import HUB, ROAD, UPRIGHT

WEIGHT, g = 20 * 9.81, 9.81
LOCKED = {**UPRIGHT, **ROAD, "slip_x_start": 7.0, "M_brake": 1e3}


def test_a_road_on_which_a_slide_would_jam_is_warned_of_once_where_forces_are_read_and_ends_the_run(wheel) -> None:
    """The paper's wheel at 59 degrees jams above 1.451."""
    leaning = {"theta_start": 1.03, "slip_y_start": -5.0, "phi_dot_start": 0.0, "mu_max": 0.5, "mu_slide": 0.4}
    w = wheel().start(start=7.0, **leaning).to(7.01).put(mu_max=9.0, mu_slide=1.0)
    beyond(w.get("lambda_3")[0], 0, "normal force on a road that holds it, N")
    assert w.texts() == []
    w.put(mu_slide=8.0).get("mu_slide", "mu_max", "F_X")  # no force is read
    assert w.texts() == []
    N, *_ = w.get("lambda_3", "lambda_1", "theta_ddot")
    beyond(0, N, "nothing over the normal force on one that does not, N")
    text = "the wheel jams (Painleve's paradox) with mu_slide = 8"
    assert w.take_messages() == [(WARNING, "logStatusWarning", f"t = 7.01 s: {text}.")]
    assert w.step(0.01) == DISCARD and w.said().startswith(f"{text} at t = 7.01 s".replace("the", "The", 1))
    assert w.get("lambda_3") and w.texts() == []
    rolls = wheel().start(**{**HUB, "theta_start": 0.87}, mu_max=9.0, mu_slide=0.4).to(0.001).put(mu_slide=8.0)
    assert rolls.get("contact_mode") == [0] and rolls.get("lambda_3") and rolls.texts() == []


def test_the_forces_read_where_a_slide_begins_under_a_brake_are_those_that_follow(wheel) -> None:
    """The brake alone decides whether the spin is held, and with it the direction in which the slip begins."""
    pushed = {**UPRIGHT, "mu_max": 0.2, "mu_slide": 0.18, "F_X": 60.0, "F_Y": 70.0, "M_3": -9.0}
    names, modes = ("lambda_x", "lambda_y", "tau"), set()
    for brake in np.linspace(1, 80, 40):
        w = wheel().initializing(**pushed, M_brake=float(brake))
        before = w.get(*names)
        assert w.exitInitializationMode() == OK
        within(absolute_error(w.by(1e-6).get(*names), before), 1e-6, "forces, N, and moment, N m, apart")
        modes.add(tuple(w.get("contact_mode", "friction_mode")))
        w.close()
    assert modes == {(0, -1), (1, -1), (1, 0)}


def test_the_law_of_a_slide_that_begins_without_spin_is_searched_under_the_exact_law_alone(wheel) -> None:
    """Under it a wheel without spin is held or let go; else friction_mode is 0, the sign of its spin."""
    pushed = {**UPRIGHT, "mu_max": 0.06, "mu_slide": 0.05, "F_X": 60.0, "F_Y": 70.0, "M_3": -9.0}
    regularized = {"friction_law": 2, "omega_s": 0.1}
    laws = (({}, 0), ({"s": 0.03, **regularized}, 0), ({"M_brake": 0.1, **regularized}, 0), ({"s": 0.03}, -1))
    for law, mode in laws:
        w = wheel().initializing(**pushed, **law)
        assert w.get("friction_mode", "contact_mode") == [mode, 1]
        assert w.exitInitializationMode() == OK
        assert w.by(1e-3).get("n_events", "n_restarts") == [1, 0]
        w.close()


@pytest.mark.local  # sanitizers keep what is freed
def test_a_state_of_a_wheel_that_rolls_and_one_of_a_wheel_that_slides_take_each_others_place(wheel) -> None:
    """They differ in size; 20,000 alternations take no more memory than the first ones."""
    rolls, slides = wheel().start(**ROAD).to(0.3), wheel().start(**ROAD).to(0.7)
    assert [w.get("contact_mode") for w in (rolls, slides)] == [[0], [1]]
    ends = [wheel().back(w.serialized()).to(2.0).bits() for w in (rolls, slides)]
    other, state, size = wheel(), rolls.snapshot(), []
    for k in range(20000):
        assert (slides if k % 2 == 0 else rolls).ask("GetFMUstate", byref(state)) == OK
        if k in (999, 19999):
            size.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    within(size[1] - size[0], 500, "memory, kB")
    for w, end in ((slides, ends[1]), (rolls, ends[0]), (slides, ends[1])):
        assert w.ask("GetFMUstate", byref(state)) == OK
        assert other.ask("SetFMUstate", state) == OK
        other.time = w.time
        assert other.to(2.0).bits() == end
    other.free(state)


def test_states_saved_within_microseconds_of_a_passage_through_the_layer_go_on_with_the_same_bits(wheel) -> None:
    """omega_z of the paper's wheel passes the layer of a stiff law, 4e-5 rad/s wide, at 1.74 s, in 5e-6 s."""
    stiff = {"s": 0.03, "friction_law": 2, "omega_s": 1e-6}
    w, lo, hi = wheel().start(**stiff).to(1.7), 1.7, 1.8
    saved = w.serialized()
    while hi - lo > 1e-7:
        middle = 0.5 * (lo + hi)
        lo, hi = (middle, hi) if w.back(saved).to(middle).get("omega_z")[0] < 0 else (lo, middle)
    beyond(w.back(saved).to(1.8).get("omega_z")[0], 1e-3, "spin after the passage, rad/s")
    w.back(saved).to(t := hi - 1e-5)
    end = wheel().start(**stiff).to(2.5).get("theta", "psi", "X_O")
    for k in range(40):
        saved = w.to(t + 5e-7 * k).serialized()
        other = wheel().back(saved)
        assert other.to(2.5).bits() == wheel().back(saved).to(2.5).bits()
        assert other.get("theta", "psi", "X_O") == end
        other.close()


def test_fast_straight_rolling_stops_where_phi_alone_has_too_few_digits(wheel) -> None:
    w = wheel().start(theta_start=pi / 2, phi_dot_start=-1e4).to(1e7)
    assert w.get("psi", "psi_dot") == [w.get("psi_start")[0], 0.0]
    assert w.step(2e8) == ERROR and "too few digits" in w.sentences[-1]
    within(abs(w.get("phi")[0] / -1e11 - 1), 16 * EPSILON, "angle, relative")


def test_a_slide_that_the_loads_begin_at_the_start_counts_from_the_end_of_initialization_on(wheel) -> None:
    for torque, slides in ((-80.0, 1), (-8.0, 0)):
        w = wheel(logging=True).initializing(**UPRIGHT, mu_max=0.3, mu_slide=0.25, M_3=torque)
        assert w.get("contact_mode", "n_events") == [slides, 0]
        assert w.exitInitializationMode() == OK
        assert w.get("n_events") == [slides] and len(w.texts()) == slides


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_slip_that_passes_zero_where_the_road_cannot_hold_the_wheel_begins_anew_and_is_counted(wheel, side) -> None:
    """F_Y alone, against the slip at first, is beyond mu_max N; on a carrier nothing tips the wheel."""
    force = -80.0 * side
    w = wheel(logging=True).start(**UPRIGHT, guided=True, mu_max=0.3, mu_slide=0.25, slip_y_start=side, F_Y=force)
    t = 1 / ((80.0 + 0.25 * WEIGHT) / 20)
    w.take_messages()
    (before,) = w.get("n_events")
    assert w.by(0.9 * t).get("n_events") == [before] and w.texts() == []
    (slip,) = w.by(1.0).get("slip_y")
    beyond(-side * slip, 1, "slip to the other side, m/s")
    assert w.get("n_events") == [before + 1]
    assert w.said().endswith("the wheel slides in another direction.")


@pytest.mark.parametrize("chi", np.linspace(0.1, 6.2, 9))
def test_a_wheel_that_is_held_where_its_slip_ends_stays_held(wheel, chi) -> None:
    """By a brake hardly stronger than the friction of a slip in that direction: along its heading, that of most would
    turn it. Once it grips, no slip has any direction."""
    slip = {"slip_x_start": np.cos(chi), "slip_y_start": np.sin(chi)}
    brake = 0.25 * WEIGHT * 0.35 * (abs(np.cos(chi)) + 0.02)
    w = wheel(logging=True).start(**UPRIGHT, **slip, guided=True, mu_max=0.3, mu_slide=0.25, M_brake=brake)
    w.take_messages()
    assert w.by(1.0).get("contact_mode", "friction_mode") == [0, 0]
    assert w.said().endswith(": the wheel stops sliding.")  # alone: it has neither been let go nor held anew
