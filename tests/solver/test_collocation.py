"""Collocation at the points of Radau IIA: order, error estimate, the state that settles, restart, dense output.

The problems of probe.cpp: |u| = t or 1 - t, a direction that settles to sin t at the rate 4.5 / |u|, or a state that
settles to 1e-4 sin t under a law as wide as that; two states that it pushes. test_steps.py and test_search.py run for
collocation too.
"""

from functools import partial
from math import log2

import numpy as np
import pytest
from scipy.special import roots_jacobi
from support.bounds import EPSILON, absolute_error, beyond, within

from .solving import STEPPED

STIFFNESS, WIDTH = 4.5, 1e-4
TOLERANCES = (1e-5, 1e-8, 1e-11)


@pytest.fixture
def collocation(solver):
    return partial(solver, "collocation")


def settled(problem, t, off=0.0, since=0.0, speed=None):
    """u and chi at t; the direction was `off` its limit at `since`, where the speed was that."""
    if problem == "steep":
        return np.array([t, WIDTH * np.sin(t)])
    u = t if problem == "settling" else 1 - t
    left = off * (u / speed) ** (-STIFFNESS if problem == "settling" else STIFFNESS) if off else 0.0
    return np.array([u, np.sin(t) + left])


def error_of(one, t, *how, **more):
    """Of |u| and chi, with what they push: (cos t, -sin t) where the direction is at its limit."""
    y, exact = np.array(one.read(t)), settled(*how, t, **more)
    harmonic = 0.0 if more else absolute_error(y[2:], [np.cos(t), -np.sin(t)])
    return max(absolute_error(y[:2], exact), harmonic)


def quadrature_error(collocation, h):
    """Of sin(5 t) / 5 after one step: the rates do not depend on the state, and no tolerance limits them."""
    one = collocation("wave", tolerance=1e20, longest_step=h)
    assert one.step() == STEPPED and one.now.known == h
    return abs(one.read(h)[0] - np.sin(5 * h) / 5)


def test_one_step_has_the_error_of_radaus_quadrature_which_falls_by_the_twelfth_power(collocation):
    nodes, weights = roots_jacobi(5, 1, 0)  # Radau's points without the end
    nodes, weights = (nodes + 1) / 2, weights / 2
    found = [quadrature_error(collocation, h) for h in (0.8, 0.4)]
    within(abs(log2(found[0] / found[1]) - 12), 0.3, "local order off 12")
    nodes = np.append(nodes, 1.0)
    vander = np.vander(nodes, 6, increasing=True).T
    weights = np.linalg.solve(vander, 1 / np.arange(1, 7))  # exact for powers up to the fifth
    for h, error in zip((0.8, 0.4), found, strict=True):
        expected = abs(h * weights @ np.cos(5 * h * nodes) - np.sin(5 * h) / 5)
        within(abs(error - expected), 256 * EPSILON, "error off that of the quadrature")


def run(collocation, problem, tolerance, until):
    """Largest errors at the ends of the steps and inside them, over the tolerance; the solver."""
    one, ends, inside = collocation(problem, tolerance=tolerance, longest_step=0.5), [0.0], [0.0]
    while one.now.known < until:
        assert one.step() == STEPPED, one.failure
        begin, end = one.now[:2]
        ends.append(error_of(one, end, problem))
        inside += [error_of(one, begin + x * (end - begin), problem) for x in (0.1, 0.3, 0.5, 0.7, 0.9)]
    return max(ends) / tolerance, max(inside) / tolerance, one


@pytest.mark.parametrize("problem", ["settling", "falling", "steep"])
@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_the_error_is_that_of_the_tolerance_at_the_ends_and_inside(collocation, problem, tolerance):
    until = 0.999 if problem == "falling" else 5.0
    ends, inside, one = run(collocation, problem, tolerance, until)
    within(ends, 0.3, "error at the ends of the steps, in tolerances")
    within(inside, 0.3, "error inside the steps, in tolerances")
    beyond(run(collocation, problem, 100 * tolerance, until)[0], ends / 100, "error at a hundred tolerances")
    within(one.now.steps, 80, "number of steps")


@pytest.mark.parametrize("off", [0.3, 1e-3])
@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_a_direction_off_its_limit_settles_by_the_closed_form(collocation, off, tolerance):
    """As u^-4.5 while the speed grows from 0.01, as u^4.5 while it falls to nothing."""
    for problem, since, speed, until in (("settling", 0.01, 0.01, 3.0), ("falling", 0.0, 1.0, 1 - 1e-6)):
        one = collocation(problem, tolerance=tolerance, longest_step=0.5)
        one.restart(since, [speed, np.sin(since) + off, 1.0, 0.0])
        worst = 0.0
        while one.now.known < until:
            assert one.step() == STEPPED, one.failure
            begin, end = one.now[:2]
            for t in (begin, 0.9 * begin + 0.1 * end, 0.5 * begin + 0.5 * end, min(end, until)):
                worst = max(worst, error_of(one, t, problem, off=off, since=since, speed=speed))
        within(worst / tolerance, 10, "error in tolerances")
        within(one.now.steps, 400, "number of steps")


