"""Derivatives: of outputs in time, of outputs by inputs, of the start by parameters; against differences of the FMU."""

import re
from collections.abc import Sequence
from ctypes import c_double

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within
from support.differences import LOADS, difference, outputs, rate_errors, rates

from wheelfmu.fmu.driver import DISCARD, ERROR, LAST_SUCCESSFUL_TIME, OK, Array, FMU2Wheel, Values
from wheelfmu.truth.scenes import AT_REST, GENERAL, KINDS
from wheelfmu.truth.sliding import ROAD, SLIDES, THROWN

STEERED: Values = {**GENERAL, "guided": True, "theta_start": 1.2, "phi_dot_start": -8.0, "s": 0.01}
SLIPS: Values = {"mu_max": 0.3, "mu_slide": 0.25, "slip_x_start": 2.0, "slip_y_start": -1.0}
SCENES = KINDS | {"steered": STEERED, "steered, slides": {**STEERED, **SLIPS}}
TURN = {"psi_dot_guide": (0.4, 2.0, -1.5, 0.7), "theta_dot_guide": (-0.3, 0.5, 0.8, -0.6)}


def push(w: FMU2Wheel, slope: float) -> None:
    w.give({name: (0.3 * (k + 1), slope * (1 - 0.4 * k), 0.2 * k, -0.1) for k, name in enumerate(LOADS)})


@pytest.mark.parametrize("scene", SCENES)
def test_output_derivatives_are_those_of_the_motion(wheel, scene):
    """Left alone, under inputs that jump, and under inputs with a slope, which the rates of the reactions contain."""
    w = wheel().start(tolerance=1e-12, **SCENES[scene])
    if SCENES[scene] is not KINDS.get(scene):
        w.give(TURN)
    for t in (0.25, 0.9, 2.8) if scene in KINDS else (0.0, 0.01):  # no transition of the friction within 12 ms
        blob = w.to(t).serialized()
        for slope in (None, 0.0, 5.0):
            if scene not in KINDS:
                w.give(TURN, since=t)
            if slope is not None:
                push(w, slope)
            within(rate_errors(w), 2e-7, "rate off the difference, relative")
            found = rates(w)
        push(w, 5.001)  # the partner: another slope of the inputs is seen in the reactions
        beyond(np.max(np.abs(rates(w) - found) / (1 + np.abs(found))), 2e-7, "rate under another slope, relative")
        w.back(blob)


PUSH = {"F_Y": (1.0, 5.0), "M_2": (0.5, -3.0)}


@pytest.mark.parametrize(
    ("start", "inputs"), [(SCENES["steered"], TURN), (SCENES["steered, slides"], TURN), (GENERAL, PUSH)]
)
def test_the_rates_at_the_end_of_a_step_are_those_of_its_inputs_until_something_is_set(wheel, start, inputs):
    w = wheel().start(tolerance=1e-12, **start).give(inputs).to(0.1)
    left, arrived = rates(w), dict(zip(inputs, w.get(*inputs), strict=True))
    held, right = rates(w.put(**arrived)), rates(w.give(inputs, since=0.1))
    within(
        np.max(np.abs(left - right) / (1 + np.abs(right))), 1e-9, "rates before and after they are given on, relative"
    )
    beyond(np.max(np.abs(left - held)), 1.0, "rates where the inputs stay, apart")


BRAKES = [((1.0, -3.0, 1.0), 0.0), ((3.0, -3.0, 1.0), 1.0), ((2.0, -3.0, 1.0), 1.0), ((6.0, -3.0), 0.0)]


@pytest.mark.parametrize(("brake", "rate"), BRAKES)
def test_the_capacity_of_a_brake_rests_while_its_polynomial_is_below_zero(wheel, brake, rate):
    """At 2 s three of them rise by 1 N m/s, from below zero, above it and zero; the last falls from zero."""
    w = wheel().start(guided=True, psi_start=0.0, theta_start=1.5, phi_dot_start=-20.0).give({"M_brake": brake}).by(2.0)
    assert w.rates(["tau_brake"])() == pytest.approx([rate])


