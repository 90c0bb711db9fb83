"""Faulty parameters: reported all together, one message each, at the end of initialization; correcting them helps."""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, within

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, WARNING, FMU2Wheel

NUMBER, ABOVE = "a finite number is needed.", "it must be greater than 0."
TRIANGLE = "kg m2: none may exceed the sum of the other two."
STANDS = "the wheel must stand above the ground, 0 < theta < 3.14159."
# Name, value, the message, and a value next to it that is taken.
FAULTS: list[tuple[str, float, str, float]] = [
    ("m", np.nan, f"m = nan: {NUMBER}", 1e-3),
    ("r_0", np.inf, f"r_0 = inf: {NUMBER}", 0.01),
    ("r", -0.01, "r = -0.01: it must be at least 0.", 0.0),  # the thin disc
    ("J_z", 2.5, f"J_x, J_y, J_z = 0.9, 0.9, 2.5 {TRIANGLE}", 1.8 * (1 + 2e-16)),
    ("g", -9.81, "g = -9.81: it must be at least 0.", 1e-300),
    ("s", -0.03, "s = -0.03: it must be at least 0.", 0.0),
    ("psi_start", -np.inf, f"psi_start = -inf: {NUMBER}", 7.0),
    ("theta_start", -0.1, f"theta_start = -0.1 rad: {STANDS}", 3.1),
    ("phi_dot_start", np.nan, f"phi_dot_start = nan: {NUMBER}", 0.0),
    ("formulation", 4, "formulation = 4: it must be at most 3.", 3),
    ("friction_law", 0, "friction_law = 0: it must be at least 1.", 1),
    ("omega_s", 0.0, f"omega_s = 0: {ABOVE}", 1e-9),
    ("method", -1, "method = -1: it must be at least 1.", 1),
    ("M_2", np.nan, f"M_2 = nan: {NUMBER}", 1.0),
]
ALONE = [
    ("theta_start", 0.0, f"theta_start = 0 rad: {STANDS}", 3.1),
    ("theta_start", np.pi, f"theta_start = 3.14159265 rad: {STANDS}", 3.1),
    ("J_x", 3.0, f"J_x, J_y, J_z = 3, 0.9, 1.8 {TRIANGLE}", 0.95),
    ("slope", np.pi / 2, "slope = 1.57079633 rad: it must be less than 1.5708.", 1.5),
    ("J_z", 1.8 * (1 + 1e-11), f"J_x, J_y, J_z = 0.9, 0.9, 1.8 {TRIANGLE}", 1.8 * (1 + 2e-16)),
]


def initialize(w: FMU2Wheel, **values: float) -> tuple[int, list[str]]:
    """The status of fmi2ExitInitializationMode and what was logged."""
    status = w.initializing(**values).exitInitializationMode()
    messages = w.take_messages()
    assert all((m.status, m.category) == (ERROR, "logStatusError") for m in messages)
    return status, [m.text for m in messages]


def test_all_faults_are_reported_at_once_one_message_each(wheel):
    status, logged = initialize(wheel(), **{name: value for name, value, *_ in FAULTS})
    assert status == ERROR
    assert sorted(logged) == sorted(text for _, _, text, _ in FAULTS)


@pytest.mark.parametrize(("name", "value", "text", "near"), FAULTS + ALONE)
def test_each_fault_is_reported_and_after_a_reset_and_a_correction_the_wheel_runs(wheel, name, value, text, near):
    w = wheel()
    status, logged = initialize(w, **{name: value})
    assert status == ERROR and text in logged
    assert w.get_one("theta")[0] == ERROR and "theta" in w.said()
    assert w.reset() == OK
    assert initialize(w, **{name: near}) == (OK, [])
    assert w.reset() == OK
    assert w.start().run([1.0]) == wheel().start().run([1.0])


@pytest.mark.parametrize("s", [0.0, 0.03])
def test_a_weight_that_moves_nothing_is_none(wheel, s):
    """The time scale sqrt((r_0 + r) / g) of a wheel in motion is no measure of it where g is next to nothing."""
    places = [wheel().start(g=g, s=s).by(5.0).get("X_O", "theta", "psi", "phi") for g in (0.0, 1e-300)]
    within(absolute_error(*places), 64 * EPSILON, "places apart, m, rad")


