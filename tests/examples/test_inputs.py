"""What inputs cost: equal values change nothing, derivatives bring the error down by their order."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from vehicles import inputs
from vehicles.inputs import Outcome

STOP = 2.0  # s


@pytest.fixture(scope="module")
def outcomes(fmus: dict[str, Path]) -> dict[str, Outcome]:
    return {o.label: o for o in inputs.measure(fmus["wheel"], STOP, repeats=1)}


def test_setting_an_input_to_the_value_it_has_changes_no_bit(outcomes: dict[str, Outcome]) -> None:
    once, again = outcomes["constant, set once"], outcomes["constant, set again at every step"]
    assert np.array_equal(once.table, again.table)
    assert (once.steps, once.rhs, once.restarts) == (again.steps, again.rhs, again.restarts)
    assert again.restarts == 0
    assert not np.array_equal(once.table, outcomes["never set"].table)  # partner: the constant does act


def test_held_values_restart_at_every_change(outcomes: dict[str, Outcome]) -> None:
    assert outcomes["sines, held over the step"].restarts == round(STOP / inputs.STEP) - 1


def test_derivatives_bring_the_error_down(outcomes: dict[str, Outcome]) -> None:
    held, line = outcomes["sines, held over the step"].error, outcomes["sines, first derivative given"].error
    assert held > 1e-4  # measured 2.3e-4: the sine lags by half a step
    assert line < held / 100  # measured 6.0e-7


def test_small_misses_of_a_smooth_input_do_not_cost_accuracy(outcomes: dict[str, Outcome]) -> None:
    """With derivatives up to order 2 the sine misses by h^3/6 of its third derivative at each communication point."""
    smooth = outcomes["sines, derivatives up to order 2"]
    assert smooth.error < 3e-8  # the tolerance is 1e-8; measured 1.2e-8
    assert outcomes["sines, first derivative given"].error > 3e-8  # partner: straight lines miss it, 6.0e-7