@pytest.mark.parametrize("formulation", [2, 3])
@pytest.mark.parametrize("name", ["thrown", "turns at once"])
def test_output_derivatives_follow_a_slip_that_turns_ever_faster_as_it_ends(wheel, name, formulation):
    """Up to 5e-6 m/s, where it turns by up to 70 rad/s."""
    start = {"tolerance": 1e-13, "formulation": formulation, **SLIDES[name].start}
    logged = wheel(logging=True).start(**start).to(0.3).sentences
    end = next(float(text.split()[2]) for text in logged if "stops sliding" in text or "another direction" in text)
    for ahead in (1e-3, 1e-4, 1e-5, 1e-6):
        w = wheel().start(**start).to(end - ahead)
        assert w.get("contact_mode") == [1]
        within(rate_errors(w, ahead / 50), 1e-5, "rate off the difference, relative")
        exact = rates(w)
        beyond(np.max(np.abs(rates(w.by(ahead / 50)) - exact) / (1 + np.abs(exact))), 1e-4, "change within a fiftieth")


@pytest.mark.parametrize("formulation", [2, 3])
@pytest.mark.parametrize("slip", [1e-2, 1e-3])
def test_output_derivatives_follow_a_slow_slip_that_the_motion_turns_at_once(wheel, formulation, slip):
    """By up to 1e4 rad/s, while the wheel itself turns by 6 rad/s."""
    start = {"mu_max": 0.4, "mu_slide": 0.4, "psi_dot_start": 1.5, "phi_dot_start": -6.0, "slip_x_start": -slip}
    w = wheel().start(tolerance=1e-13, formulation=formulation, **start)
    within(rate_errors(w, 1e-4 * slip), 1e-6, "rate off the difference, relative")
    beyond(np.abs(rates(w)).max(), 40 / slip, "largest rate")


def jacobian(w: FMU2Wheel, knowns: Sequence[str] = LOADS) -> Array:
    return w.jacobian(outputs(w), knowns)


def difference_jacobian(w: FMU2Wheel, h: float = 0.5, knowns: Sequence[str] = LOADS) -> Array:
    """Outputs are linear in the loads as long as the friction keeps its mode."""
    return np.array([difference(w, outputs(w), name, h) for name in knowns]).T


LOADED = KINDS | {"sliding, braked": {**ROAD, **THROWN, "s": 0.01, "M_brake": 5.0}}
for _form in ("reduced", "multibody"):
    LOADED |= {f"{name}, {_form}": {**SCENES[name], "formulation": _form} for name in ("steered", "steered, slides")}


@pytest.mark.parametrize("scene", LOADED)
def test_directional_derivatives_are_those_of_the_reactions(wheel, scene):
    """By loads, and by a carrier's rates."""
    steered = "steered" in scene
    knowns = (*LOADS, "M_brake") if "M_brake" in LOADED[scene] else LOADS
    turns = [*TURN] if steered else []

    def both(w: FMU2Wheel) -> tuple[Array, Array]:
        """Leaves the instance as it was, so that the slopes of its inputs go on."""
        found, blob = jacobian(w, [*knowns, *turns]), w.serialized()
        by_turns = [difference(w, outputs(w), name, 0.05, range(-4, 5)) for name in turns]
        quotients = np.column_stack([difference_jacobian(w, knowns=knowns), *by_turns])
        w.back(blob)
        return found, quotients

    w = wheel().initializing(**LOADED[scene]).give(TURN if steered else {})
    checked = [both(w)]
    assert w.exitInitializationMode() == OK
    if steered:
        checked.append(both(w))
    for t in (0.25, 1.0, 3.0) if scene in KINDS else (0.1,):
        checked.append(both(w.to(t)))
    if steered:  # what is set ends the accelerations
        checked.append(both(w.put(F_X=1.0)))
    for exact, quotient in checked:
        errors = dict(zip(outputs(w), np.abs(exact - quotient).max(axis=1), strict=True))
        bound = 1e-8 if steered else 64 * 200 * EPSILON  # of reactions of 200 N, which the rates enter as squares
        within(errors, bound, "derivative off the difference")
        answers = np.any(quotient != 0, axis=1)  # whatever its name: no output is left out
        assert np.all(exact[~answers] == 0)
        assert np.linalg.matrix_rank(exact[answers], 1e-3) >= (3 if scene in KINDS else 2)
    beyond(np.max(np.abs(checked[0][0] - checked[-1][1])), 0.07, "derivatives at two instants apart")


