"""Events and endings of the solver alone: every fall through zero is found, dips included, and none is invented."""

from itertools import pairwise
from math import acos, asin, pi, sin, sqrt

import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from .solving import EACH_STEP, EVENT, LATER_LISTED, QUICK, STEPPED, harmonic


def dips(solver, method, depth):
    """Instants of the falls of g = 1 + sin t - depth below zero up to t = 20."""
    one, found = solver(method, tolerance=1e-6, each_step=lambda t, y: 1 - y[1] - depth), []
    while one.run(20.0) == EVENT:
        found.append(one.now.known)
        past = found[-1] + 2 * acos(1 - depth) + 0.1
        one.restart(past, harmonic(past))
    return found


@pytest.mark.parametrize("depth", [1e-1, 1e-3, 1e-5])
def test_every_dip_inside_a_step_is_found(solver, method, depth):
    """g = 1 + sin t - depth falls below zero for 2 sqrt(2 depth) s around each 3 pi / 2."""
    found = dips(solver, method, depth)
    first = pi + asin(1 - depth)
    expected = [first + 2 * pi * k for k in range(3)]
    assert len(found) == 3
    # The tolerance is 1e-6; a wrong phase moves the edge of a shallow dip by error / slope.
    for t, exact in zip(found, expected, strict=True):
        within(absolute_error(t, exact), 2e-4 / sqrt(depth) * 0.1 + 1e-5, "instant of the fall, s")


def test_of_a_dip_however_brief_the_first_instant_is_found(solver, method):
    """A hundred parabolas that are below zero for 0.1 s down to 1e-8 s of a second."""
    roots = 0
    for i in range(100):
        centre, half = (0.5 + 0.6180339887 * i) % 0.8 + 0.1, 0.05 * 10 ** (-0.07 * i)
        one = solver(method, "clock", each_step=lambda t, y, c=centre, w=half: (t - c) ** 2 - w**2)
        assert one.run(1.0) == EVENT
        # five digits of the width, down to the last that the time has
        within(abs(one.now.known - (centre - half)) / half, 5e-6, "instant of the fall over half the width")
        roots += one.now.roots
    assert roots < 60 * 100  # a halved step costs two values, and at most 48 are spent between two extremes


def test_a_function_that_comes_near_zero_and_turns_is_no_event(solver, method):
    assert dips(solver, method, -1e-4) == []


def test_where_no_parabola_fits_the_search_of_one_step_gives_up_in_time(solver):
    one = solver("runge_kutta", "clock", each_step=lambda t, y: 1.001 + sin(777 * t))
    assert one.step() == STEPPED
    within(one.now.roots, 69, "values in one step")


def test_a_fall_after_the_step_is_none_of_the_step(solver):
    one = solver("runge_kutta", "clock", each_step=lambda t, y: (t - 1.3) ** 2 - 0.01)
    assert (one.step(), one.now.known) == (STEPPED, 1)


def double_dip(solver, method, depth):
    """g = (t - 0.3)^2 (t - 0.7)^2 - depth, in a step of 1 s whose extremes are given."""
    one = solver(method, "clock", each_step=lambda t, y: ((t - 0.3) * (t - 0.7)) ** 2 - depth, extremes=(0.3, 0.5, 0.7))
    return one.run(2.0), one.now


@pytest.mark.parametrize("depth", [1e-3, 1e-4, 1e-5, 1e-8])
def test_of_two_dips_between_bends_the_first_is_found(solver, method, depth):
    outcome, now = double_dip(solver, method, depth)
    assert outcome == EVENT
    # The first root: (t - 0.3) (0.7 - t) = -sqrt(depth).
    within(absolute_error(now.known, 0.5 - sqrt(0.04 + sqrt(depth))), 64 * EPSILON, "instant of the fall, s")


def test_above_zero_two_dips_end_nothing(solver, method):
    assert double_dip(solver, method, -1e-8)[0] == STEPPED


def test_a_function_that_falls_to_a_twentieth_of_its_range_is_looked_at_again(solver):
    """Three samples lie on a straight line above zero; around 0.75 it dips below."""
    one = solver("runge_kutta", "clock", each_step=lambda t, y: 1 - 0.95 * t - max(0, 0.4 - 20 * (t - 0.75) ** 2))
    assert one.run(1.0) == EVENT


