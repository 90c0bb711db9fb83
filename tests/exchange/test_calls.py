"""Model exchange, call by call: states to the bit, derivatives, snapshots, endings, refusals."""

from ctypes import byref, c_double, c_int, sizeof

import numpy as np
import pytest
from fmpy.fmi2 import fmi2EventInfo
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bounds import EPSILON, absolute_error, beyond, within
from support.differences import LOADS, difference

from wheelfmu.fmu.driver import DERIVATIVES, DISCARD, ERROR, INDICATORS, OK, STATES, FMU2Wheel
from wheelfmu.truth.exchange import exchange, loaded
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import AT_REST

GENERAL = {"J_x": 0.7, "J_y": 1.2, "slope": 0.2, "slope_direction": 0.7, "psi_dot_start": 0.5, "F_X": 3.0, "M_2": 0.4}
WEIGHT = 20 * 9.81  # N
ODD = np.array([0.1, -0.2, 0.3, 1.1, 0.7, 0.9, 1 / 3, -1.7])  # a state off every symmetry


def at_odd(library: Library, **values: float) -> FMU2Wheel:
    wheel = exchange(library, **{**GENERAL, **values})
    wheel.place(0.3, ODD)
    return wheel


def test_states_are_read_back_to_the_bit(library: Library) -> None:
    with at_odd(library) as wheel:
        assert (wheel.x() == ODD).all() and wheel.get(*STATES) == ODD.tolist()
        wheel.place(0.3, np.nextafter(ODD, np.inf))
        assert (wheel.x() != ODD).all()
        for x in np.random.default_rng(1).uniform(0.3, 2.8, (50, 8)):
            wheel.place(0.3, x)
            assert wheel.get(*STATES) == x.tolist()


@pytest.mark.parametrize("theta", [1.1, 1e-4, 1e-5, 1.1e-7, np.pi - 1.1e-7])
def test_the_derivatives_are_the_variables_of_that_name_to_the_last_tenmillionth_of_a_radian(library, theta) -> None:
    with at_odd(library, s=0.02) as wheel:
        wheel.place(0.3, np.where(ODD == 1.1, theta, ODD))
        assert wheel.derivatives().tolist() == wheel.get(*DERIVATIVES)
        beyond(np.abs(wheel.derivatives() - wheel.get(*reversed(DERIVATIVES))).max(), 1, "derivatives in another order")


def test_a_state_of_one_kind_is_refused_by_the_other(library: Library) -> None:
    with exchange(library) as wheel, library.wheel(logging=True) as slave:
        blob = wheel.serialized()
        assert slave.start().restore(blob) == ERROR
        assert "kind of instance" in slave.sentences[-1]
        assert wheel.restore(slave.serialized()) == ERROR
        assert wheel.restore(blob) == OK  # the partner


def test_a_snapshot_between_trial_steps_that_went_back_in_time_is_restored(library: Library) -> None:
    """A solver that rejects a trial step sets an earlier time than that at which it set the inputs last."""

    @settings(max_examples=60)
    @given(
        st.lists(st.tuples(st.floats(-1e-6, 2.0), st.floats(-1.0, 1.0)), min_size=1, max_size=5),
        st.floats(-1e-3, 1.0),
        st.fixed_dictionaries(dict.fromkeys(LOADS, st.floats(-5, 5))),
    )
    def check(trials, t, load):
        with exchange(library, s=0.03, **load) as wheel, exchange(library) as other:
            for trial, torque in trials:
                wheel.place(trial, ODD)
                assert wheel.set(M_3=torque) == OK
                wheel.derivatives()
            wheel.place(t, ODD)
            for taker in (wheel, other):
                assert taker.restore(wheel.serialized()) == OK, taker.sentences
            assert other.bits() == wheel.bits() and (other.derivatives() == wheel.derivatives()).all()
            wheel.place(t, ODD + 1e-9)
            assert other.bits() != wheel.bits()

    check()


REACTIONS = ("tau", "lambda_1", "lambda_3", "omega_z_dot", "theta_ddot", "psi_ddot")
LAWS = ({}, {"s": 0.03}, {"s": 0.03, "friction_law": 2, "omega_s": 0.01, "M_brake": 1.0})


