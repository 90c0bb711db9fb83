"""The carrier's rates as inputs: when they act, until when their derivatives count, refusals, states. Derivatives by
them: test_derivatives.py."""

from math import cos

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, FMU2Wheel
from wheelfmu.truth.exchange import exchange, loaded
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import GENERAL

RATES = ("psi_dot_guide", "theta_dot_guide")
LEANS = {**GENERAL, "guided": True, "theta_start": 1.2, "phi_dot_start": -8.0, "s": 0.01}
FREE = {"guided": False}
SLIDES = {"mu_max": 0.3, "mu_slide": 0.25, "slip_x_start": 2.0, "slip_y_start": -1.0}
ANSWERS = ("psi_dot", "theta_dot", "omega_z", "v_x", "v_y", "X_O_dot", "Y_O_dot", "lambda_x", "lambda_y", "lambda_3")
ANSWERS += ("M_guide_1", "M_guide_2", "tau", "slip_x", "slip_y", "mu_required")
formulations = pytest.mark.parametrize("formulation", [2, 3], ids=["reduced", "multibody"])
surfaces = pytest.mark.parametrize("road", [{}, SLIDES], ids=["rolls", "slides"])


def steer(w: FMU2Wheel, *slopes: float) -> FMU2Wheel:
    """From the present rates on with these slopes, psi first."""
    return w.put(psi_dot_guide=0.4, theta_dot_guide=-0.3).give(
        {"psi_dot_guide": (0.4, slopes[0]), "theta_dot_guide": (-0.3, slopes[1])}
    )


@formulations
@surfaces
def test_what_is_set_takes_effect_at_once_and_at_the_start_without_a_jump(
    library: Library, road: dict, formulation: int
) -> None:
    """At the start phi_dot and slip are those of the start values; later the spin jumps."""
    start = {**LEANS, **road, "formulation": formulation}
    with library.wheel() as w, library.wheel() as later:
        steer(w, 2.0, 0.5)
        w.start(**start)
        later.start(**start)
        steer(later, 2.0, 0.5)
        for wheel in (w, later):
            found = wheel.get("psi_dot", "theta_dot", "psi_ddot", "theta_ddot", "psi", "theta")
            within(absolute_error(found, [0.4, -0.3, 2.0, 0.5, np.pi / 2, 1.2]), 1e-14, "rates, rad/s and rad/s2")
        phi_dot, omega_z, *slip = w.get("phi_dot", "omega_z", "slip_x", "slip_y")
        within(abs(omega_z - (-8.0 + 0.4 * cos(1.2))), 8 * 8 * EPSILON, "spin, rad/s")
        within(abs(phi_dot + 8.0), 8 * 8 * EPSILON, "phi_dot, rad/s")
        within(absolute_error(slip, [road.get("slip_x_start", 0), road.get("slip_y_start", 0)]), 1e-14, "slip, m/s")
        beyond(abs(later.get("omega_z")[0] - omega_z), 1e-3, "spin of one that turns after the start, rad/s")
        if road:
            beyond(abs(later.get("slip_y")[0] - slip[1]), 0.05, "slip of one that turns after the start, m/s")


