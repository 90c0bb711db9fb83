"""Inputs: followed as polynomials over a step, felt at once, held where they arrived, and no restart without a jump.

The closed form used here is the upright wheel on a straight line (theta = 90 deg): M_3 turns it about the axle against
J_z + m (r_0 + r)^2, and F_X, F_Y, M_1, M_2 are balanced by nothing but the ground.
"""

from collections.abc import Callable
from itertools import combinations, product
from math import factorial

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import DERIVATIVES, DISCARD, ERROR, OK, STATES, FMU2Wheel, shifted
from wheelfmu.truth.scenes import AT_REST, PULLED

RHO = 0.35
INERTIA = 1.8 + 20 * RHO**2  # about the contact, kg m2
WEIGHT = 20 * 9.81


def cubic(t: float) -> list[float]:
    """The Taylor polynomial of 1 - 2 t + 3/2 t^2 - 1/4 t^3 about t; its integral over 2 s is 1."""
    return shifted([1.0, -2.0, 1.5, -0.25], t)


def sine(t: float) -> list[float]:
    """That of sin(2 t), whose integral over 2 s is (1 - cos 4) / 2."""
    return [2.0**k * np.sin(2 * t + k * np.pi / 2) / factorial(k) for k in range(4)]


def follow(w: FMU2Wheel, taylor: Callable[[float], list[float]], times: np.ndarray, order: int) -> float:
    """Drives with M_3, of which each step sees the Taylor polynomial of that order; J omega_z at the end."""
    for t, t_next in zip(times, times[1:], strict=False):
        w.give({"M_3": taylor(t)[: order + 1]}).to(t_next)
    return w.get("omega_z")[0] * INERTIA


@pytest.fixture
def upright(wheel) -> Callable[[], FMU2Wheel]:
    return lambda: wheel().start(tolerance=1e-12, M_3=1.0, **AT_REST)


@pytest.mark.parametrize("times", [[0, 2], np.linspace(0, 2, 21), [0, 0.1, 0.35, 1.2, 1.3, 2]], ids=len)
def test_a_cubic_input_is_followed_exactly_whatever_the_steps(upright, times):
    within(abs(follow(upright(), cubic, times, 3) - 1), 256 * EPSILON, "impulse, N m s")
    beyond(abs(follow(upright(), cubic, times, 2) - 1), 8e-6, "impulse without the cubic term, N m s")


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_a_smooth_input_is_followed_with_the_order_of_its_derivatives(upright, order):
    """Halving the step divides the error by 2^(order + 1)."""
    ends = [follow(upright(), sine, np.linspace(0, 2, steps + 1), order) for steps in (64, 128)]
    errors = np.abs(np.array(ends) - (1 - np.cos(4)) / 2)
    within(abs(np.log2(errors[0] / errors[1]) - (order + 1)), 0.1, "order of convergence off order + 1")


def test_a_polynomial_that_goes_on_is_no_restart_and_a_jump_is_one(upright):
    smooth, held = upright(), upright()
    for w, order in ((smooth, 3), (held, 0)):
        follow(w, cubic, np.linspace(0, 2, 21), order)
    assert smooth.get("n_restarts")[0] <= 1  # the bend at t = 0, where there is no history to keep
    assert held.get("n_restarts")[0] >= 19  # the first value is that of the start


def test_derivatives_hold_for_one_step_and_the_value_stays_where_it_arrived(upright):
    course = {"M_3": (1.0, 2.0, 4.0, -8.0)}
    w = upright().give(course)
    assert (w.get("M_3"), w.by(0.5).get("M_3")) == ([1.0], [2.0])
    reached = w.get("omega_z")[0]
    within(abs(reached - (0.5 + 1 / 4 + 1 / 6 - 1 / 8) / INERTIA), 16 * EPSILON, "omega_z reached, rad/s")
    assert w.by(0.5).get("M_3") == [2.0]
    waits = upright().give(course).by(0.0)  # a step of no length takes none of them away
    assert waits.by(0.5).get("M_3", "omega_z") == [2.0, reached]
    gained = w.get("omega_z")[0] - reached
    within(abs(gained - 0.5 * 2.0 / INERTIA), 16 * EPSILON, "omega_z gained, rad/s")
    beyond(abs(gained - 0.5 * 1.0 / INERTIA), 0.01, "omega_z gained from the first value, rad/s")
    blob = w.give({"M_3": (1.0, 4.0), "F_X": (4.0,)}).by(0.5).serialized()
    assert w.put(M_3=7.0).get("M_3", "F_X") == [7.0, 4.0]
    assert w.back(blob).get("M_3", "F_X") == [3.0, 4.0]