@pytest.mark.parametrize("theta", [1.1, 0.02], ids=["odd", "nearly flat"])
@pytest.mark.parametrize("law", LAWS, ids=["none", "exact", "regularized"])
def test_directional_derivatives_are_differences_under_every_law(library: Library, law: dict, theta: float) -> None:
    unknowns = (*DERIVATIVES, "lambda_1", "lambda_3", "tau", "X_C", "E")
    steps = dict.fromkeys(STATES, 0.02) | {"theta": 0.02 * theta, "omega_z": 2e-4, "F_X": 0.5, "M_2": 0.5}
    with at_odd(library, **law) as wheel:
        wheel.place(0.3, np.array([*np.where(ODD == 1.1, theta, ODD)[:-1], -0.002]))  # inside the layer of the law
        got = wheel.jacobian(unknowns, tuple(steps))
        want = np.array([difference(wheel, unknowns, known, h, range(-4, 5)) for known, h in steps.items()]).T
    size = 1 + np.abs(want).max(axis=0)
    within((np.abs(got - want) / size).max(), 1e-9, "Jacobian, relative")
    beyond((np.abs(got * (1 + 1e-6) - want) / size).max(), 2e-7, "Jacobian a millionth larger, relative")


def test_directional_derivatives_after_a_billion_turns_are_those_of_the_first(library: Library) -> None:
    """To the digits that are left of the angles."""
    found = []
    for turns in (0, 1e9):
        with at_odd(library, s=0.02, F_X=5.0, F_Y=-8.0) as wheel:
            wheel.place(0.3, ODD + 2 * np.pi * turns * np.isin(STATES, ("psi", "phi")))
            found.append(wheel.jacobian(REACTIONS, STATES[2:]))
    size = 1 + np.abs(found[0])
    within((np.abs(found[1] - found[0]) / size).max(), 2e-5, "Jacobian, relative")
    beyond((np.abs(found[1] * (1 + 1e-4) - found[0]) / size).max(), 3e-5, "Jacobian a ten-thousandth larger, relative")


def test_derivatives_by_other_states_than_the_spin_do_not_know_the_width_of_the_law(library: Library) -> None:
    """Spinning far outside of any layer; partner: another s."""
    found = []
    for changes in ({"omega_s": 1e-2}, {"omega_s": 1e-9}, {"omega_s": 1e-2, "s": 0.0301}):
        with at_odd(library, **{"s": 0.03, "friction_law": 2} | changes) as wheel:
            found.append(wheel.jacobian(REACTIONS, STATES[2:-1]))
    size = np.abs(found[0]).max()
    within(np.abs(found[1] - found[0]).max() / size, 1e-9, "derivatives under the two widths apart, relative")
    beyond(np.abs(found[2] - found[0]).max() / size, 1e-6, "derivatives with another s, relative")


def test_state_and_friction_may_be_set_at_any_time_and_the_law_follows(library: Library) -> None:
    with exchange(library) as wheel:
        frictionless = wheel.derivatives()
        assert wheel.set(s=0.03) == OK
        assert wheel.get("friction_mode") == [-1]
        assert (wheel.derivatives() != frictionless).any()
        assert wheel.set(theta=1.2, psi_dot=0.4, omega_z=0.5) == OK
        assert wheel.get("theta", "psi_dot", "omega_z", "friction_mode") == [1.2, 0.4, 0.5, 1]
        assert wheel.set(phi_dot=1.0) == ERROR
        assert wheel.set(m=21.0) == ERROR
    with loaded(library).new().initializing() as wheel:  # there a state follows from the parameters
        assert wheel.set(theta=1.2) == ERROR


def test_a_spin_set_across_an_event_is_kept_and_the_law_follows_it(library: Library) -> None:
    """By fmi2SetContinuousStates as by fmi2SetReal; there in the event mode that an indicator asks for."""

    @settings(max_examples=60)
    @given(st.sampled_from([0.0, -2.0, 2.0]), st.floats(-2.0, 1.3), st.sampled_from([-1.0, 1.0]), st.floats(0.8, 2.2))
    def check(start, power, side, theta):
        values = {"s": 0.03, "theta_start": theta, "phi_dot_start": start}
        with exchange(library, logging=True, **values) as wheel, exchange(library, **values) as other:
            x = wheel.x()
            x[-1] = side * max(10.0**power, 0.4 * bool(start))  # less can be that of a long step
            wheel.place(0.1, x)
            crosses = start * side <= 0
            assert (wheel.indicator("spin_changes") < 0) == wheel.wants_event() == crosses
            assert bool(wheel.event().valuesOfContinuousStatesChanged) == crosses
            assert other.setTime(0.1) == other.set(omega_z=x[-1]) == OK
            assert (wheel.x() == x).all() and wheel.get("friction_mode") == [side]
            assert (wheel.derivatives() == other.derivatives()).all()
            said = f"{'reversal' if start else 'release'}, omega_z becomes {'positive' if side > 0 else 'negative'}."
            assert [text.split(": ")[1] for text in wheel.sentences] == [said] * crosses

    check()


