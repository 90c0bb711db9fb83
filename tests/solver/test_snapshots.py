"""Histories of the solver alone: restored they go on with the same bits; what could not have been saved is refused."""

import pytest
from support.bounds import within


@pytest.mark.parametrize("steps", [0, 1, 2, 7, 60, 300])
def test_a_restored_solver_goes_on_with_the_same_bits(measure, method, steps):
    run = measure("snapshots", method, steps)
    assert run["restored"] and run["again"] and run["reads"] and run["same"] and run["back"]


def test_a_history_is_small(measure, method):
    within(measure("snapshots", method, 60)["bytes"], 4096, "bytes")


def test_forged_histories_are_refused_or_harmless(measure, method):
    """Each word replaced by integers and doubles of every kind; those that are taken could have been saved.

    A step known to its half is refused, and a solver that has refused a history starts as a new one does.
    """
    run = measure("forgeries", method)
    assert [run[kind] for kind in ("not_numbers", "cut", "half_known", "stained")] == [0, 0, 0, 0]
    within(run["taken"] / run["tried"], 0.65, "taken")  # other states, counts and sizes are possible
    assert run["stepped"] > 0