def test_an_input_rewritten_at_its_old_value_after_a_step_with_derivatives_jumps_back(upright):
    """A saw-tooth: the same value and slope at the start of each step."""
    w = upright()
    for _ in range(4):
        w.give({"M_3": (1.0, 2.0)}).by(0.5)
    within(abs(w.get("omega_z")[0] - 4 * (0.5 + 0.25) / INERTIA), 64 * EPSILON, "omega_z, rad/s")
    assert w.get("n_restarts") == [3]  # the first value is that of the start


def test_reactions_answer_an_input_before_the_step_and_the_motion_does_not(wheel, description):
    """The outputs that answer a load are those of the description; locals are not listed there."""
    w = wheel().start(s=0.03).by(0.5)
    locals_ = ("mu_required", "theta_ddot", "psi_ddot", "phi_ddot", "omega_z_dot")
    loads = {"F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3"}
    forces = {u.variable.name for u in description.outputs if loads & {v.name for v in u.dependencies}}
    assert {"lambda_3", "lambda_x", "tau", "tau_brake"} < forces and not forces & {*STATES, *DERIVATIVES[:5]}
    motion = [name for name in w.reals if name not in forces and name not in locals_]
    before, reactions = w.read(motion), w.get("lambda_1", "lambda_2", "lambda_3")
    w.put(F_X=1.0, F_Y=-2.0, F_Z=3.0, M_1=0.5, M_2=0.4, M_3=-0.3)
    at_once = np.array(w.get("lambda_1", "lambda_2", "lambda_3"))
    assert w.read(motion) == before
    within(np.max(np.abs(at_once - w.by(1e-9).get("lambda_1", "lambda_2", "lambda_3"))), 2e-6, "reactions, N")
    beyond(np.min(np.abs(at_once - reactions)), 0.06, "change by the inputs, N")
    assert w.read(motion) != before


# A guided wheel that slides has all of them.
SET = {"F_X": 5.0, "F_Y": -4.0, "F_Z": -30.0, "M_1": 0.4, "M_2": -0.3, "M_3": 2.0, "M_brake": 3.0}
ROAD_SET = {"s": 0.03, "mu_max": 0.35, "mu_slide": 0.25, "slope": 0.1, "slope_direction": 0.7}
RATES = {"psi_dot_guide": 1 / 3, "theta_dot_guide": 1 / 7}
TURNED = {"psi_dot_guide": 0.5, "theta_dot_guide": -0.2}
STEERED = {"guided": True, "psi_dot_start": 0.0, "theta_dot_start": 0.0, "theta_start": 1.3, "s": 0.02} | RATES
SLIDING = {"mu_max": 0.4, "mu_slide": 0.3, "slip_x_start": 1.0}
PAIRED = {
    "rolls": ({"s": 0.02, "mu_max": 9.0}, SET | {"s": 0.03, "mu_max": 8.0, "slope": 0.1, "slope_direction": 0.7}),
    "held": ({**AT_REST, "s": 0.02}, SET | {"s": 0.03, "slope": 0.1, "slope_direction": 0.7}),
    "slides": (SLIDING | {"slope": 0.05}, SET | ROAD_SET),
    "steered": (STEERED, SET | TURNED | {"s": 0.03}),
    "steered, slides": (STEERED | SLIDING, SET | ROAD_SET | TURNED),
}


@pytest.mark.parametrize("base", PAIRED)
def test_any_two_values_act_alike_in_either_order_and_not_at_all_where_they_are_taken_back(wheel, base):
    """Read at once, and after a step."""
    start, values = PAIRED[base]
    w = wheel().start(**start).by(0.1)
    saved, before = w.serialized(), w.bits()
    alone = w.by(0.05).bits()
    for pair in combinations(values, 2):
        found = []
        for order in (pair, pair[::-1]):
            w.back(saved)
            was = dict(zip(order, w.get(*order), strict=True))
            w.put(**{name: values[name] for name in order})
            found.append((w.bits(), w.by(0.05).bits()))
        assert found[0] == found[1], pair
        assert found[0][1] != alone, pair  # the partner
        w.back(saved).put(**{name: values[name] for name in order})
        w.bits()  # a reading under way is not kept
        assert (w.put(**was).bits(), w.by(0.05).bits()) == (before, alone), pair