@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize("torque", [0.0, -50.0], ids=["held", "driven away from zero"])
def test_a_spin_off_its_side_by_a_thousandth_of_the_scale_of_rates_is_an_error_and_by_more_is_set(
    library, torque, share
):
    """The scale is the power of two below sqrt(g / R)."""
    with exchange(library, s=0.03, M_3=torque, **AT_REST) as wheel:
        mode = wheel.get("friction_mode")
        wheel.place(0.1, np.where(np.array(STATES) == "omega_z", 4e-3 * share, wheel.x()))
        wheel.event()
        kept = [wheel.x()[-1] == 0, wheel.get("friction_mode") == mode]
        assert kept == [share < 1] * 2


@pytest.mark.parametrize("h", [1e-3, 1e-2, 0.05])
def test_a_spin_that_steps_without_a_search_lead_across_zero_still_stops(library: Library, h: float) -> None:
    """The partner: Euler's method. omega_z goes beyond zero by up to a step."""
    rng = np.random.default_rng(5)
    for spin, torque in rng.uniform((0.3, 0.0), (2.0, 30.0), (20, 2)):
        with exchange(library, s=0.03, M_brake=torque, **{**AT_REST, "phi_dot_start": spin}) as wheel:
            x, t = wheel.x(), 0.0
            while not wheel.wants_event():
                x, t = x + h * wheel.derivatives(), t + h
                wheel.place(t, x)
            wheel.event()
            assert wheel.x()[-1] == 0 and wheel.get("friction_mode") == [0]


def test_a_held_wheel_stays_at_exactly_zero(library: Library) -> None:
    with exchange(library, s=0.03, **AT_REST) as wheel:
        assert wheel.get("friction_mode") == [0]
        x = wheel.x()
        assert wheel.derivatives()[-1] == 0
        with exchange(library, s=0.06, **AT_REST) as twice:  # what is left is s N
            assert wheel.indicator("spin_changes") == pytest.approx(twice.indicator("spin_changes") / 2)
        wheel.place(0.1, x + np.array([0, 0, 0, 0, 0, 0, 0, 1e-19]))
        assert wheel.event().valuesOfContinuousStatesChanged == 1
        assert wheel.x()[-1] == 0


@pytest.mark.parametrize("mode", ["event", "continuous"])
@pytest.mark.parametrize(("torque", "ends"), [(20.0, False), (200.0, True)])
@pytest.mark.parametrize("s", [0.0, 0.003])
def test_a_brake_beyond_the_grip_ends_the_model_in_the_event_mode_that_decides_it(library, s, torque, ends, mode):
    """Upright: of a torque M the road takes m R M / (J_z + m R^2) in place of mu_max m g; the limit lies between."""
    with exchange(library, logging=True, s=s, mu_max=0.5, **{**AT_REST, "phi_dot_start": -20.0}) as wheel:
        wheel.place(0.1, wheel.x())
        if mode == "continuous":
            assert wheel.set(M_brake=torque) == OK
            assert wheel.wants_event() == (ends or s == 0)
        assert wheel.enterEventMode() == OK
        assert wheel.set(M_brake=torque) == OK
        assert bool(wheel.decide().terminateSimulation) == ends
        assert ("needs a friction coefficient above mu_max = 0.5 at t = 0.1 s" in "".join(wheel.sentences)) == ends


@pytest.mark.parametrize("theta", [0.0, -0.1, np.pi, 3.3])
def test_trial_states_beyond_flat_have_finite_derivatives_and_an_event(library: Library, theta: float) -> None:
    with exchange(library, s=0.03) as wheel:
        x = wheel.x()
        x[STATES.index("theta")] = theta
        wheel.place(0.1, x)
        assert np.isfinite(wheel.derivatives()).all()
        assert wheel.indicator("lies_flat") <= 0 and wheel.wants_event()
        assert wheel.event().terminateSimulation
        # Some importers enter continuous-time mode before they heed the event info: the wheel can be read there,
        # and has still ended.
        assert wheel.enterContinuousTimeMode() == OK
        assert np.isfinite(wheel.derivatives()).all()
        assert wheel.setTime(0.2) == ERROR