@pytest.mark.parametrize("depth", [1e-2, 1e-6, 1e-10])
def test_each_piece_between_bends_is_searched_by_itself(solver, method, depth):
    """g = 1 up to a bend at 0.5 s, then a parabola: over both pieces together three samples show no dip."""
    one = solver(
        method, "clock", each_step=lambda t, y: 1 if t < 0.5 else 25 * (t - 0.7) ** 2 - depth, extremes=(0.5,)
    )  # fmt: skip
    assert one.run(1.0) == EVENT
    assert one.now.known == pytest.approx(0.7 - sqrt(depth) / 5, abs=1e-9)


@pytest.mark.parametrize("last", [0.5, 1e-2, 1e-3, 1e-5])
def test_a_release_with_rate_zero_is_no_event_but_the_fall_after_it_is(solver, method, last):
    """g = t^2 (last - t): zero with zero rate at the start, and down through zero at `last`."""
    one = solver(method, "clock", each_step=lambda t, y: y[0] ** 2 * (last - y[0]))
    assert one.run(10 * last) == EVENT
    rounding = 128 * EPSILON if method == "collocation" else 0  # of the powers over a step of one second
    within(absolute_error(one.now.known, last), 2e-12 * last + rounding, "instant of the fall, s")


@pytest.mark.parametrize("step", [1.0, 0.02])
@pytest.mark.parametrize("instants", [(0.4, 0.7, 0.9), (0.7, 0.4, 0.9), (0.9, 0.7, 0.4), (0.4, 0.4, 0.4)], ids=str)
def test_of_functions_that_fall_in_one_step_the_first_counts_wherever_it_is_listed(solver, method, instants, step):
    """And of those that fall at one instant the last of the list; after it the others are found, each at its own."""
    names = {"each_step": EACH_STEP, "later_listed": LATER_LISTED, "quick": QUICK}
    left = dict(zip(names, instants, strict=True))
    one = solver(method, "clock", longest_step=step, **{name: lambda t, y, n=name: left[n] - t for name in names})
    while left != dict.fromkeys(names, 9.0):
        assert one.run(1.0) == EVENT
        first = min(left.values())
        name = [name for name, instant in left.items() if instant == first][-1]
        within(absolute_error(one.now.known, first), 64 * EPSILON, "instant of the first fall, s")
        assert one.now.fallen == names[name]
        left[name] = 9.0
        one.restart(one.now.known, one.read(one.now.known))
    assert one.run(1.0) == STEPPED