STARTS = {
    "unfolded": {"psi_dot_start": 0.3},
    "guided": {"guided": True, "theta_start": 1.3, "psi_start": 0.0},
    "pulled": {**PULLED, "s": 0.01},
}


@pytest.mark.parametrize("base", STARTS)
def test_a_load_that_is_taken_back_before_the_first_step_was_never_set(wheel, base):
    """Not for what is computed, counted or warned of: without a load a wheel is unfolded and its grip not looked at."""

    def run(values: tuple[float, ...], name: str = "F_X") -> tuple[list[bytes], list[str]]:
        w = wheel().give({name: values}).start(**STARTS[base])
        return w.give({name: (0.0,)}).run([0.4, 0.8]), w.texts()

    never, loaded = run((0.0,)), wheel().start(**STARTS[base], F_X=1e-6)
    for name, order in product(SET, range(4)):
        assert run((0.0,) * order + (SET[name],), name) == never, (name, order)
    assert (loaded.run([0.4, 0.8]), loaded.texts()) != never  # the partner


@pytest.mark.parametrize("base", ["steered", "steered, slides"])
def test_a_jump_of_the_carrier_meets_the_road_and_the_loads_that_are_set_with_it(wheel, base):
    """As if they had been in force before; partner: they come after it."""
    start, values = PAIRED[base]
    w, jump, late = wheel().start(**start).by(0.1), {"psi_dot_guide": -1.0, "theta_dot_guide": 1.5}, {}
    saved, moved = w.serialized(), ("omega_z", "phi_dot", "slip_x", "slip_y", "X_O_dot", "Y_O_dot")
    for name in set(values) - set(jump):
        one = {name: 20 * values[name] if name == "s" else values[name]}
        together = w.back(saved).put(**jump, **one).get(*moved)
        before = w.back(saved).put(**one).by(0.0).put(**jump).get(*moved)
        within(absolute_error(together, before), 1e-9, f"rates apart with {name}")
        late[name] = absolute_error(together, w.back(saved).put(**jump).by(0.0).put(**one).get(*moved))
    beyond(late["s"], 1e-3, "rates apart where s comes after the jump")
    beyond(late.get("mu_slide", 1), 1e-3, "rates apart where mu_slide comes after the jump")


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("name", [*SET, *RATES])
def test_a_derivative_of_one_order_alone_moves_the_wheel(wheel, name, order):
    """As beside others that are next to nothing."""
    start = {**AT_REST, "guided": "guide" in name, "theta_start": 1.3, "phi_dot_start": -3.0, "s": 0.001}
    ends = []
    for alone in (0.0, 1e-200):
        w = wheel().start(**start)
        ends.append(w.give({name: [alone] * order + [2.0]}).by(0.3).get(*STATES))
    still = wheel().start(**start).by(0.3).get(*STATES)
    within(absolute_error(*ends), 1e-9, "states apart")
    beyond(absolute_error(ends[0], still), 1e-6, "states apart from those without the input")


@pytest.mark.parametrize("formulation", [2, 3])
def test_a_standing_wheel_with_friction_does_not_move_until_the_torque_beats_it(wheel, formulation):
    """|M_3| <= s N holds it; 2 N m/s from zero lets it go at s N / 2 seconds."""
    standing = wheel(logging=True).start(s=0.03, formulation=formulation, **AT_REST)
    limit = 0.03 * WEIGHT
    for torque in (0.999 * limit, -0.999 * limit, 0.0):
        assert standing.put(M_3=torque).by(0.5).get("friction_mode") == [0]
        assert standing.get("omega_z") == [0]
        within(abs(standing.get("X_O_dot")[0]), 128 * EPSILON, "velocity, m/s")  # theta starts off 90 deg by rounding
    t = standing.time
    standing.give({"M_3": (0.0, 2.0)}).by(4.0)
    release = float(standing.take_messages()[-1].text.split(" ")[2])
    assert release == round(t + limit / 2, 9)  # logged to the nanosecond
    spin = 2 * (4.0 - limit / 2) ** 2 / 2 / INERTIA
    within(abs(standing.get("omega_z")[0] - spin), 64 * EPSILON, "omega_z, rad/s")
    beyond(abs(standing.get("omega_z")[0] - 2 * 4.0**2 / 2 / INERTIA), 0.2, "omega_z without the friction, rad/s")


