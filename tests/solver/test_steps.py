"""Steps and dense output of the solver alone: order, accuracy, grids, stops, failures."""

from math import log2

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within


def test_halving_the_step_shows_order_8_at_the_ends_and_7_inside(measure):
    coarse, fine = (measure("order", "runge_kutta", h) for h in (0.4, 0.2))
    within(abs(log2(coarse["at_ends"] / fine["at_ends"]) - 8.3), 0.7, "at_ends")
    within(abs(log2(coarse["inside"] / fine["inside"]) - 8.2), 0.8, "inside")  # local order 8


def test_the_error_of_a_harmonic_oscillator_stays_within_the_tolerance(measure, method):
    tolerance = 1e-8
    loose, tight = (measure("accuracy", method, t, 20.0) for t in (1e-4, tolerance))
    within(tight["error"] / tolerance, 5, "error")
    beyond(loose["error"] / tight["error"], 90, "error")
    assert loose["steps"] < tight["steps"]


def test_the_reading_grid_changes_no_bit_and_no_count(measure, method):
    coarse, fine = (measure("grid", method, points) for points in (1, 1000))
    assert coarse == fine


def test_other_tolerances_change_the_counts_that_grids_do_not(measure, method):
    assert measure("accuracy", method, 1e-6, 20.0)["rhs"] != measure("accuracy", method, 1e-8, 20.0)["rhs"]


@pytest.mark.parametrize("gap", [1e-1 / 3, 1e-3, 1e-6, 1e-9, 1e-12, 1e-13, 1e-15])
def test_a_step_cut_at_any_instant_leaves_the_error_within_the_tolerance(measure, method, gap):
    cut = measure("cuts", method, gap)
    assert cut["exact"]
    stops = 400 if gap > 1e-12 else 200  # closer instants are the same one
    assert method == "runge_kutta" or cut["restarts"] >= stops - 1  # a history over nodes this close is dropped
    within(cut["error"], 10e-8, "error")


def test_after_a_change_runge_kutta_steps_no_further_than_the_last_interval_and_then_remembers(measure):
    sizes = measure("first_step", "runge_kutta", 0.01)
    within(relative_error(sizes["limited"], 0.01), 128 * EPSILON, "limited")
    beyond(sizes["next"] / sizes["free"], 0.9, "next")
    assert sizes["rhs"] == 12  # what only its dense output needs is left out


@pytest.mark.parametrize("states", [3, 8, 12])
def test_the_vector_does_what_sundials_asks_of_it_and_its_padding_stays_zero(measure, states):
    run = measure("vector", "adams", states)
    x, y = np.arange(states) - 1.25, np.arange(states) + 2.0
    asked = {"const": 0 * x + 3, "sum": 2 * x - 3 * y, "product": x * y, "quotient": x / y}
    asked |= {"scaled": -2 * x, "abs": abs(x), "inverse": 1 / x, "shifted": x + 0.5}
    for name, want in asked.items():
        assert run[name] == [*want, *[0] * (len(run[name]) - states)], name
    assert run["largest"] == abs(x).max() and run["fused"]
    within(relative_error(run["norm"], np.sqrt(((x * y) ** 2).mean())), 64 * EPSILON, "norm")


@pytest.mark.parametrize("kind", [0, 1], ids=["a solution that ends", "rates that end"])
def test_a_solution_that_cannot_go_on_fails_with_a_sentence_where_it_ends(measure, method, kind):
    end = measure("failure", method, kind)
    assert end["failed"]
    within(absolute_error(end["until"], 1), 4e-8, "until")
    assert len(end["why"].split()) > 3


def test_bdf_solves_a_stiff_problem_in_a_hundredth_of_the_steps_of_an_explicit_method(measure):
    stiff, explicit = (measure("stiff", name, 1000.0, 100.0) for name in ("bdf", "runge_kutta"))
    within(absolute_error(stiff["y"], explicit["y"]), 4e-8, "state")
    assert 100 * stiff["steps"] < explicit["steps"]
    assert stiff["jacobians"] > 0
    # An evaluation for each column of each difference quotient, besides those of the steps.
    assert stiff["rhs"] >= stiff["steps"] + 8 * stiff["jacobians"]