@pytest.mark.parametrize("place", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("depth", [1e-3, -1e-3])
@pytest.mark.parametrize("engine", ["runge_kutta", "collocation"])
def test_a_quick_function_is_looked_at_where_it_comes_near_zero_inside_a_step_alone(solver, engine, place, depth):
    """A parabola of 0.16 and more at the ends of a step of 1 s: below 0.1 it is near. CVODE evaluates the ends."""
    one = solver(engine, "clock", quick=lambda t, y: 4 * (t - place) ** 2 - depth)
    assert one.run(1.0) == (EVENT if depth > 0 else STEPPED)
    if depth > 0:
        within(absolute_error(one.now.known, place - sqrt(depth) / 2), 64 * EPSILON, "instant of the fall, s")


def test_a_quick_function_costs_nothing_before_it_comes_near_zero_and_once_it_is_far_again(solver, method):
    def evaluations(near):
        """Up to t = 1.5, and from there on; the function is near zero up to t = 0.5, or there is none."""
        one = solver(method, tolerance=1e-6, longest_step=0.2, quick=near and (lambda t, y: near if t < 0.5 else 1))
        one.run(1.5)
        before = one.now.rhs
        one.run(4.0)
        return before, one.now.rhs - before

    none, near = evaluations(None), evaluations(0.05)
    assert evaluations(1) == none and near[1] == none[1]
    assert near[0] > none[0]  # the partner


def test_a_function_that_rests_at_zero_and_dips_later_in_the_step_falls_there(solver, method):
    """Three samples are zero, zero and above; the dip lies between the last two."""
    one = solver(method, "clock", each_step=lambda t, y: 0 if t < 0.65 else (t - 0.8) ** 2 - 0.0025)
    assert one.run(1.0) == EVENT
    within(absolute_error(one.now.known, 0.75), 64 * EPSILON, "instant of the fall, s")


@pytest.mark.parametrize("falls", [(0.3, 0.4), (0.4, 0.3)])
def test_of_two_falls_before_an_extreme_the_first_counts(solver, method, falls):
    first, second = ((lambda t, y, at=at: at - t) for at in falls)
    one = solver(method, "clock", each_step=first, later_listed=second, extremes=(0.5,))
    assert one.run(1.0) == EVENT
    within(absolute_error(one.now.known, 0.3), 64 * EPSILON, "instant of the fall, s")
    assert one.now.fallen == 1 + falls.index(0.3)


def test_a_dip_about_the_middle_of_each_step_is_found_where_collocation_takes_over_from_dop853(solver):
    """A value inside the step is known of DOP853 alone, and would hide the dip from collocation."""
    start = [0.0, 12e-4, 1.0, 0.0]  # twelve widths from zero; it rests at 1e-3 s
    one, steps = solver("runge_kutta", "steep", longest_step=0.5), []
    one.restart(0.0, start)
    while one.now.known < 0.5:
        assert one.step() == STEPPED
        steps.append(one.now[:2])
    for begin, end in (step for step in steps if step[0] > 1e-3):
        middle, half = 0.5 * (begin + end), 0.02 * (end - begin)

        def dips(t, y, middle=middle, half=half):
            return min(1, abs(t - middle) / half - 1)

        other = solver("runge_kutta", "steep", longest_step=0.5, each_step=dips)
        other.restart(0.0, start)
        assert other.run(end) == EVENT
        within(absolute_error(other.now.known, middle - half), 64 * EPSILON, "instant of the fall, s")


def evaluations_with(solver, quick):
    """After each of 30 steps towards an explosion; how often `quick` was asked by then."""
    calls, found = [], []
    one = solver("runge_kutta", "explosive", quick=lambda t, y: calls.append(t) or quick(len(calls), t))
    for _ in range(30):
        assert one.step() == STEPPED
        found.append((one.now.known, one.now.rhs, len(calls)))
    return found, calls


def test_where_a_refused_attempt_comes_near_zero_the_step_that_is_accepted_costs_no_more(solver):
    found, calls = evaluations_with(solver, lambda k, t: 1)
    refused = set()
    for (*_, before), (end, _, asked) in pairwise([(0, 0, 0), *found]):
        refused |= {k for k in range(before + 1, asked + 1) if calls[k - 1] > end * (1 + 1e-9)}
    assert refused
    assert evaluations_with(solver, lambda k, t: 0.05 if k in refused else 1)[0] == found
    beyond(evaluations_with(solver, lambda k, t: 0.05)[0][-1][1], found[-1][1], "evaluations near zero throughout")


def test_a_value_near_zero_that_the_dense_output_alone_comes_across_costs_nothing(solver):
    """It is asked for by a function that no parabola fits, at 1/10, 1/5 and 7/9 of a step of 1 s."""

    def evaluations(*near):
        def quick(t, y):
            return 0.05 if any(abs(t % 1 - part) < 1e-9 for part in near) else 1

        one = solver("runge_kutta", "clock", each_step=lambda t, y: 1.001 + sin(777 * t), quick=quick)
        assert one.run(5.0) == STEPPED
        return one.now.rhs

    assert evaluations(1 / 10, 1 / 5, 7 / 9) == evaluations()
    beyond(evaluations(1 / 4), evaluations(), "evaluations where a stage comes near zero")


@pytest.mark.parametrize("engine", ["runge_kutta", "collocation"])
def test_behind_an_event_that_changes_nothing_the_rest_of_the_step_is_searched(solver, engine):
    """The value that is known inside the step lies before the event, and shows nothing of what follows."""
    side = [1]
    one = solver(
        engine, "clock", each_step=lambda t, y: side[0] * (0.7 - t),
        later_listed=lambda t, y: min(1, 50 * abs(t - 0.85) - 1),
    )  # fmt: skip
    for instant, fallen in ((0.7, EACH_STEP), (0.83, LATER_LISTED)):
        assert (one.run(1.0), one.now.fallen) == (EVENT, fallen)
        within(absolute_error(one.now.known, instant), 64 * EPSILON, "instant of the fall, s")
        side[0] = -1
        one.resume()
    assert one.now.begin == 0


def test_each_question_is_counted_at_starts_and_in_searches_too(solver, method):
    asked, events = [], 0
    one = solver(method, each_step=lambda t, y: asked.append(t) or 0.9 - y[1])
    while one.run(20.0) == EVENT:
        events += 1
        one.restart(one.now.known + 2, harmonic(one.now.known + 2))
    assert events > 2 and one.now.roots == len(asked)