@pytest.mark.parametrize(("share", "releases"), [(1.05, True), (0.97, False)])
@pytest.mark.parametrize("rising", [True, False])
@pytest.mark.parametrize("middle", [0.3, 0.4, 0.5, 0.6, 0.7, 0.8])
def test_a_moment_that_swings_within_a_step_releases_the_wheel_where_it_beats_the_friction(
    wheel, middle, rising, share, releases
):
    """Nine tenths of s N at the ends of the step and in between; beside one of the two, its peak."""
    limit, h = 0.03 * WEIGHT, 0.05
    swing = np.polynomial.Polynomial.fromroots([0.0, middle * h, h]) * (1 if rising else -1)
    peak = max(swing(t.real) for t in swing.deriv().roots())
    course = (swing * ((share - 0.9) / peak) + 0.9) * limit
    w = wheel().start(s=0.03, **AT_REST).give({"M_3": tuple(course.coef)}).by(h)
    assert (w.get("n_events")[0] > 0) == releases


def test_a_held_wheel_stays_held_when_an_input_changes(wheel):
    """The friction answers the new torque at once, in both formulations, and does so without slip."""
    for formulation in (2, 3):
        w = wheel().start(s=0.03, formulation=formulation).by(1.26)
        assert w.get("friction_mode") == [0]  # stick lasts from 1.2255 s to 1.3298 s
        assert w.put(M_3=0.1).get("friction_mode") == w.by(0.001).get("friction_mode") == [0]
        within(abs(w.get("omega_z")[0]), 64 * EPSILON, "omega_z, rad/s")
        assert w.put(M_3=50.0).get("friction_mode") == [1]
        beyond(w.by(0.001).get("omega_z")[0], 1e-3, "omega_z of the released wheel, rad/s")


def ramp_and_hold(w: FMU2Wheel, h: float) -> tuple[float, int]:
    """Held by friction, over h with M_3 = 3 t: whether it was released, and the status of going on from there."""
    w.start(s=0.03, **AT_REST).give({"M_3": (0.0, 3.0)}).by(h)
    return w.get("n_events")[0], w.step(0.1)


def test_a_step_may_end_on_the_very_instant_of_a_release(wheel):
    """An event found at the stop time leaves that stop time behind; held inputs then go on without one."""
    early, late = 1.9, 2.0  # friction gives way at s m g / 3 = 1.962 s
    while np.nextafter(early, late) < late:
        middle = 0.5 * (early + late)
        released = ramp_and_hold(wheel(), middle)[0]
        early, late = (early, middle) if released else (middle, late)
    ends = early + np.spacing(early) * np.arange(-20, 20)
    logged = [ramp_and_hold(wheel(), h) for h in ends]
    assert {released for released, _ in logged} == {0, 1}  # the instant lies among them
    assert {status for _, status in logged} == {OK}  # with the stop time kept, 8 of the 40 ended in an error


@pytest.mark.parametrize("method", [2, 3])
def test_after_a_jump_a_varying_input_is_followed_over_steps_of_single_roundings(wheel, method):
    """Masters that add up their steps end with such ones; CVODE guesses no first step within two roundings of t."""
    for roundings in (1, 2, 3, 8):
        w = wheel().start(s=0.03, friction_law=2, method=method).by(0.25)
        w.give({"M_3": (1.0, 5.0)}).by(roundings * np.spacing(0.25))  # bdf failed at 1
        assert w.get("n_restarts") == [1]  # the partner: without the jump, 0
        w.by(0.25)


@pytest.mark.parametrize("values", [{}, {"s": 0.03}, {"formulation": 3}], ids=["free", "friction", "multibody"])
def test_an_input_may_change_again_after_a_step_of_single_roundings(wheel, values):
    """Masters that look for the instant of an event make such steps; no step can be as short as they are."""
    for roundings in (1, 2, 4, 9):
        w, once = (wheel().start(**values).by(1.0) for _ in range(2))
        w.put(M_3=0.5).by(roundings * np.spacing(1.0))
        ends = [instance.put(M_3=0.7).to(1.5).get("phi") for instance in (w, once)]
        within(absolute_error(*ends), 1e-8, "phi apart, rad")


