"""Steps and dense output of the solver alone: coefficients, order, accuracy, failures."""

import re
from math import hypot, inf, log2

import numpy as np
import pytest
from scipy.integrate import DOP853
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within

from wheelfmu.fmu.paths import ROOT

from .solving import EVENT, FAILED, STEPPED, harmonic

# The table of DOP853 (dormand_prince.hpp) is SciPy's, row by row; stage 12 is the end of the step.
MATRICES = {"a": (*DOP853.A, DOP853.B, *DOP853.A_EXTRA), "e": (DOP853.E3, DOP853.E5), "d": DOP853.D}
ROWS = {f"{name}[{i}]": row for name, rows in MATRICES.items() for i, row in enumerate(rows) if any(row)}


@pytest.fixture(scope="module")
def table() -> dict[str, np.ndarray]:
    """Rows by name."""
    text = (ROOT / "fmu-src" / "solver" / "dormand_prince.hpp").read_text(encoding="utf-8")
    rows = {}
    for name, matrix in re.findall(r"constexpr double (\w+)\[\w+\]\[stages\] = \{(.*?)\};", text, re.DOTALL):
        for i, row in enumerate(re.findall(r"\{([^}]*)\}", f"{matrix}}}")):
            weights = [float(weight) for weight in row.split(",") if weight]
            if weights:
                rows[f"{name}[{i}]"] = np.array(weights + [0.0] * (16 - len(weights)))
    return rows


def test_the_table_has_the_rows_of_the_method(table):
    assert set(table) == set(ROWS)


@pytest.mark.parametrize("name", ROWS)
def test_a_row_is_scipys_and_one_wrong_digit_would_be_seen(table, name):
    row = np.resize(ROWS[name], 16) * (np.arange(16) < len(ROWS[name]))
    size = np.abs(row).max()
    within(absolute_error(table[name], row) / size, 4 * EPSILON, "weights, relative")
    beyond(absolute_error(table[name] * (1 + 1e-12), row) / size, 4 * EPSILON, "weights with a wrong digit, relative")


def errors_of_steps(solver, h):
    """Of Runge-Kutta with steps of h: largest errors at their ends, and inside them."""
    one, at_ends, inside = solver("runge_kutta", tolerance=1e20, longest_step=h), [], []
    while one.now.known < 4:
        one.step()
        begin, end = one.now[:2]
        at_ends.append(one.read(end)[0] - np.cos(end))
        inside += [one.read(t)[0] - np.cos(t) for t in begin + np.array([0.2, 0.5, 0.7]) * (end - begin)]
    return np.abs(at_ends).max(), np.abs(inside).max()


def test_halving_the_step_shows_order_8_at_the_ends_and_7_inside(solver):
    coarse, fine = (errors_of_steps(solver, h) for h in (0.4, 0.2))
    within(abs(log2(coarse[0] / fine[0]) - 8.3), 0.7, "order at the ends off 8.3")
    within(abs(log2(coarse[1] / fine[1]) - 8.2), 0.8, "order inside off 8.2")  # local order 8


def accuracy(solver, method, tolerance):
    """Largest error of the oscillator over 20 s, read at 1000 points; and what it took."""
    one, error = solver(method, tolerance=tolerance), 0.0
    for t in np.arange(1, 1001) * 0.02:
        one.run(t)
        error = max(error, hypot(*(one.read(t) - harmonic(t))))
    return error, one.now


def test_the_error_of_a_harmonic_oscillator_stays_within_the_tolerance(solver, method):
    tolerance = 1e-8
    (loose, few), (tight, many) = (accuracy(solver, method, t) for t in (1e-4, tolerance))
    within(tight / tolerance, 5, "error, tolerances")
    beyond(loose / tight, 90, "error at 1e-4 over that at 1e-8")
    assert few.steps < many.steps


def test_after_a_change_runge_kutta_steps_no_further_than_the_last_interval_and_then_remembers(solver):
    one = solver("runge_kutta", each_step=lambda t, y: y[0] + 2)
    one.run(inf, 5)
    before = one.now
    one.restart(before.known, one.read(before.known))
    one.limit_first_step(0.01)
    one.step()
    limited = one.now
    one.step()
    within(relative_error(limited.known - limited.begin, 0.01), 128 * EPSILON, "first step, relative")
    beyond((one.now.known - one.now.begin) / (before.known - before.begin), 0.9, "second step over that before")
    assert limited.rhs - before.rhs == 12  # what only its dense output needs is left out


def test_two_changes_at_one_instant_limit_no_step(solver, method):
    def first_step(interval):
        one = solver(method, longest_step=0.1)
        one.restart(1.0, harmonic(1.0))
        one.limit_first_step(interval)
        one.step()
        return one.now.known - 1

    assert first_step(0.0) == first_step(1e-16) == first_step(1.0)
    if method in ("runge_kutta", "collocation"):  # the partner
        within(relative_error(first_step(1e-3), 1e-3), 1e-9, "first step, relative")