@pytest.mark.parametrize("off", [20.0, -3.0])
@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_a_state_outside_its_steep_law_comes_to_its_limit_in_few_steps(collocation, off, tolerance):
    one = collocation("steep", tolerance=tolerance, longest_step=0.5)
    one.restart(0.0, [0.0, off * WIDTH, 1.0, 0.0])
    assert one.run(0.5, 1000) == STEPPED, one.failure
    within(abs(one.read(0.5)[1] / WIDTH - np.sin(0.5)), 10 * tolerance, "off the limit, in widths")
    within(one.now.steps, 150, "number of steps")


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_from_a_rest_in_a_steep_law_on_collocation_takes_over_from_dop853(solver, tolerance):
    """Also in a copy from bytes. The decay, 4.5 / width, would allow DOP853 no more than steps of 2e-5."""
    one = solver("runge_kutta", "steep", tolerance=tolerance, longest_step=0.5)
    one.restart(0.0, [0.0, 12 * WIDTH, 1.0, 0.0])
    one.step()
    within(one.now.known, 10 * WIDTH, "first step, as far as the bend")
    while one.now.known < 1e-3:
        assert one.step() == STEPPED, one.failure
        other = one.copied()
        assert one.step() == other.step() == STEPPED
        assert one.now == other.now
    assert one.run(0.5, 1000) == STEPPED, one.failure
    within(abs(one.read(0.5)[1] / WIDTH - np.sin(0.5)), 10 * tolerance, "off the limit, in widths")
    within(one.now.steps, 150, "number of steps")


def test_however_close_to_nothing_the_speed_falls_steps_go_on(collocation):
    """At the tightest tolerance, to within some hundred roundings of the instant at which it vanishes."""
    one = collocation("falling", tolerance=1e-13, longest_step=0.5)
    one.restart(0.0, [1.0, 0.3, 1.0, 0.0])
    until = 1 - 128 * 8 * EPSILON
    assert one.run(until, 1000) == STEPPED, one.failure
    within(abs(one.read(until)[1] - np.sin(1)), 1e-11, "direction off its limit")


def bits(one, times):
    return [tuple(one.read(t)) for t in times if one.run(t) == STEPPED]


def test_a_restart_is_as_a_start(collocation):
    times = np.linspace(0.1, 2, 20)
    one, other = (collocation("settling", longest_step=0.5) for _ in range(2))
    first = bits(one, times)
    one.restart(0.0, [0.0, 0.0, 1.0, 0.0])
    assert bits(one, times) == first == bits(other, times) and len(first) == 20


def test_after_a_change_the_first_step_is_no_longer_than_the_last_interval(collocation):
    one = collocation("harmonic")
    one.run(1.0)
    for dt in (1e-2, 1e-5):
        one.restart(one.now.known, one.read(one.now.known))
        one.limit_first_step(dt)
        begin = one.now.known
        assert one.step() == STEPPED
        within(one.now.known - begin, dt * (1 + 1e-9), "first step, s")
    one.step()
    beyond(one.now.known - one.now.begin, 1e-5, "second step, s")


def test_the_polynomial_begins_and_ends_with_the_step_and_has_the_rates_at_its_end(collocation):
    one = collocation("settling", longest_step=0.5)
    for _ in range(12):
        one.step()
        begin, end = one.now[:2]
        near = 1e-6 * (end - begin)
        within(absolute_error(one.read(begin + near), one.read(begin)), 1e-5, "jump at the start of the step")
        back = (np.array(one.read(end)) - one.read(end - near)) / near
        y = one.read(end)
        rates = [1.0, np.cos(end) - STIFFNESS * (y[1] - np.sin(end)) / y[0], y[3] + y[1] - np.sin(end), -y[2]]
        within(absolute_error(back, rates), 1e-5, "rates at the end of the step")


@pytest.mark.parametrize("problem", ["harmonic", "settling", "falling", "steep"])
def test_a_history_restored_from_bytes_goes_on_with_the_same_bits(solver, method, problem):
    """After each of some steps, and inside one; by every method, of problems that all can solve."""
    if problem != "harmonic" and method != "collocation":
        problem = "clock"
    one = solver(method, problem, longest_step=0.1)
    for _ in range(6):
        one.step()
        begin, end = one.now[:2]
        other = one.copied()
        assert other.now == one.now
        middle = 0.5 * (begin + end)
        assert one.read(middle) == other.read(middle)
        assert one.copied().step() == other.step() == STEPPED
    times = np.linspace(one.now.known, 0.95, 5)
    assert bits(one.copied(), times) == bits(one, times)