def test_wrong_input_derivatives_are_refused_as_a_whole(wheel):
    w = wheel().start()
    before = w.serialized()
    force, mass, theta = w.refer("F_X", "m", "theta")

    def call(reference: int, order: int, value: float) -> int:
        return w.ask("SetRealInputDerivatives", [force, reference], 2, [1, order], [1.0, value])

    wrong = [(force, 0, 1.0), (force, 4, 1.0), (force, -1, 1.0), (force, 1, np.nan), (force, 1, np.inf)]
    for reference, order, value in [*wrong, (mass, 1, 1.0), (theta, 1, 1.0), (99, 1, 1.0)]:
        assert call(reference, order, value) == ERROR
        assert w.said().startswith("fmi2SetRealInputDerivatives: ")
    assert w.serialized() == before
    assert call(force, 3, 1.0) == OK and w.serialized() != before


# Of an input, its polynomial up to half the step and to its end, and what the message has of it.
PASSED: list[tuple[str, list[float], str]] = [
    ("M_brake", [0.0, 1.7e308, 8e307], "M_brake would become inf: it must be at most 1e+300."),
    ("F_X", [1e300, -4e299, 1e299], ""),
    ("F_X", [9e299, 4e299, -2e299], "F_X would become 1.1e+300: it must be at most 1e+300."),
    ("M_3", [0.0, -1.5e300, 1e300], ""),
    ("M_3", [0.0, -5e300, 5e300], "M_3 would become -1.25e+300: it must be at least -1e+300."),
    ("psi_dot_guide", [0.0, 1.1e7], "psi_dot_guide would become 11000000: it must be at most 10000."),
    ("psi_dot_guide", [0.0, 9e3], ""),
    ("theta_dot_guide", [-1e4, -1e-3], "theta_dot_guide would become -10000.001: it must be at least -10000."),
    ("M_brake", [1.0, -2.0], ""),
]


@pytest.mark.parametrize("ago", [0.0, 0.1])
@pytest.mark.parametrize(("name", "polynomial", "text"), PASSED)
def test_a_step_in_which_an_input_would_leave_its_bounds_is_refused_and_leaves_the_state(
    wheel, name, polynomial, text, ago
):
    """At its end or on the way; a brake that falls to zero stays there. The run has begun so long ago."""
    w = wheel().start(guided=True, psi_start=0.0, theta_start=1.5).by(ago).give({name: tuple(polynomial)})
    before = w.serialized()
    status = w.step(1.0)
    if not text:  # where a force is too large for a solver, that is another message
        assert not any("would become" in said for said in w.texts())
        assert name != "M_brake" or w.get(name) == [0.0]
        return
    assert status == ERROR and w.said() == f"fmi2DoStep by 1 s: {text}"
    assert w.serialized() == before and w.give({name: (0.0,)}).by(1.0).serialized() != before


def test_a_step_of_no_length_uses_no_derivative_up(wheel):
    """It neither brings an input beyond its bounds nor lets the next step do so."""
    for slope, status in ((9000.0, ERROR), (900.0, OK)):
        w = wheel().start(guided=True, psi_start=0.0, theta_start=1.5).by(0.1).give({"psi_dot_guide": (0.0, slope)})
        assert (w.by(0.0).step(10.0), w.get("psi_dot_guide")) == (status, [0.0 if status else 9000.0])


@pytest.mark.parametrize("name", ["M_brake", "F_Z", "psi_dot_guide", "theta_dot_guide"])
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("size", [0.5, -2.0, 3e4, 1.1e7, 1e301, 2e307])
def test_a_state_after_a_step_with_derivatives_of_any_size_is_taken(wheel, name, order, size):
    w = wheel().start(guided=True, s=0.01).give({name: (0.0,) * order + (size,)})
    w.step(0.5)
    blob = w.serialized()
    assert wheel().start().back(blob).serialized() == blob


def test_a_brake_below_zero_by_rounding_is_none(wheel):
    """By a millionth of the capacity, or of 1 N m: masters set so much less to form a difference quotient."""
    for capacity, less in ((0.0, 1e-6), (0.5, 1e-6), (300.0, 3e-4)):
        w = wheel().start(M_brake=capacity)
        assert w.put(M_brake=-less).get("M_brake") == [0.0]
        w.put(M_brake=capacity)
        assert w.set(M_brake=-1.01 * less) == DISCARD and w.get("M_brake") == [capacity]
    assert wheel().start(M_brake=-1e-7).get("M_brake") == [0.0]