def test_after_an_event_right_behind_the_start_of_a_step_a_thousandth_of_it_is_next_even_from_bytes(solver, method):
    falls = [9.0]
    one = solver(method, "clock", longest_step=0.1, each_step=lambda t, y: falls[0] - t)
    one.run(inf, 6)
    falls[0] = one.now.known + 1e-9
    assert one.step() == EVENT
    falls[0] = 9.0
    one.restart(one.now.known, one.read(one.now.known))
    other = one.copied()
    one.step()
    other.step()
    assert one.now == other.now
    within(one.now.known - one.now.begin, 1.01e-4, "step after the event, s")


@pytest.mark.parametrize("longest_step", [1.0, 0.02])
def test_the_error_of_the_next_step_is_foreseen_from_those_of_two(solver, longest_step):
    """y = 1 / (1 - t): the steps become ever shorter, and none is refused."""
    one = solver("runge_kutta", "explosive", longest_step=longest_step)
    one.run(inf, 6)
    before = one.now
    one.run(0.99)
    assert one.now.rhs - before.rhs == 12 * (one.now.steps - before.steps)


@pytest.mark.parametrize("problem", ["explosive", "ending"])
def test_a_solution_that_cannot_go_on_fails_with_a_sentence_where_it_ends(solver, method, problem):
    one = solver(method, problem)
    assert one.run(2.0, 100_000) == FAILED
    within(absolute_error(one.now.known, 1), 4e-8, "instant of the failure, s")
    assert one.failure.startswith("the step size became too small: ")


def test_rates_that_are_not_finite_are_named_as_the_reason(solver, method):
    one = solver(method, "ending")
    one.restart(2.0, [1.0])  # behind the instant from which its rate is no number
    assert one.run(3.0) == FAILED
    assert one.failure == "the rates of the states are not finite"


@pytest.mark.parametrize("name", ["adams", "bdf"])
@pytest.mark.parametrize("steps", [1, 40, 10_000, 10_001])
def test_cvode_goes_on_from_bytes_with_the_same_bits_also_where_it_has_started_anew(solver, name, steps):
    """After 10,000 steps, so that no more than these are made again."""
    one = solver(name, longest_step=1e-3)
    one.run(inf, steps)
    other = one.copied()
    for _ in range(20):
        one.step()
        other.step()
        t = 0.5 * (one.now.begin + one.now.known)
        assert one.now == other.now and one.read(t) == other.read(t)


def test_each_of_two_failures_has_its_own_reason(solver, method):
    one = solver(method, "ending")
    for _ in range(2):
        one.restart(2.0, [1.0])
        assert one.run(3.0) == FAILED and one.failure == "the rates of the states are not finite"
        one.restart(0.0, [1.0])
        assert one.run(2.0, 100_000) == FAILED and one.failure.startswith("the step size became too small: ")


def test_the_counts_are_those_of_the_calls_through_every_start(solver, method):
    """A quick function comes with each evaluation of the rates; neither function comes near zero."""
    calls = {"rhs": 0, "roots": 0}

    def counted(name):
        def far(_t, _y):
            calls[name] += 1
            return 10.0

        return far

    one = solver(method, quick=counted("rhs"), each_step=counted("roots"))
    for t in (0.0, 1.5, 1.5, 4.0):
        one.restart(t, [*harmonic(t), *[0.0] * 6])
        for _ in range(3):
            assert one.step() == STEPPED
            assert (one.now.rhs, one.now.roots) == (calls["rhs"], calls["roots"])
    assert min(calls.values()) >= 12


def test_a_start_knows_nothing_of_the_error_of_the_step_before_it(solver):
    """A step that is cut short leaves the size that is wanted as it was, whatever its own error is."""
    found = []
    for cut in (None, 1e-3):
        one = solver("runge_kutta")
        one.run(1.0)
        if cut:
            one.restart(2.0, [*harmonic(2.0), *[0.0] * 6])
            one.limit_first_step(cut)
            one.step()
        one.restart(3.0, [*harmonic(3.0), *[0.0] * 6])
        assert one.step() == one.step() == STEPPED
        found.append(one.now[:2])
    assert found[0] == found[1]


@pytest.mark.parametrize(("longest_step", "takes_over"), [(6e-5, False), (1e-3, True)])
def test_collocation_takes_over_only_where_the_motion_allows_much_longer_steps(solver, longest_step, takes_over):
    """The decay allows DOP853 width / 4.5."""
    one = solver("runge_kutta", "steep", longest_step=longest_step)
    for _ in range(40):
        assert one.step() == STEPPED
    assert (one.now.known - one.now.begin > 1.01e-4 / 4.5) == takes_over
