"""Faulty parameters: told all together, one sentence each, at the end of initialization; correcting them helps."""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, within
from support.driver import DISCARD, ERROR, OK, WARNING, FMU2Wheel

NUMBER = "a finite number is needed."
FAULTS: dict[str, tuple[float, str]] = {
    "m": (np.nan, f"m = nan: {NUMBER}"),
    "r_0": (np.inf, f"r_0 = inf: {NUMBER}"),
    "r": (-0.01, "r = -0.01: it must be at least 0."),
    "J_z": (2.5, "J_x, J_y, J_z = 0.9, 0.9, 2.5 kg m2: none may exceed the sum of the other two."),
    "g": (-9.81, "g = -9.81: it must be at least 0."),
    "s": (-0.03, "s = -0.03: it must be at least 0."),
    "psi_start": (-np.inf, f"psi_start = -inf: {NUMBER}"),
    "theta_start": (-0.1, "theta_start = -0.1 rad: the wheel must stand above the ground, 0 < theta < 3.14159."),
    "phi_dot_start": (np.nan, f"phi_dot_start = nan: {NUMBER}"),
    "formulation": (4, "formulation = 4: it must be at most 3."),
    "friction_law": (0, "friction_law = 0: it must be at least 1."),
    "omega_s": (0.0, "omega_s = 0: it must be greater than 0."),
    "method": (-1, "method = -1: it must be at least 1."),
    "M_2": (np.nan, f"M_2 = nan: {NUMBER}"),
}


def initialize(w: FMU2Wheel, **values: float) -> tuple[int, list[str]]:
    """The status of fmi2ExitInitializationMode and what was logged."""
    status = w.initializing(**values).exitInitializationMode()
    messages = w.take_messages()
    assert all((m.status, m.category) == (ERROR, "logStatusError") for m in messages)
    return status, [m.text for m in messages]


def test_all_faults_are_told_at_once_one_sentence_each(wheel):
    status, told = initialize(wheel(), **{name: value for name, (value, _) in FAULTS.items()})
    assert status == ERROR
    assert sorted(told) == sorted(sentence for _, sentence in FAULTS.values())


@pytest.mark.parametrize("name", FAULTS)
def test_each_fault_alone_is_told_and_after_a_reset_and_a_correction_the_wheel_runs(wheel, name):
    value, sentence = FAULTS[name]
    w = wheel()
    assert initialize(w, **{name: value}) == (ERROR, [sentence])
    assert w.get_one("theta")[0] == ERROR and "theta" in w.take_messages()[0].text
    assert w.reset() == OK
    assert initialize(w) == (OK, [])
    w.time = 0.0
    assert w.run([1.0]) == wheel().start().run([1.0])


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"theta_start": 0.0}, "theta_start = 0 rad"),
        ({"theta_start": np.pi}, "theta_start = 3.14159265 rad"),
        ({"theta_start": 4.0}, "theta_start = 4 rad"),
        ({"m": 0.0}, "m = 0: it must be greater than 0."),
        ({"m": -1 / 3}, "m = -0.333333333: it must be greater than 0."),
        ({"r_0": -0.3}, "r_0 = -0.3: it must be greater than 0."),
        ({"J_x": -1e-9}, "J_x = -1e-09: it must be greater than 0."),
        ({"J_x": 0.0}, "J_x = 0: it must be greater than 0."),
        ({"J_x": 3.0}, "J_x, J_y, J_z = 3, 0.9, 1.8 kg m2"),
    ],
)
def test_impossible_wheels_are_refused_and_their_neighbours_roll(wheel, values, told):
    status, sentences = initialize(wheel(), **values)
    assert status == ERROR
    assert any(sentence.startswith(told) for sentence in sentences)
    neighbours = {"theta_start": 3.1, "m": 1e-3, "r_0": 0.01, "J_x": 0.95}
    name = next(iter(values))
    assert initialize(wheel(), **{name: neighbours[name]}) == (OK, [])


