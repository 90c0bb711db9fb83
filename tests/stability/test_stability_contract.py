"""Bad input is refused sentence by sentence and can be mended; the communication grid changes no bit."""

from __future__ import annotations

import numpy as np
import pytest
from stability_report import contract
from stability_report.driver import OK, Library, Wheel


def test_bad_input_is_refused_with_a_sentence_per_fault_and_the_instance_lives(library: Library) -> None:
    assert [check for check in contract.refusals(library) if not check[-1]] == []


@pytest.mark.parametrize("name", contract.REFUSED)
def test_every_refused_value_has_a_neighbour_that_is_accepted(library: Library, name: str) -> None:
    values, _ = contract.REFUSED[name]
    sound = {"m": 20.0, "g": 0.0, "r": 0.0, "s": 0.0, "omega_s": 1e-9, "formulation": "reduced"}
    with Wheel(library) as wheel:
        assert wheel.set({key: sound[key] for key in values if key in sound}) == OK
        assert wheel.initialise() == OK
        assert wheel.messages == []


def test_the_communication_grid_changes_no_bit(library: Library) -> None:
    assert [check for check in contract.communication(library) if not check[-1]] == []


def test_another_tolerance_changes_the_bits(library: Library) -> None:
    grid = np.array([0.0, 10.0])
    same, other = (contract.final_state(library, contract.FRICTION, grid, t) for t in (1e-8, 1.0000001e-8))
    assert same != other


def test_tolerances_beyond_the_limits_are_clamped_and_said(library: Library) -> None:
    assert [check for check in contract.tolerances(library) if not check[-1]] == []
    with Wheel(library) as wheel:
        assert wheel.initialise(1e-6) == OK
        assert wheel.messages == []


def test_watching_for_lift_off_adds_no_evaluation_where_none_can_occur(library: Library) -> None:
    counts = []
    for keep in (False, True):
        with Wheel(library) as wheel:
            wheel.set({"keep_contact": keep})
            wheel.initialise()
            wheel.step_to(10.0)
            counts.append(wheel.integers(("n_steps", "n_rhs", "n_roots")))
    assert counts[0] == counts[1]
    assert counts[0][2] == 0
    with Wheel(library) as wheel:
        wheel.set({"s": 0.03})
        wheel.initialise()
        wheel.step_to(10.0)
        assert wheel.integers(("n_roots",))[0] > 0  # friction has something to watch