def test_while_friction_holds_the_wheel_the_derivatives_are_those_of_a_held_wheel(wheel):
    w = wheel().start(s=0.03).by(1.26)
    assert w.get("friction_mode") == [0]
    within(np.max(np.abs(jacobian(w) - difference_jacobian(w, 1e-3))), 1e-10, "derivatives of the held wheel")
    rolling = wheel().back(w.serialized())
    for s in (0.0, 0.001):  # the partners: friction that was just set holds no moment, or less than acts
        within(np.max(np.abs(jacobian(rolling.put(s=s)) - difference_jacobian(rolling, 1e-3))), 1e-10, "derivatives")
        beyond(np.max(np.abs(jacobian(w) - jacobian(rolling))), 0.1, "derivatives of the two wheels apart")


def test_at_rest_without_friction_nothing_holds_the_wheel(wheel):
    w = wheel().start(**AT_REST)
    free = jacobian(w)
    within(np.max(np.abs(free - difference_jacobian(w))), 16 * 200 * EPSILON, "derivatives of the free wheel")
    held = wheel().start(s=0.03, **AT_REST)
    beyond(np.max(np.abs(free - jacobian(held))), 0.1, "derivatives of the held wheel")


@pytest.mark.parametrize("share", [0.5, 3e-3, 1.5e-3, 1e-4, 1e-6])
@pytest.mark.parametrize("kind", ["instant", "initialization"])
def test_the_friction_that_is_required_next_to_lift_off_has_the_derivative_of_its_quotient(wheel, share, kind):
    """mu = lambda_t / N, with N a share of the weight; the other unknowns of the call are answered too."""
    start = {"psi_dot_start": 0.5, "keep_contact": True}
    w = wheel().initializing(**start) if kind == "initialization" else wheel().start(**start)
    forces = ("lambda_1", "lambda_2", "lambda_3")
    slopes = w.jacobian(forces, ["F_Z"])[:, 0]
    assert w.set(F_Z=(share * 98.1 - w.get("lambda_3")[0]) / slopes[2]) == OK
    (X, Y, N), mu = w.get(*forces), w.get("mu_required")[0]
    expected = (X * slopes[0] + Y * slopes[1]) / np.hypot(X, Y) / N - mu / N * slopes[2]
    got = w.jacobian(["mu_required", *forces], ["F_Z"])[:, 0]
    within(abs(got[0] / expected - 1), 1e-11, "derivative of mu_required, relative")
    within(np.abs(got[1:] - slopes).max(), 1e-11, "derivatives of the force")
    beyond(abs(mu / N / expected), 0.5, "the part of N")


def test_wrong_requests_for_derivatives_are_refused(wheel):
    w = wheel().start()
    theta, force, mass, energy, mode = w.refer("theta", "F_X", "m", "E", "friction_mode")

    def output_derivative(reference: int, order: int) -> int:
        return w.ask("GetRealOutputDerivatives", [reference], 1, [order], [0])

    def directional(unknown: int, known: int) -> int:
        return w.ask("GetDirectionalDerivative", [unknown], 1, [known], 1, [1], [0])

    wrong = [(theta, 0), (theta, 2), (force, 1), (mass, 1), (energy, 1), (99, 1)]
    assert [output_derivative(*pair) for pair in wrong] == [ERROR] * 6
    wrong = [(theta, mass), (theta, theta), (force, force), (mode, force), (99, force), (theta, 99)]
    assert [directional(*pair) for pair in wrong] == [ERROR] * 6
    assert w.texts()[6] == f"fmi2GetDirectionalDerivative: value reference {mass} is not an input."  # the wheel rolls
    assert output_derivative(theta, 1) == directional(theta, force) == OK