def test_the_limits_that_are_allowed_are_taken(wheel):
    """The thin disc, no weight, a flat disc's inertia J_z = J_x + J_y to rounding."""
    for values in ({"r": 0.0}, {"g": 0.0, "keep_contact": 1}, {"J_x": 0.9 * (1 - 1e-16), "J_z": 1.8}):
        assert initialize(wheel(), **values) == (OK, []), values
    assert initialize(wheel(), J_z=1.8 * (1 + 1e-11))[0] == ERROR


@pytest.mark.parametrize("s", [0.0, 0.03])
def test_a_weight_that_moves_nothing_is_none(wheel, s):
    """The time scale sqrt((r_0 + r) / g) of a wheel in motion is no measure of it where g is next to nothing."""
    places = []
    for g in (0.0, 1e-300):
        places.append(wheel().start(g=g, s=s).by(5.0).get("X_O", "theta", "psi", "phi"))
    within(absolute_error(places[0], places[1]), 64 * EPSILON, "places")


@pytest.mark.parametrize("most", ["psi_dot_start", "theta_dot_start", "phi_dot_start"])
def test_without_a_weight_rates_of_a_thousand_times_give_the_same_motion_as_much_faster(wheel, most):
    """To the bit, since the factor is 1024: nothing else has a time of its own."""
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
    assert [m.text for m in w.take_messages()] == ["m = -1: it must be greater than 0."]
    assert w.put(m=20.0).get("lambda_3") == at_start
    assert (w.exitInitializationMode(), w.take_messages()) == (OK, [])
    assert w.get("lambda_3") == at_start
    assert w.get("lambda_3") != wheel().start(m=20.1).get("lambda_3")


def test_parameters_and_inputs_set_in_initialization_mode_act_at_once(wheel):
    late, early = wheel().initializing(), wheel().start(theta_start=1.0, s=0.02, F_X=3.0)
    assert late.bits() != early.bits()
    assert late.put(theta_start=1.0, s=0.02, F_X=3.0).bits() == early.bits()
    assert late.exitInitializationMode() == OK
    assert late.run([1.0]) == early.run([1.0])


@pytest.mark.parametrize(("given", "used"), [(0.1, "0.0001"), (np.inf, "0.0001"), (1e-16, "1e-13")])
def test_a_tolerance_beyond_the_limits_is_clamped_with_one_warning(wheel, given, used):
    w, at_limit = wheel(), wheel().start(tolerance=float(used))
    assert w.setupExperiment(given) in (OK, WARNING)
    (message,) = w.take_messages()
    assert (message.status, message.category) == (WARNING, "logStatusWarning")
    assert message.text == f"The tolerance {given:g} is outside [1e-13, 0.0001]; {used} is used."
    assert (w.enterInitializationMode(), w.exitInitializationMode()) == (OK, OK)
    assert w.run([0.5]) == at_limit.run([0.5])
    assert w.bits() != wheel().start().run([0.5])[0]
    assert at_limit.take_messages() == w.take_messages() == []


def test_experiments_that_make_no_sense_are_refused(wheel):
    w = wheel()
    for tolerance, start, stop in [(None, np.nan, None), (None, 0, -1), (None, 0, np.nan), (-1e-6, 0, None)]:
        assert w.setupExperiment(tolerance, start, stop) == ERROR
        assert len(w.take_messages()) == 1
    assert w.setupExperiment(np.nan) == ERROR
    assert w.setupExperiment(1e-8, 0.0, 0.0) == OK


def test_sound_values_whose_products_are_no_numbers_are_refused_with_a_sentence(wheel):
    w = wheel().initializing(m=1.7e308)
    assert w.exitInitializationMode() == ERROR
    assert [m.text.split(":")[0] for m in w.take_messages()] == ["The initial energy or reaction force overflows"]
    assert wheel().start(m=1e100, J_x=1e100, J_y=1e100, J_z=1.5e100).step(0.1) == OK