@pytest.mark.parametrize(("beyond_flat", "flat"), [(-0.1, 0.0), (3.3, np.pi)])
def test_beyond_flat_every_other_indicator_is_that_of_the_wheel_that_lies_flat(library, beyond_flat, flat) -> None:
    """A search between a state on either side would else follow forces of a wheel under the ground."""
    with exchange(library, s=0.03, mu_max=0.3) as wheel:
        found = []
        for theta in (beyond_flat, flat, abs(flat - 0.1)):
            wheel.place(0.3, np.where(ODD == 1.1, theta, ODD))
            found.append([wheel.indicator(event) for event in INDICATORS if event != "lies_flat"])
    assert found[0] == found[1]
    beyond(absolute_error(found[2], found[1]), 1e-4, "indicators of a wheel a tenth of a radian above the ground")


@pytest.mark.parametrize(
    ("theta", "F_Z", "ending"),
    [(1.2, -9.0, "needs a friction"), (1.2, 500.0, "lifted off"), (0.0, 500.0, "lies flat"), (0.0, -9.0, "lies flat")],
)
def test_of_endings_at_one_instant_the_last_of_the_list_counts(library: Library, theta, F_Z, ending) -> None:
    """Lost grip, lost contact, lying flat: each with all before it, where a wheel off the ground has no grip."""
    with exchange(library, logging=True, mu_max=0.5) as wheel:
        x = wheel.x()
        x[STATES.index("theta")] = theta
        wheel.place(0.1, x)
        assert wheel.set(F_Y=500.0, F_Z=F_Z) == OK
        lost = [event for event in ("lost_grip", "lost_contact", "lies_flat") if wheel.indicator(event) <= 0]
        assert wheel.event().terminateSimulation and f"The wheel {ending}" in wheel.sentences[-1]
        assert len(lost) >= ["needs a friction", "lifted off", "lies flat"].index(ending) + (F_Z > 0)


def test_an_end_in_the_mode_that_held_up_to_an_event_counts_though_the_next_mode_needs_less(library: Library) -> None:
    """A brake beyond the grip has brought the spin across zero, where a held wheel needs no force."""
    with exchange(library, mu_max=0.5, **{**AT_REST, "phi_dot_start": -20.0}) as wheel:
        x = wheel.x()
        for brake, ends in ((20.0, False), (200.0, True)):
            wheel.place(0.1, np.where(np.array(STATES) == "omega_z", -20.0, x))
            wheel.put(M_brake=20.0).event()
            wheel.place(0.2, np.where(np.array(STATES) == "omega_z", 1e-5, x))
            assert bool(wheel.put(M_brake=brake).event().terminateSimulation) == ends


@pytest.mark.parametrize("theta", [0.0, np.pi])
def test_a_wheel_that_lies_flat_has_ended_however_fast_it_rises(library: Library, theta: float) -> None:
    with exchange(library) as wheel:
        wheel.place(0.1, np.array([0, 0, 0, theta, 0, np.copysign(1e3, 1 - theta), 0, 0]))
        assert wheel.wants_event() and wheel.event().terminateSimulation


def test_the_clock_of_the_caller_is_that_of_the_messages_whatever_the_start_time(library: Library) -> None:
    for start in (0.0, -7.5, 1e5):
        with loaded(library).new(logging=True).start(start=start, s=0.03, **AT_REST) as wheel:
            assert wheel.decide() and wheel.enterContinuousTimeMode() == OK
            wheel.place(start + 0.5, wheel.x())
            wheel.put(M_3=50.0).event()
            assert wheel.texts() == [f"t = {start + 0.5:.15g} s: release, omega_z becomes positive."]


# theta in rad, the largest rate in rad/s; flat ones fall on either side.
FINITE = [(1.0, 10.0, -2.0, OK), (4.0, 10.0, 0.0, OK), (4.0, 10.0, -2.0, OK), (1.0, 1e200, -2.0, DISCARD)]


@pytest.mark.parametrize("state", ["theta_dot", "psi_dot"])
@pytest.mark.parametrize(("theta", "rate", "spin", "status"), FINITE)
def test_indicators_are_finite_wherever_the_derivatives_are_and_else_refused(
    library: Library, state: str, theta: float, rate: float, spin: float, status: int
) -> None:
    """The fuzzer moves the wheel to many more states."""
    with exchange(library, logging=True, s=0.03, theta_start=np.pi / 2, phi_dot_start=spin) as wheel:
        x = wheel.x()
        x[3], x[STATES.index(state)] = theta, rate
        wheel.place(0.1, x)
        z = (c_double * wheel.indicator_count)()
        assert wheel.ask("GetEventIndicators", z, len(z)) == wheel.ask("GetDerivatives", [0] * 8, 8) == status
        assert np.isfinite(z).all() == (status == OK)
        if status == OK:
            assert (z[INDICATORS.index("lies_flat")] <= 0) == (theta > np.pi)
        else:
            assert any(sentence.endswith("the indicators are not finite.") for sentence in wheel.sentences)