@formulations
@surfaces
def test_derivatives_count_until_something_is_set_after_their_step(
    library: Library, road: dict, formulation: int
) -> None:
    """Moments and forces at the end of a step have its accelerations; what is set later, be it to the value that it
    has, is what follows."""
    inertial = ("psi_ddot", "theta_ddot", "M_guide_1", "M_guide_2", "lambda_3")
    with library.wheel() as w, library.wheel() as longer:
        for wheel in (w, longer):
            wheel.start(**LEANS, **road, formulation=formulation, tolerance=1e-11)
            steer(wheel, 2.0, 0.5)
        longer.to(0.2)
        w.to(0.1)
        before = w.get(*inertial)
        steered = dict(zip(inertial, before, strict=True))
        within(absolute_error(before[:2], [2.0, 0.5]), 1e-13, "accelerations at the end of the step, rad/s2")
        state = w.serialized()
        w.put(F_X=1.0)
        held = w.put(F_X=0.0).get(*inertial)
        within(absolute_error(held[:2], [0.0, 0.0]), 1e-14, "accelerations of a carrier that turns evenly, rad/s2")
        beyond(abs(held[3] - steered["M_guide_2"]), 0.5, "moment that the accelerations take, N m")
        for name in ("psi_dot_guide", "F_X", "M_brake", "s"):
            assert w.back(state).get(*inertial) == before
            assert w.put(**{name: w.get(name)[0]}).get(*inertial) == held
        assert w.back(state).set_input_derivatives(["psi_dot_guide"], [[0.0]]) == OK and w.get(*inertial) == held
        set_again = w.put(psi_dot_guide=w.get("psi_dot_guide")[0]).serialized()
        assert w.to(0.2).bits() == w.back(state).to(0.2).bits()  # the motion is the same
        assert w.back(set_again).get(*inertial) == held
        w.back(state).give({"psi_dot_guide": (0.6, 2.0), "theta_dot_guide": (-0.25, 0.5)})
        within(absolute_error(w.get(*inertial), before), 1e-9, "the same where the slopes go on")
        w.to(0.2)
        within(absolute_error(w.get(*ANSWERS), longer.get(*ANSWERS)), 1e-8, "in two steps and in one")
        held = w.back(state).to(0.2).get("psi_ddot", "theta_ddot", "psi_dot", "theta_dot")
        within(absolute_error(held, [0.0, 0.0, 0.6, -0.25]), 1e-13, "held in the step after, rad/s")


def test_only_a_guided_wheel_in_co_simulation_takes_them(library: Library) -> None:
    with library.wheel(logging=True) as free, exchange(library, **LEANS) as exchanged:
        free.start(**{**LEANS, **FREE})
        for w in (free, exchanged):
            for name in RATES:
                assert (w.set(**{name: 0.1}), w.set(**{name: 0.0})) == (DISCARD, OK) and w.get(name) == [0.0]
            assert not w.jacobian(ANSWERS, RATES).any()
        assert free.set_input_derivatives(["psi_dot_guide"], [[0.2]]) == ERROR
        assert "derivative 1 = 0.2 of psi_dot_guide" in free.texts()[-1]
    with library.wheel() as w:
        w.put(**{**LEANS, **FREE})
        assert w.set_input_derivatives(["theta_dot_guide"], [[0.0], [0.1]]) == OK
        assert w.initialise() == ERROR and "these inputs need guided = true" in w.said()
    with loaded(library).new() as w:
        assert w.put(**LEANS, psi_dot_guide=0.1).initialise() == ERROR and "co-simulation" in w.said()
        assert w.reset() == OK and w.put(**LEANS).initialise() == OK  # the partner


def test_absurd_rates_are_refused_and_the_largest_can_be_computed(library: Library) -> None:
    with library.wheel(logging=True) as w:
        w.start(**LEANS, keep_contact=True)
        for name in RATES:
            assert [w.set(**{name: rate}) for rate in (1.0001e4, -1.0001e4, np.inf, np.nan)] == [DISCARD] * 4
        assert w.put(psi_dot_guide=1e4).step(0.01) == OK
        within(abs(w.get("psi_dot")[0] / 1e4 - 1), 1e-12, "rate, relative")
        assert w.put(psi_dot_guide=0.0, theta_dot_guide=-1e4).step(0.01) == DISCARD  # it lies flat
        assert "lies flat" in w.texts()[-1]


def test_a_run_restored_at_its_start_keeps_the_rates_that_it_started_with(library: Library) -> None:
    """The start is not computed anew from rates that were set later."""
    with library.wheel() as w, library.wheel() as other:
        steer(w, 0.0, 0.0)
        w.start(**{**LEANS, "s": 0.0})
        w.put(psi_dot_guide=0.0, theta_dot_guide=0.0)
        spin = w.get("omega_z")[0]
        beyond(abs(spin + 8.0), 1e-3, "spin off phi_dot, rad/s")
        state = w.serialized()
        for wheel in (w, other.back(state)):
            found = wheel.to(1.0).get("omega_z", "psi_dot", "theta")
            within(absolute_error(found, [spin, 0.0, 1.2]), 1e-12, "spin, rad/s, and angles, rad")


STEER, LEAN = {"psi_dot_guide": 0.4}, {"theta_dot_guide": -0.3}
OTHER = {"psi_dot_guide": 5.0, "theta_dot_guide": 3.0}


