"""Bad input is refused sentence by sentence and can be mended; the communication grid changes no bit."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.driver import ERROR, OK, Values
from support.motion import Library

from robustness import checks


def test_bad_input_is_refused_with_a_sentence_per_fault_and_the_instance_lives(library: Library) -> None:
    assert [check for check in checks.refusals(library) if not check[-1]] == []


@pytest.mark.parametrize("name", checks.REFUSED)
def test_every_refused_value_has_a_neighbour_that_is_accepted(library: Library, name: str) -> None:
    values, _ = checks.REFUSED[name]
    sound = {"m": 20.0, "g": 0.0, "r": 0.0, "s": 0.0, "omega_s": 1e-9, "formulation": "reduced"}
    with library.wheel() as wheel:
        assert wheel.set(**{key: sound[key] for key in values if key in sound}) == OK
        assert wheel.initialise() == OK
        assert wheel.sentences == []


def test_the_communication_grid_changes_no_bit(library: Library) -> None:
    assert [check for check in checks.communication(library) if not check[-1]] == []


def test_another_tolerance_changes_the_bits(library: Library) -> None:
    grid = np.array([0.0, 10.0])
    same, other = (checks.final_state(library, checks.FRICTION, grid, t) for t in (1e-8, 1.0000001e-8))
    assert same != other


def test_tolerances_beyond_the_limits_are_clamped_and_said(library: Library) -> None:
    assert [check for check in checks.tolerances(library) if not check[-1]] == []
    with library.wheel() as wheel:
        assert wheel.initialise(1e-6) == OK
        assert wheel.sentences == []


def test_watching_for_lift_off_adds_no_evaluation_where_none_can_occur(library: Library) -> None:
    counts = []
    for keep in (False, True):
        with library.wheel() as wheel:
            wheel.set(**{"keep_contact": keep})
            wheel.initialise()
            wheel.step_to(10.0)
            counts.append(wheel.get("n_steps", "n_rhs", "n_roots"))
    assert counts[0] == counts[1]
    assert counts[0][2] == 0
    with library.wheel() as wheel:
        wheel.set(**{"s": 0.03})
        wheel.initialise()
        wheel.step_to(10.0)
        assert wheel.get("n_roots")[0] > 0  # friction has something to watch


MILLION = 1_000_000


@pytest.mark.parametrize("load", [{"M_3": 1e13}, {"F_X": 1e80}])
def test_a_step_under_an_enormous_load_ends_in_bounded_time_and_says_why(library: Library, load: Values) -> None:
    with library.wheel() as wheel:
        assert wheel.set(**{"s": 0.03, "keep_contact": True}) == wheel.initialise() == wheel.set(**load) == OK
        assert wheel.step_to(0.01) == ERROR
        assert re.fullmatch(r"The solver stopped at t = \S+ s, where omega_z = \S+ rad/s: .+\.", wheel.sentences[-1])
        assert wheel.get("n_steps")[0] < 1.001 * MILLION


def test_one_call_takes_at_most_a_million_internal_steps_and_shorter_calls_go_on(library: Library) -> None:
    values: Values = {"phi_dot_start": 1e4, "s": 1e-9}
    with library.wheel() as wheel, library.wheel() as careful:
        assert wheel.set(**values) == careful.set(**values) == OK
        assert wheel.initialise() == careful.initialise() == OK
        assert wheel.step_to(40.0) == ERROR
        assert wheel.sentences[-1].endswith("may take no more internal steps; use shorter communication steps.")
        for t in (5.0, 10.0):
            assert careful.step_to(t) == OK