LIFTED = {"F_Z": 500.0, **AT_REST}
NO_START = {  # and those of contract/test_messages.py
    "At the start the wheel lifted off the road (N = -303.8 N, mu_required = inf)": LIFTED,
    "formulation = 3 (multibody): model exchange needs": {"formulation": "multibody"},
}


@pytest.mark.parametrize("fault", NO_START)
def test_a_start_that_model_exchange_cannot_have_is_refused_with_a_message(library: Library, fault: str) -> None:
    with loaded(library).new() as wheel:
        assert wheel.set(**NO_START[fault]) == OK and wheel.initialise() == ERROR
        assert wheel.said().startswith(fault)


def test_a_wheel_off_the_ground_at_the_start_is_taken_where_the_ground_may_pull(library: Library) -> None:
    with loaded(library).new(logging=True) as wheel:
        wheel.start(keep_contact=True, **LIFTED)
        assert wheel.get("lambda_3") == pytest.approx([-303.8])
        assert wheel.decide().valuesOfContinuousStatesChanged and "the road pulls" in wheel.sentences[-1]


def test_what_a_call_answers_replaces_whatever_its_record_and_its_flags_held(library: Library) -> None:
    with at_odd(library) as wheel:
        wheel.event()  # whatever has occurred at this place
        enter, terminate = (c_int(7) for _ in range(2))
        assert wheel.ask("CompletedIntegratorStep", 1, byref(enter), byref(terminate)) == OK
        assert (enter.value, terminate.value) == (0, 0)
        assert wheel.enterEventMode() == OK
        info = fmi2EventInfo.from_buffer_copy(b"\1" * sizeof(fmi2EventInfo))
        assert wheel.ask("NewDiscreteStates", byref(info)) == OK
        assert bytes(info) == bytes(fmi2EventInfo())


def test_where_the_start_has_failed_there_are_no_states_to_read(library: Library) -> None:
    with loaded(library).new() as wheel:
        assert wheel.set(theta_start=-1.0) == OK and wheel.initialise() == ERROR
        for what in ("ContinuousStates", "NominalsOfContinuousStates", "Derivatives"):
            values = (c_double * 8)(*ODD)
            assert wheel.ask(f"Get{what}", values, 8) == DISCARD and list(values) == ODD.tolist()


def test_wrong_arrays_and_numbers_are_refused_and_change_nothing(library: Library) -> None:
    with at_odd(library) as wheel:
        assert wheel.ask("SetContinuousStates", [0] * 7, 7) == ERROR
        for count in (0, wheel.indicator_count - 1, wheel.indicator_count + 1):
            assert wheel.ask("GetEventIndicators", [0] * count, count) == ERROR
        assert wheel.ask("SetContinuousStates", [np.nan] * 8, 8) == DISCARD
        assert wheel.setTime(np.inf) == ERROR
        assert (wheel.x() == ODD).all()


@pytest.mark.parametrize("state", STATES)
def test_a_state_that_is_set_must_be_a_finite_number(library: Library, state: str) -> None:
    with at_odd(library, s=0.02) as wheel:
        own, before, bits = ODD[STATES.index(state)], wheel.serialized(), wheel.bits()
        for value in (np.nan, np.inf, -np.inf):
            assert wheel.set(**{state: value}) == DISCARD
            assert wheel.said().endswith(f"a finite number is needed; the value stays {float(own)!r}."), state
        assert (wheel.x() == ODD).all() and (wheel.bits(), wheel.serialized()) == (bits, before)
        assert wheel.set(**{state: np.nextafter(own, 2)}) == OK  # the partner
        assert (wheel.x() != ODD).sum() == 1


@pytest.mark.parametrize("slope", [0.0, 0.3, 1.4, 1.57])
def test_the_indicator_of_contact_is_the_normal_force_over_the_weight(library: Library, slope) -> None:
    with exchange(library, slope=slope, **AT_REST) as wheel:
        assert wheel.indicator("lost_contact") == pytest.approx(np.cos(slope), abs=1e-8)
        assert wheel.set(F_Z=-10.0) == OK  # the partner
        assert wheel.indicator("lost_contact") == pytest.approx(np.cos(slope) + 10 / WEIGHT, abs=1e-8)