@surfaces
def test_both_rates_jump_together_in_whatever_order_they_are_set(library: Library, road: dict) -> None:
    found = []
    for order in ((STEER, LEAN), (LEAN, STEER), (OTHER, STEER | LEAN)):
        with library.wheel() as w:
            w.start(**LEANS, **road).by(0.01)
            for rates in order:
                w.put(**rates)
            found.append(w.get(*ANSWERS))
    assert found[0] == found[1] == found[2]


@formulations
@pytest.mark.parametrize("angle", ["psi", "theta"])
def test_a_carrier_that_turns_about_one_axis_alone_stops(wheel, angle, formulation):
    w = wheel().start(guided=True, psi_start=0.0, theta_start=1.4, formulation=formulation)
    w.put(**{f"{angle}_dot_guide": 0.5}).by(0.1)
    assert w.get(f"{angle}_dot") == pytest.approx([0.5])  # the partner: it turns
    before = w.put(**{f"{angle}_dot_guide": 0.0}).get(angle)
    assert w.get(f"{angle}_dot") == [0] and w.by(0.1).get(f"{angle}_dot") == [0] and w.get(angle) == before


@formulations
@surfaces
def test_rates_that_a_ramp_has_brought_to_zero_stay_there_without_acceleration(
    library: Library, road: dict, formulation: int
) -> None:
    """Read before and after the rates are set to where they have arrived."""
    inertial = ("psi_ddot", "theta_ddot", "psi_dot", "theta_dot")
    with library.wheel() as w:
        w.start(**LEANS, **road, formulation=formulation)
        w.put(psi_dot_guide=0.5, theta_dot_guide=-0.25)
        assert w.get("psi_ddot", "theta_ddot") == [0.0, 0.0]
        assert w.set_input_derivatives(RATES, [[-4.0, 2.0]]) == OK
        within(absolute_error(w.get(*inertial), [-4.0, 2.0, 0.5, -0.25]), 1e-13, "ramp, rad/s2 and rad/s")
        within(absolute_error(w.by(0.125).get(*inertial), [-4.0, 2.0, 0.0, 0.0]), 1e-13, "its end, rad/s2 and rad/s")
        w.put(psi_dot_guide=0.0, theta_dot_guide=0.0)
        within(absolute_error(w.get(*inertial), 0.0), 1e-14, "once set, rad/s2 and rad/s")
        at_rest = w.by(0.125).get(*inertial, "psi", "theta")
        assert at_rest[:4] == [0.0] * 4 and w.by(0.125).get("psi", "theta") == at_rest[4:]


HELD = {**LEANS, "phi_dot_start": 0.0, "s": 0.001}
JUMP = {"psi_dot_guide": 3.0, "theta_dot_guide": 0.5}


@formulations
@pytest.mark.parametrize("s", [0.0, 0.01])
def test_a_jump_meets_the_loads_that_are_set_with_it(library: Library, s: float, formulation: int) -> None:
    """As if they were in force before it: a brake holds the wheel that the jump alone would turn."""
    for brake in (0.0, 3e4):
        with library.wheel() as together, library.wheel() as before:
            for w in (together, before):
                w.start(**HELD | {"s": s}, formulation=formulation).put(M_brake=3e4 - brake).by(0.01)
            found = together.put(**JUMP, M_brake=brake).get(*ANSWERS)
            assert before.put(M_brake=brake).by(0.0).put(**JUMP).get(*ANSWERS) == found
            assert together.by(0.0).get(*ANSWERS) == found
            assert (found[ANSWERS.index("omega_z")] == 0) == (brake > 0)


@formulations
@surfaces
def test_a_jump_of_the_tilt_over_a_ground_that_pulls_turns_no_wheel(
    library: Library, road: dict, formulation: int
) -> None:
    """A ground that presses turns it by s times the impulse: the partner."""
    start = {**LEANS, **road, "s": 0.03, "keep_contact": True, "formulation": formulation}
    for F_Z, pulls in ((500.0, True), (0.0, False)):
        with library.wheel() as w:
            w.start(**start).put(F_Z=F_Z).by(0.01)
            assert (w.get("lambda_3")[0] < 0) == pulls
            (spin,) = w.get("omega_z")
            (turned,) = w.put(theta_dot_guide=1.5).get("omega_z")
            assert (turned == spin) == pulls
