"""Events and endings of the solver alone: every fall through zero is found, dips included, and none is invented."""

from math import asin, pi, sqrt

import pytest
from support.bounds import EPSILON, absolute_error, relative_error, within


@pytest.mark.parametrize("depth", [1e-1, 1e-3, 1e-5])
def test_every_dip_inside_a_step_is_found(measure, method, depth):
    """g = 1 + sin t - depth falls below zero for 2 sqrt(2 depth) s around each 3 pi / 2."""
    found = measure("dip", method, depth)["falls"]
    first = pi + asin(1 - depth)
    expected = [first + 2 * pi * k for k in range(3)]
    assert len(found) == 3
    # The tolerance is 1e-6; a wrong phase moves the edge of a shallow dip by error / slope.
    for t, exact in zip(found, expected, strict=True):
        within(absolute_error(t, exact), 2e-4 / sqrt(depth) * 0.1 + 1e-5, "instant, s")


def test_of_a_dip_however_brief_the_first_instant_is_found(measure, method):
    """A hundred parabolas that are below zero for 0.1 s down to 1e-8 s of a second."""
    found = measure("dips", method, 0.05)
    assert found["worst"] < 1e-5  # five digits of the width, down to the last that the time has
    assert found["roots"] < 60 * 100  # a halved step costs two values, and at most 48 are spent between two extremes


def test_a_function_that_comes_near_zero_and_turns_is_no_event(measure, method):
    assert measure("dip", method, -1e-4)["falls"] == []


def test_the_work_of_the_search_is_bounded(measure, method):
    run = measure("dip", method, 1e-5)
    within(run["roots"] / run["steps"], 100, "roots")


def test_where_no_parabola_tells_the_search_of_one_step_gives_up_in_time(measure):
    run = measure("one_step", "runge_kutta", 0)
    assert not run["event"]
    within(run["roots"], 69, "values in one step")


def test_a_fall_after_the_step_is_none_of_the_step(measure):
    run = measure("one_step", "runge_kutta", 1)
    assert (run["event"], run["until"]) == (0, 1)


@pytest.mark.parametrize("depth", [1e-3, 1e-4, 1e-5, 1e-8])
def test_of_two_dips_between_bends_the_first_is_found(measure, method, depth):
    """g = (t - 0.3)^2 (t - 0.7)^2 - depth, in a step of 1 s whose extremes are told."""
    end = measure("double_dip", method, depth, 1.0)
    assert end["event"] == 2
    # The first root: (t - 0.3) (0.7 - t) = -sqrt(depth).
    within(absolute_error(end["time"], 0.5 - sqrt(0.04 + sqrt(depth))), 64 * EPSILON, "time")


def test_a_function_that_falls_to_a_twentieth_of_its_range_is_looked_at_again(measure):
    """Three samples lie on a straight line above zero."""
    assert measure("dip_beside_a_fall")["event"]


@pytest.mark.parametrize("depth", [1e-2, 1e-6, 1e-10])
def test_each_piece_between_bends_is_searched_by_itself(measure, method, depth):
    """Over both pieces together three samples show no dip."""
    found = measure("later_piece", method, depth)
    assert found["event"]
    assert found["time"] == pytest.approx(0.7 - sqrt(depth) / 5, abs=1e-9)


def test_above_zero_two_dips_end_nothing(measure, method):
    assert not measure("double_dip", method, -1e-8, 1.0)["event"]


@pytest.mark.parametrize("last", [0.5, 1e-2, 1e-3, 1e-5])
def test_a_release_with_rate_zero_is_no_event_but_the_fall_after_it_is(measure, method, last):
    """g = t^2 (last - t): zero with zero rate at the start, and down through zero at `last`."""
    found = measure("release", method, last)
    assert found["event"]
    within(relative_error(found["time"], last), 2e-12, "time")


def test_a_bouncing_ball_bounces_when_it_should(measure, method):
    keeps, g = 0.8, 9.81
    fall = sqrt(2 / g)
    expected = [fall + 2 * fall * sum(keeps**k for k in range(1, n + 1)) for n in range(10)]
    run = measure("bounces", method, keeps)
    within(absolute_error(run["times"], expected), 1e-8, "times")
    assert run["restarts"] == 10