@pytest.mark.parametrize("most", ["psi_dot_start", "theta_dot_start", "phi_dot_start"])
def test_without_a_weight_rates_of_a_thousand_times_give_the_same_motion_as_much_faster(wheel, most):
    """To the bit, since the factor is 1024: nothing else has a time scale."""
    places = []
    for faster in (1, 1024):
        rates = {f"{angle}_dot_start": faster * 0.25 for angle in ("psi", "theta", "phi")} | {most: 2.0 * faster}
        w = wheel().start(g=0.0, keep_contact=True, J_x=0.95, s=0.03, **rates).by(0.5 / faster)
        places.append(w.get("X_O", "theta", "psi", "phi", "n_steps"))
    assert places[0] == places[1]


def test_faulty_parameters_can_be_corrected_in_initialization_mode_also_in_a_restored_state(wheel):
    w = wheel().initializing()
    at_start = w.get("lambda_3")
    w.put(m=-1.0).back(w.serialized())
    assert w.get_one("lambda_3")[0] == DISCARD
    assert w.said() == f"m = -1: {ABOVE}"
    assert w.put(m=20.0).get("lambda_3") == at_start
    assert (w.exitInitializationMode(), w.take_messages()) == (OK, [])
    assert w.get("lambda_3") == at_start != wheel().start(m=20.1).get("lambda_3")


def test_parameters_and_inputs_set_in_initialization_mode_act_at_once(wheel):
    late, early = wheel().initializing(), wheel().start(theta_start=1.0, s=0.02, F_X=3.0)
    assert late.bits() != early.bits()
    assert late.put(theta_start=1.0, s=0.02, F_X=3.0).bits() == early.bits()
    assert late.exitInitializationMode() == OK
    assert late.run([1.0]) == early.run([1.0])


@pytest.mark.parametrize(("given", "used"), [(0.1, "0.0001"), (np.inf, "0.0001"), (1e-16, "1e-13")])
def test_a_tolerance_beyond_the_limits_is_clamped_with_one_warning(wheel, given, used):
    w, at_limit = wheel().start(tolerance=given), wheel().start(tolerance=float(used))
    text = f"The tolerance {given:g} is outside [1e-13, 0.0001]; {used} is used."
    assert w.take_messages() == [(WARNING, "logStatusWarning", text)]
    assert w.run([0.5]) == at_limit.run([0.5]) != wheel().start().run([0.5])
    assert at_limit.take_messages() == w.take_messages() == []


def test_a_guided_wheel_that_keeps_the_papers_heading_and_tilt_logs_it_once(wheel):
    w = wheel().start(guided=True, phi_dot_start=-20.0)
    ((status, category, text),) = w.take_messages()
    assert (status, category) == (WARNING, "logStatusWarning") and "psi_start = 0 and theta_start = pi/2" in text
    assert w.by(0.1).take_messages() == []
    for meant in ({"psi_start": 0.0}, {"theta_start": np.pi / 2}, {"guided": False}):
        assert wheel().start(**{"guided": True, "phi_dot_start": -20.0} | meant).take_messages() == []


def test_experiments_that_make_no_sense_are_refused_and_an_infinite_stop_time_is_none(wheel):
    w = wheel()
    for tolerance, start, stop in [(None, np.nan, None), (None, 0, -1), (None, 0, np.nan), (-1e-6, 0, None)]:
        assert w.setupExperiment(tolerance, start, stop) == ERROR
        assert len(w.take_messages()) == 1
    assert w.setupExperiment(np.nan) == ERROR
    assert w.setupExperiment(1e-8, 0.0, 0.0) == OK
    endless = wheel().start(stop=np.inf).by(2.0)
    assert wheel().back(endless.serialized()).bits() == endless.bits()


def test_sound_values_whose_products_are_no_numbers_are_refused_with_a_message(wheel):
    status, logged = initialize(wheel(), m=1.7e308)
    assert status == ERROR
    assert [text.split(":")[0] for text in logged] == ["The initial energy or reaction force overflows"]
    assert wheel().start(m=1e100, J_x=1e100, J_y=1e100, J_z=1.5e100).step(0.1) == OK