@pytest.mark.parametrize(("mu_max", "ends"), [(0.3, True), (0.6, False), (0.0, False)])
def test_another_limit_of_the_grip_is_decided_in_the_event_mode_that_sets_it(library: Library, mu_max, ends) -> None:
    """An upright wheel that F_X pushes requires |lambda_x| / N = 0.4 with F_X = 0.4 m g (1 + m R^2 / J_z)."""
    push = 0.4 * WEIGHT * (1 + 20 * 0.35**2 / 1.8)
    with exchange(library, theta_start=np.pi / 2, phi_dot_start=-3.0, mu_max=0.5, F_X=push, psi_start=0.0) as wheel:
        within(abs(wheel.get("mu_required")[0] - 0.4), 16 * EPSILON, "friction required")
        assert wheel.indicator("lost_grip") > 0
        assert wheel.enterEventMode() == OK
        wheel.put(mu_max=mu_max)
        assert bool(wheel.decide().terminateSimulation) == ends
        assert (wheel.indicator("lost_grip") > 0) == (not ends)


@pytest.mark.parametrize(("share", "mode"), [(1 - 1e-9, 0), (1 + 1e-9, 1)])
def test_a_held_wheel_is_released_in_the_event_mode_in_which_the_road_becomes_too_steep(library, share, mode) -> None:
    """Uphill is X: it rolls back, omega_z > 0. At once its acceleration is that of the new slope."""
    with exchange(library, **AT_REST, psi_start=0.0, s=0.03) as wheel:
        assert wheel.get("friction_mode", "omega_z_dot") == [0, 0.0]
        assert wheel.enterEventMode() == OK
        wheel.put(slope=np.arctan(0.03 / 0.35) * share).decide()
        assert wheel.get("friction_mode") == [mode] and (wheel.get("omega_z_dot")[0] > 0) == (mode > 0)


@pytest.mark.parametrize("mode", ["event", "continuous-time"])
def test_a_parked_wheel_that_the_slope_releases_and_stops_again_is_logged_and_counted(library, mode) -> None:
    with exchange(library, logging=True, **AT_REST, psi_start=0.0, s=0.03) as wheel:
        for slope, text in ((0.2, "release, omega_z becomes positive."), (0.0, "stick, omega_z is held at zero.")):
            wheel.take_messages()
            if mode == "event":
                assert wheel.enterEventMode() == OK
                wheel.put(slope=slope, slope_direction=slope)
                assert wheel.texts() == [] and wheel.decide().valuesOfContinuousStatesChanged
                assert wheel.enterContinuousTimeMode() == OK
            else:
                wheel.put(slope=slope)
            assert wheel.texts() == [f"t = 0 s: {text}"]
        assert wheel.get("n_events", "friction_mode") == [2, 0]


def test_nominal_values_are_the_scales_of_the_error(library: Library) -> None:
    """m: three heights of the upright wheel; rad. A fast wheel hardly tilts."""
    for start, tilt in (({}, 1), ({"phi_dot_start": -100.0}, 9.81 / 0.35 / 100**2)):
        with exchange(library, **start) as wheel:
            nominals = wheel.vector("NominalsOfContinuousStates")
        assert (nominals > 0).all()
        assert nominals[:5] == pytest.approx([1.05, 1.05, 3, tilt, 3])


def test_nominal_values_are_those_of_the_spin_reached(library: Library) -> None:
    with exchange(library) as wheel, exchange(library, phi_dot_start=-100.0) as fast:
        slow = wheel.vector("NominalsOfContinuousStates")
        wheel.place(0.1, fast.x())
        assert (wheel.vector("NominalsOfContinuousStates") == fast.vector("NominalsOfContinuousStates")).all()
        assert (wheel.vector("NominalsOfContinuousStates") != slow).any()


def test_nominal_rates_are_the_wheel_s_own_or_that_of_its_tilting_at_the_start_about_both_its_diameters(library):
    own, theta = (9.81 / 0.35) ** 0.5, 1.1
    for about_e1, about_e2, tilting in ((0.0, 0.0, own), (50.0, 0.0, 50), (0.0, -50.0, 50), (-30.0, 40.0, 50)):
        rates = {"theta_dot_start": about_e1, "psi_dot_start": about_e2 / np.sin(theta)}
        with exchange(library, theta_start=theta, keep_contact=True, **rates) as wheel:
            assert wheel.vector("NominalsOfContinuousStates")[5:] == pytest.approx([tilting] * 3)


