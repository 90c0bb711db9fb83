"""Faulty parameters: reported all together, one message each, at the end of initialization; correcting them helps."""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, within
from support.refusals import ABOVE, REFUSALS

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, WARNING, FMU2Wheel, Value


def initialize(w: FMU2Wheel, **values: Value) -> tuple[int, list[str]]:
    """The status of fmi2ExitInitializationMode and what was logged as errors."""
    status = w.initializing(**values).exitInitializationMode()
    messages = w.take_messages()
    assert all(m.category in ("logStatusError", "logStatusWarning") for m in messages)
    return status, [m.text for m in messages if m.status == ERROR]


def test_all_faults_are_reported_at_once_one_message_each(wheel):
    start, texts = dict[str, Value](), []
    for values, text, _ in REFUSALS:
        if not {*start} & {*values}:
            start |= values
            texts.append(text)
    status, logged = initialize(wheel(), **start)
    assert status == ERROR and len(logged) > 15
    assert sorted(logged) == sorted(texts)


@pytest.mark.parametrize(("start", "text", "near"), REFUSALS, ids=[str(start) for start, *_ in REFUSALS])
def test_each_fault_is_reported_and_after_a_reset_and_a_correction_the_wheel_runs(wheel, start, text, near):
    w = wheel()
    assert initialize(w, **start) == (ERROR, [text])
    assert w.get_one("theta")[0] == ERROR and "theta" in w.said()
    assert w.reset() == OK
    assert initialize(w, **near) == (OK, [])
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
    assert w.get_one("lambda_3")[0] == DISCARD and w.texts() == []  # logged once, and once where it was restored
    assert w.back(w.serialized()).get_one("lambda_3")[0] == DISCARD and w.said() == f"m = -1: {ABOVE}"
    assert w.put(m=20.0, r_0=-1.0).get_one("lambda_3")[0] == DISCARD
    assert w.texts() == [f"r_0 = -1: {ABOVE}"]  # a second fault, after the first
    w.put(r_0=0.3)
    assert w.put(m=20.0).get("lambda_3") == at_start
    assert (w.exitInitializationMode(), w.take_messages()) == (OK, [])
    assert w.get("lambda_3") == at_start != wheel().start(m=20.1).get("lambda_3")


def test_parameters_and_inputs_set_in_initialization_mode_act_at_once(wheel):
    late, early = wheel().initializing(), wheel().start(theta_start=1.0, s=0.02, F_X=3.0)
    assert late.bits() != early.bits()
    assert late.put(theta_start=1.0, s=0.02, F_X=3.0).bits() == early.bits()
    assert late.exitInitializationMode() == OK
    assert late.run([1.0]) == early.run([1.0])


TAKEN: list[tuple[float | None, float]] = [(1e-13, 1e-13), (1e-8, 1e-8), (None, 1e-8), (1e-4, 1e-4)]
CLAMPED: list[tuple[float | None, float]] = [(1e-16, 1e-13), (9.99e-14, 1e-13)]
CLAMPED += [(given, 1e-4) for given in (1.001e-4, 0.1, 1e300, np.inf)]


@pytest.mark.parametrize(("given", "used"), TAKEN + CLAMPED)
def test_a_tolerance_beyond_the_limits_is_clamped_with_one_warning_and_any_other_is_taken(wheel, given, used):
    w, other = wheel().start(tolerance=given), wheel().start(tolerance=used)
    text = f"The tolerance {given} is outside [1e-13, 0.0001]; {used} is used."
    warned = [(WARNING, "logStatusWarning", text)] if (given, used) in CLAMPED else []
    assert w.take_messages() == warned
    assert w.run([0.5]) == other.run([0.5]) != wheel().start(tolerance=1e-10).run([0.5])
    assert other.take_messages() == w.take_messages() == []


def test_experiments_that_make_no_sense_are_refused_and_an_infinite_stop_time_is_none(wheel):
    w = wheel()
    for tolerance, start, stop in [(None, np.nan, None), (None, 0, -1), (None, 0, np.nan), (-1e-6, 0, None)]:
        assert w.setupExperiment(tolerance, start, stop) == ERROR
        assert len(w.take_messages()) == 1
    assert w.setupExperiment(np.nan) == ERROR
    assert w.setupExperiment(1e-8, 0.0, 0.0) == OK
    endless = wheel().start(stop=np.inf).by(2.0)
    assert wheel().back(endless.serialized()).bits() == endless.bits()