def test_at_an_ending_the_rates_count_the_slope_that_led_there(wheel):
    slope = 1000.0
    lifted = wheel().start().give({"F_Z": (0.0, slope)})
    assert lifted.step(1.0) == DISCARD
    end, (rate,) = lifted.status(LAST_SUCCESSFUL_TIME), lifted.rates(["lambda_3"])()

    def normal_force(t: float) -> float:
        return wheel().start().give({"F_Z": (0.0, slope)}).by(t).get("lambda_3")[0]

    h = 1e-3
    backward = (3 * lifted.get("lambda_3")[0] - 4 * normal_force(end - h) + normal_force(end - 2 * h)) / (2 * h)
    within(abs(rate - backward), 0.01, "rate of N, N/s")  # of -933
    beyond(abs(rate + slope - backward), 80, "rate of N without the slope, N/s")
    assert lifted.step(0.1) == ERROR


ODD = {
    **{"theta_start": 1.1, "psi_start": 0.7, "phi_start": 0.4, "psi_dot_start": 0.9, "theta_dot_start": -0.6},
    **{"phi_dot_start": -3.0, "X_O_start": 0.2, "Y_O_start": -0.4, "m": 17.0, "F_X": 1.0, "M_2": 0.5},
}
STARTS = {
    "paper": {},  # J_z is at its limit, J_x + J_y; r, s and others at zero
    "turning": {"psi_dot_start": 2.0, "theta_start": 1.2},  # J_z too, and it counts
    "general": ODD | {"J_z": 1.6, "J_x": 0.8, "s": 0.03},
    "regularized": ODD | {"J_z": 1.6, "s": 0.03, "friction_law": 2, "omega_s": 0.5},
    "thin disc": {"r": 0.0, "theta_start": 0.9},
    "sliding": ODD | {"mu_max": 0.5, "mu_slide": 0.4, "slip_x_start": 1.0, "slip_y_start": -0.5},
    "steered": ODD
    | {"J_z": 1.6, "J_x": 0.8, "s": 0.03, "guided": True, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
    | {"psi_dot_guide": 0.9, "theta_dot_guide": -0.6},
}
AXLE = ("psi_dot_start", "theta_dot_start"), ("psi_dot_guide", "theta_dot_guide")


@pytest.mark.parametrize("scene", STARTS)
def test_every_pair_that_the_description_declares_for_the_start_is_answered_and_right(wheel, description, scene):
    w = wheel().initializing(**STARTS[scene])
    pairs = [
        (u.variable.name, v.name)
        for u in description.initialUnknowns
        for v in u.dependencies
        if u.variable.type == "Real"
    ]
    assert len(pairs) > 150
    moved, off = 0, 0.0
    for unknown, known in pairs:
        exact = w.jacobian([unknown], [known])[0, 0]
        if w.variables[known].type != "Real":
            assert exact == 0  # a choice has no small change
            continue
        if known in ("mu_slide", "slip_x_start", "slip_y_start") and scene != "sliding":
            assert exact == 0  # without mu_slide there is no start with slip
            continue
        if known in AXLE[scene != "steered"]:
            assert exact == 0  # of the free wheel and of the carrier
            continue
        h = 1e-5 * (abs(w.get(known)[0]) or 1.0) * (-1 if known == "J_z" else 1)  # J_z may be at its limit
        (quotient,), size = difference(w, [unknown], known, h, range(3)), 1 + abs(exact)
        within({f"d {unknown} / d {known}": abs(exact - quotient) / size}, 2e-5, "off the difference, relative")
        assert w.getDirectionalDerivative(w.refer(unknown), w.refer(known), [-2.0]) == [-2 * exact]
        moved, off = moved + (abs(exact) > 1e-6), max(off, abs(1.01 * exact - quotient) / size)
    beyond(off, 2e-5, "derivatives 1 % larger, relative")
    assert moved > 60
    assert w.messages == []


TURNED = {"theta_start": np.pi / 2, "psi_start": 0.7}
EVERY = STARTS | {
    "upright, steered": TURNED | {"guided": True, "phi_dot_start": -49.0},
    "upright, sliding": {**TURNED, "psi_start": -0.9, "phi_dot_start": -23.0}
    | {"mu_max": 0.4, "mu_slide": 0.4, "slip_x_start": -1.9},
}


@pytest.mark.parametrize("when", ["initializing", "during the run"])
@pytest.mark.parametrize("scene", EVERY)
def test_derivatives_asked_together_are_bit_identical_to_those_asked_alone(wheel, scene, when):
    w, kinds = wheel().initializing(**EVERY[scene]), ["input", "parameter"]
    if when == "during the run":
        assert w.exitInitializationMode() == OK and w.by(0.1)
        kinds.remove("parameter")
    knowns = [name for name, v in w.variables.items() if v.causality in kinds and v.type == "Real"]
    together = w.jacobian(w.reals, knowns)
    alone = np.vstack([w.jacobian([unknown], knowns) for unknown in w.reals])
    assert np.array_equal(together, alone)
    assert np.count_nonzero(together) > 10


def test_small_differences_of_large_terms_do_not_hide_a_derivative(wheel):
    """Upright, all outputs at once: v_y = -(r_0 + r) theta_dot is a difference of parts of v_x, 17 m/s."""
    w = wheel().initializing(**EVERY["upright, steered"])
    (found,) = w.jacobian(outputs(w), ["theta_dot_guide"])[outputs(w).index("v_y")]
    within(abs(found + 0.35), 1e-11, "derivative of v_y, m")


@pytest.mark.parametrize("size", [1e6, 1e12, -1e12])
def test_under_a_load_of_any_size_the_derivatives_are_those_without(wheel, size):
    """The reactions are linear in the loads."""
    usual = jacobian(wheel().initializing(keep_contact=True))
    for load in LOADS:
        column = jacobian(wheel().initializing(keep_contact=True, **{load: size}), [load])[:, 0]
        within(np.abs(column - usual[:, LOADS.index(load)]).max(), 1e-9, f"derivatives by {load} apart")


def test_the_derivatives_by_a_start_next_to_zero_are_those_at_zero(wheel):
    knowns = ("X_O_start", "Y_O_start", "psi_start", "phi_start", "psi_dot_start", "theta_dot_start", "slope_direction")
    usual = {"slope": 0.1, "J_x": 0.7, "J_y": 1.2}
    want, found = (
        wheel().initializing(**usual | dict.fromkeys(knowns, x)).jacobian(ANSWERS, knowns) for x in (0, 1e-9)
    )
    within(np.abs(found - want).max() / np.abs(want).max(), 1e-7, "derivatives apart, relative")


def test_rolling_resistance_alone_is_no_moment_of_the_brake(wheel):
    """tau_brake = tau M_brake / (M_brake + s N) is zero for each s where M_brake is."""
    w = wheel().initializing()
    slopes = w.jacobian(["tau_brake", "tau"], ["s", "M_brake"])
    assert slopes[0, 0] == 0 and slopes[0, 1] == slopes[1, 1] != 0
    beyond(abs(slopes[1, 0]), 100, "derivative of tau by s, N")


@pytest.mark.parametrize("omega_s", [1.0, 1e-2, 1e-3, 1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize("x", [-0.3, 0.7, 2.0, 30.0])
def test_the_moment_of_a_regularized_law_has_its_derivatives_by_spin_and_width_at_every_width(wheel, omega_s, x):
    """Upright: tau = -s m g tanh(x), x = phi_dot / omega_s. The steps are small against omega_s."""
    law = {"friction_law": 2, "s": 0.003, "omega_s": omega_s, "theta_start": np.pi / 2, "psi_dot_start": 0.0}
    w = wheel().initializing(phi_dot_start=x * omega_s, **law)
    by_spin = -0.003 * 20 * 9.81 / omega_s / np.cosh(x) ** 2
    found = w.jacobian(["tau"], ["phi_dot_start", "omega_s"])[0]
    within(np.abs(found - [by_spin, -x * by_spin]).max() / max(abs(by_spin), 1.0), 1e-9, "derivatives of tau, relative")
    coarse = difference(w, ["tau"], "omega_s", 0.1 * omega_s)[0]
    assert x == 30.0 or abs(coarse / (-x * by_spin) - 1) > 1e-4  # over a tenth of omega_s it is another
    (velocity,) = w.jacobian(["Y_O_dot"], ["phi_dot_start"])[:, 0]
    within(abs(velocity / w.put(phi_dot_start=1.0).get("Y_O_dot")[0] - 1), 1e-9, "derivative of the velocity, relative")


BRAKED = {"theta_start": np.pi / 2, "phi_dot_start": 0.0, "s": 0.02}


def test_the_brakes_moment_on_a_held_wheel_has_the_derivatives_of_its_share(wheel):
    """Upright, held: tau = -M_3 of a torque alone, N = m g, and the share is M_brake / (M_brake + s N)."""
    brake, torque, N = 50.0, -40.0, 20 * 9.81
    rolling = 0.02 * N
    w = wheel().start(**BRAKED).put(M_brake=brake, M_3=torque).to(0.01)
    assert w.get("friction_mode") == [0]
    tau, capacity = -torque, brake + rolling
    want = np.array([tau * rolling / capacity**2, -brake / capacity, tau * brake * 0.02 / capacity**2])  # F_Z lifts
    (found,) = w.jacobian(["tau_brake"], ["M_brake", "M_3", "F_Z"])
    within(np.abs(found / want - 1).max(), 4096 * EPSILON, "derivatives of the brake's moment, relative")
    start = wheel().initializing(**BRAKED, M_brake=brake, M_3=torque)  # s and m act through the share alone
    found = start.jacobian(["tau_brake", "tau"], ["s", "m"])
    want_s, want_m = -tau * brake * np.array([N, 0.02 * 9.81]) / capacity**2
    within(np.abs(found[0] / [want_s, want_m] - 1).max(), 1e-9, "derivatives by s and m, relative")
    assert not found[1].any()
    beyond(abs(w.jacobian(["tau"], ["M_3"])[0, 0] / want[1] - 1), 0.05, "derivative of both moments, relative")


def test_a_brake_about_to_be_put_on_has_the_derivative_of_its_capacity(wheel):
    for s in (0.0, 0.02):
        w = wheel().start(theta_start=np.pi / 2, phi_dot_start=-5.0, s=s).to(0.01)
        within(abs(w.jacobian(["tau_brake"], ["M_brake"])[0, 0] - 1), 64 * EPSILON, "derivative by the brake, off 1")
        assert w.get("tau_brake") == [0]


PULLED = {"theta_start": 1.3, "psi_dot_start": 0.4, "keep_contact": True, "s": 0.02}
STATE = {"rolls": {"phi_dot_start": -5.0, "psi_dot_start": 0.4}, "held": {"phi_dot_start": 0.0, "psi_dot_start": 0.0}}
STATE |= {"regularized": {**STATE["rolls"], "friction_law": 2, "omega_s": 2.0}}


@pytest.mark.parametrize("formulation", [2, 3])
@pytest.mark.parametrize("state", STATE)
def test_on_a_ground_that_pulls_the_brake_alone_has_the_moment_and_its_derivatives(wheel, state, formulation):
    """F_Z lifts the wheel; the partner is the ground that presses, with s N beside the brake."""
    own = {**PULLED, **STATE[state], "formulation": formulation, "tolerance": 1e-12}
    load = {"M_brake": (50.0, 30.0), "M_3": (-4.0, 6.0), "M_1": (0.5, -2.0)}
    for F_Z, pulls in ((300.0, True), (30.0, False)):
        w = wheel().start(**own).give({**load, "F_Z": (F_Z, 20.0)}).by(1e-3).give({**load, "F_Z": (F_Z, 20.0)})
        assert (w.get("lambda_3")[0] < 0) == pulls and w.get("friction_mode") == [0 if state == "held" else -1]
        tau, braked = w.get("tau", "tau_brake")
        assert (tau == braked) == pulls
        within(rate_errors(w), 2e-7, "rate off the difference, relative")
        for name in ("M_brake", *LOADS):
            errors = np.abs(difference(w, outputs(w), name, 0.01) - jacobian(w, [name])[:, 0])
            within(dict(zip(outputs(w), errors, strict=True)), 1e-9, f"derivative by {name}")
        slope = w.jacobian(["tau_brake"], ["M_brake"])[0, 0]
        within(
            abs(slope - (0.0 if state == "held" else braked / 50.0)) if pulls else 0.0, 1e-12, "derivative of tau_brake"
        )


UPRIGHT = {"theta_start": np.pi / 2, "psi_start": 0.0}
ROADS = {
    "driven": {**UPRIGHT, "mu_max": 0.5, "mu_slide": 0.45},
    "driven, leaning": {"mu_max": 0.5, "mu_slide": 0.45, "formulation": 3},
    "driven, braked": {**UPRIGHT, "phi_dot_start": 0.0, "s": 0.01, "mu_max": 0.5, "mu_slide": 0.45},
}
ANSWERS = ("lambda_x", "lambda_y", "lambda_3", "tau", "theta_ddot", "psi_ddot", "omega_z_dot", "mu_required")


def furthest(w: FMU2Wheel, h: float = 1e-3) -> float:
    """Largest error of a derivative by an input, against the nearest of its quotients: central, to the right, to the
    left."""
    off = []
    for known, slopes in zip(LOADS, w.jacobian(ANSWERS, LOADS).T, strict=True):
        sides = [difference(w, ANSWERS, known, h, places) for places in ((-1, 1), (0, 1), (0, -1))]
        off.append(min(np.max(np.abs(slopes - side) / (1 + np.abs(slopes))) for side in sides))
    return max(off)


@pytest.mark.parametrize("road", ROADS)
@pytest.mark.parametrize("when", ["initializing", "at the start", "during the run"])
def test_derivatives_are_quotients_of_the_outputs_where_the_loads_decide_how_a_slip_begins(wheel, road, when):
    w = wheel().initializing(**ROADS[road])
    if when != "initializing":
        assert w.exitInitializationMode() == OK
    if when == "during the run":
        w.by(0.1)
    assert w.get("contact_mode") == [0]
    w.put(M_3=-80.0, M_1=2.0)
    assert w.get("contact_mode") == [1] and w.get("slip_x", "slip_y") != [0.0, 0.0]
    within(furthest(w), 1e-9, "derivatives off the quotients, relative")
    beyond(furthest(w, 20.0), 1e-5, "derivatives off coarse quotients, relative")


CHANGES = {name: KINDS[name] for name in ("friction", "multibody", "sliding")}
CHANGES |= {"sliding, friction": {"mu_max": 0.3, "mu_slide": 0.25, "s": 0.03}}
CHANGES |= {"sliding, multibody": {"mu_max": 0.45, "mu_slide": 0.4, "formulation": 3}}
CHANGES |= {"pulled": {"keep_contact": True, "theta_start": 0.5, "psi_dot_start": 0.1, "phi_dot_start": 0.0, "s": 0.02}}


@pytest.mark.parametrize("scene", CHANGES)
def test_derivatives_are_quotients_of_the_outputs_at_the_instant_of_every_transition(wheel, scene):
    """Two nanoseconds before it, at it as it is logged, and two after it: of one of the two laws."""
    logged = wheel(logging=True).start(**CHANGES[scene]).to(2.0)
    found = {float(t) for text in logged.sentences for t in re.findall(r"^t = (\S+) s", text)}
    assert found
    for t in sorted(found)[:8]:
        for near in (t - 2e-9, t, t + 2e-9):
            within(furthest(wheel().start(**CHANGES[scene]).to(near)), 1e-5, "derivatives off the quotients, relative")


# ---- small spins and slips: within little their forces turn over ----


@pytest.mark.parametrize("slip", [1.0, 1e-3, 3e-4, 1e-6, 1e-9])
@pytest.mark.parametrize("direction", [0.0, 0.9, 2.5])
def test_the_force_of_a_slip_has_its_derivatives_at_every_speed(wheel, slip, direction):
    """Upright on a wheel carrier N = m g: the force is -mu N along the slip."""
    x, y, force = np.cos(direction), np.sin(direction), 0.5 * 20 * 9.81
    start = {"guided": True, "theta_start": np.pi / 2, "mu_max": 0.5, "mu_slide": 0.5}
    w = wheel().initializing(slip_x_start=slip * x, slip_y_start=slip * y, **start)
    expected = -force / slip * np.array([[y * y, -x * y], [-x * y, x * x]])
    found = w.jacobian(["lambda_x", "lambda_y"], ["slip_x_start", "slip_y_start"])
    within(np.abs(found - expected).max() * slip / force, 1e-9, "derivatives of the force, relative")


def small_spin_or_slip(random):
    """A wheel with its scales of the slip and of the spin."""
    slip, x, omega_s, mu = *10 ** random.uniform(-8, 0, 2), 10 ** random.uniform(-7, 0), random.uniform(0.2, 0.5)
    theta, psi_dot, direction = random.uniform(0.8, 2.3), random.normal(), random.uniform(-np.pi, np.pi)
    start = {"theta_start": theta, "psi_dot_start": psi_dot, "theta_dot_start": random.normal(), "J_x": 0.8, "J_z": 1.6}
    start |= {"phi_dot_start": (x - 0.5) * omega_s - psi_dot * np.cos(theta), "friction_law": 2, "omega_s": omega_s}
    start |= {"s": 0.02, "keep_contact": True}
    if random.random() < 0.5:
        start |= {"mu_max": mu, "mu_slide": mu, "slip_x_start": slip * np.cos(direction)}
        start |= {"slip_y_start": slip * np.sin(direction)}
    return start, slip, omega_s


KNOWNS = ("phi_dot_start", "psi_dot_start", "theta_start", "theta_dot_start", "omega_s", "slip_x_start", "slip_y_start")


def test_derivatives_by_the_start_are_quotients_over_steps_that_fit_the_spin_and_the_slip(wheel):
    """Of the fourth order; their own rounding, and that of the spin, which is a small difference, are allowed for."""
    random, coarse = np.random.default_rng(3), 0.0
    for _ in range(60):
        start, slip, omega_s = small_spin_or_slip(random)
        w = wheel().initializing(**start)
        for known in KNOWNS[: 7 if "mu_max" in start else 5]:
            exact = w.jacobian(ANSWERS, [known])[:, 0]
            fitting = slip if known.startswith("slip") else omega_s
            for h, allowed in ((3e-3 * fitting, 1e-6), (1e-2, np.inf)):
                quotient = difference(w, ANSWERS, known, h, (-2, -1, 1, 2))
                rounding = 1e4 * EPSILON * (1 + np.abs(w.get(*ANSWERS)) + np.abs(exact)) / h
                off = np.abs(exact - quotient) / (np.abs(exact) + rounding / 1e-6)
                within(dict(zip(ANSWERS, off, strict=True)), allowed, f"off the quotient by {known}, relative")
            coarse = max(coarse, off.max())
    beyond(coarse, 0.1, "derivatives off coarse quotients, relative")


@pytest.mark.parametrize("mu", [0.5, 1e-2, 1e-4])
def test_loads_that_decide_how_a_slip_begins_do_so_on_a_slippery_road(wheel, mu):
    w = wheel().initializing(mu_max=mu, mu_slide=0.9 * mu, **UPRIGHT).put(F_Y=3e3 * mu, M_3=5 * mu)
    assert w.get("contact_mode") == [1]
    within(furthest(w, mu), 1e-6, "derivatives off the quotients, relative")


def test_derivatives_replace_what_their_array_held(wheel):
    w = wheel().start(F_X=5.0, M_3=1.0)
    knowns, seeds = w.refer("F_X", "M_3"), [2.0, -3.0]
    found = []
    for held in (0.0, 7.0, np.nan):
        values = (c_double * 2)(held, held)
        assert w.ask("GetDirectionalDerivative", w.refer("theta_ddot", "lambda_1"), 2, knowns, 2, seeds, values) == OK
        found.append(list(values))
    assert found[0] == found[1] == found[2] and all(found[0])


def test_derivatives_are_refused_wherever_in_the_list_one_is_not_finite(wheel):
    """Off the ground no friction would do."""
    w = wheel().start(keep_contact=True, F_Z=500.0)
    for unknowns, status in ((("theta_ddot", "E", "tau"), OK), (("theta_ddot", "E", "mu_required"), DISCARD)):
        for k in range(3):
            order = w.refer(*unknowns[k:], *unknowns[:k])
            assert w.ask("GetDirectionalDerivative", order, 3, w.refer("F_Z"), 1, [1.0], [0.0] * 3) == status, order