def press(wheel: FMU2Wheel, share: float) -> None:
    """Sets F_Z so that N is this share of the weight: N is linear in it on either side of zero."""
    first = -9e3 if share > 0 else 9e3
    (N,), (slope,) = wheel.put(F_Z=first).get("lambda_3"), difference(wheel, ["lambda_3"], "F_Z", first, (0, 1))
    wheel.put(F_Z=first + (share * WEIGHT - N) / slope)
    assert wheel.get("lambda_3")[0] == pytest.approx(share * WEIGHT, rel=1e-6)


def on_its_side(wheel: FMU2Wheel, known: str, h: float) -> np.ndarray:
    """d REACTIONS / d known by a difference to that side on which |N| grows."""
    (growth,), (N,) = difference(wheel, ["lambda_3"], known, h, (0, 1)), wheel.get("lambda_3")
    return difference(wheel, REACTIONS, known, h if growth * N > 0 else -h, range(7))


def jacobian_error(wheel: FMU2Wheel, knowns: tuple[str, ...], h: float, share: float) -> float:
    """The largest difference, relative to the column, with N at this share of the weight."""
    press(wheel, share)
    want = np.array([on_its_side(wheel, known, h) for known in knowns]).T
    difference = np.abs(wheel.jacobian(REACTIONS, knowns) - want)
    return float((difference / (1e-9 + np.abs(want).max(axis=0))).max())


def test_a_second_decision_at_the_instant_at_which_the_ground_begins_to_pull_changes_nothing(library: Library) -> None:
    """N is still above zero, and falls to it so soon that the event counts as occurred."""
    with at_odd(library, s=0.02, keep_contact=True) as wheel:
        press(wheel, 1e-4)
        assert wheel.enterEventMode() == OK
        (F_Z, N), slope = wheel.get("F_Z", "lambda_3"), wheel.jacobian(["lambda_3"], ["F_Z"])[0, 0]
        wheel.put(F_Z=F_Z + (2e-9 * WEIGHT - N) / slope)
        assert wheel.indicator("lost_contact") > 0
        wheel.decide()
        decided = wheel.serialized()
        wheel.decide()
        assert wheel.serialized() == decided
        assert wheel.indicator("lost_contact") < 0 < wheel.get("lambda_3")[0]  # the partner: it has been decided


@pytest.mark.parametrize("seed", range(12))
def test_directional_derivatives_next_to_lift_off_are_those_of_the_wheels_side(library: Library, seed: int) -> None:
    rng = np.random.default_rng(seed)
    law = {"s": rng.uniform(0.01, 0.1), "keep_contact": True, "friction_law": rng.choice([1, 2]), "omega_s": 0.3}
    share = rng.choice([-1, 1]) * 10 ** rng.uniform(-6, -2)
    with at_odd(library, **law) as wheel, library.wheel().start(**{**GENERAL, **law, "psi_dot_start": 0.9}) as slave:
        wheel.place(0.3, ODD + rng.normal(0, 0.1, 8))
        within(jacobian_error(wheel, LOADS, 50.0, share), 1e-11, "by loads in model exchange, relative")
        within(jacobian_error(wheel, STATES[2:], 2e-3, share), 1e-8, "by states in model exchange, relative")
        within(jacobian_error(slave, LOADS, 50.0, share), 1e-11, "by loads in co-simulation, relative")
        want = on_its_side(wheel, "F_Z", 50.0)
        press(wheel, -share)  # the partner: the other side
        beyond(absolute_error(wheel.jacobian(REACTIONS, ("F_Z",))[:, 0], want), 1e-3, "by F_Z on the other side")


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6, 1e-9])
def test_directional_derivatives_keep_their_digits_on_a_slope_that_is_nearly_a_wall(library: Library, off) -> None:
    rng = np.random.default_rng(9)
    values = {"keep_contact": True, "slope": np.pi / 2 - off, "s": 0.03, "psi_dot_start": 0.5}
    for _ in range(10):
        with exchange(library, **values) as wheel:
            wheel.place(0.1, ODD + rng.normal(0, 0.1, 8))
            within(jacobian_error(wheel, LOADS, 50.0, rng.uniform(0.5, 5)), 1e-10, "derivatives on a wall, relative")
            exact = wheel.jacobian(REACTIONS, LOADS)
            wheel.place(0.1, ODD)  # the partner: another state
            beyond(np.abs(wheel.jacobian(REACTIONS, LOADS) - exact).max(), 1e-4, "derivatives in another state")


@pytest.mark.parametrize("theta", [np.pi / 2, 1.2])
def test_a_carrier_that_turns_by_its_states_has_the_forces_of_one_that_is_steered(
    library: Library, theta: float
) -> None:
    """Some importers perturb every state of a guided wheel, also the rates that stay zero on its own."""
    outputs = ("lambda_x", "lambda_y", "lambda_3", "M_guide_1", "M_guide_2", "v_x", "v_y", "omega_z_dot")
    start = {"guided": True, "theta_start": theta, "phi_dot_start": -10 / 0.35}
    steered = library.wheel().start(**start).put(psi_dot_guide=0.5, theta_dot_guide=0.3)
    with exchange(library, **start) as wheel:
        x = wheel.x()
        x[STATES.index("theta_dot")], x[STATES.index("psi_dot")], x[STATES.index("omega_z")] = steered.get(
            "theta_dot", "psi_dot", "omega_z"
        )
        assert (x[STATES.index("psi_dot")], x[STATES.index("theta_dot")]) == (0.5, 0.3)
        wheel.place(0.1, x)
        found, want = np.array(wheel.get(*outputs)), np.array(steered.get(*outputs))
        within(np.abs(found - want).max(), 1e-11, "forces, moments and rates apart")
        still = exchange(library, **start)
        beyond(np.abs(np.array(still.get(*outputs)) - want).max(), 10, "forces and moments of one that does not turn")
        still.close()


# ---- readings between calls ----


def test_a_value_that_was_read_follows_the_states_that_are_set_next(library: Library) -> None:
    """By one call alone: no other of the kind is between the two readings."""
    names = ("theta", "X_O", "lambda_3", "psi_ddot", "E")
    for state in STATES[2:]:  # the place alone moves neither force nor acceleration
        with at_odd(library, s=0.02) as wheel, at_odd(library, s=0.02) as fresh:
            before, x = wheel.get(*names), ODD + 0.1 * (np.array(STATES) == state)
            assert wheel.ask("SetContinuousStates", x, len(x)) == OK
            fresh.place(0.3, x)
            assert wheel.get(*names) == fresh.get(*names)
            assert wheel.get(*names) != before or state in ("psi", "phi")


def test_a_reading_has_the_law_before_an_input_until_the_event_mode_decides_and_then_the_new_one(library) -> None:
    """A held wheel: the moment that holds it is of any size, and M_3 = 50 N m is beyond s N."""
    names = ("friction_mode", "omega_z_dot", "tau")
    with exchange(library, s=0.03, **AT_REST) as wheel:
        assert wheel.get("friction_mode") == [0]
        assert wheel.put(M_3=50.0).get(*names) == pytest.approx([0, 0.0, -50.0])
        assert wheel.derivatives()[-1] == 0 and wheel.indicator("spin_changes") < 0
        assert wheel.enterEventMode() == OK
        assert wheel.put(M_3=51.0).get(*names) == pytest.approx([0, 0.0, -51.0])
        wheel.decide()
        tau = -0.03 * WEIGHT
        assert wheel.get(*names) == pytest.approx([1, (51.0 + tau) / (1.8 + 20 * 0.35**2), tau])


def test_each_question_of_a_solver_is_counted_when_it_is_asked(library: Library) -> None:
    with at_odd(library, s=0.02) as wheel:
        for ask, counted in ((wheel.derivatives, [1, 0]), (wheel.indicators, [0, 1]), (wheel.wants_event, [0, 1])):
            before = wheel.get("n_rhs", "n_roots")
            ask()
            assert np.subtract(wheel.get("n_rhs", "n_roots"), before).tolist() == counted


def test_a_brake_that_is_not_in_use_has_no_moment_until_an_event_gives_it_a_law(library: Library) -> None:
    with exchange(library) as wheel:
        assert not wheel.jacobian(["tau", "tau_brake", "omega_z_dot"], ["M_brake"]).any()
        assert not wheel.wants_event() and wheel.put(M_brake=1.0).wants_event()
        wheel.event()
        assert wheel.jacobian(["tau_brake"], ["M_brake"]) == pytest.approx(1)  # omega_z < 0


def test_until_an_event_decides_the_moment_of_a_brake_let_off_is_that_of_one_that_hardly_presses(library) -> None:
    """Without rolling resistance all that holds the wheel is the brake's, however weak it is."""
    with exchange(library, M_brake=50.0, M_3=30.0, **AT_REST) as wheel:
        for brake in (50.0, 1e-9, 0.0):
            assert wheel.put(M_brake=brake).get("tau", "tau_brake") == pytest.approx([-30.0, -30.0])
        wheel.event()
        assert wheel.get("tau", "tau_brake") == [0.0, 0.0]
