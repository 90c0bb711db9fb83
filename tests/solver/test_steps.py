"""Steps, dense output and histories of the solver alone: coefficients, order, accuracy, grids, stops, failures."""

import re
from math import hypot, inf, log2

import numpy as np
import pytest
from scipy.integrate import DOP853
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within
from support.paths import ROOT

from .solving import EVENT, FAILED, harmonic

# The table of DOP853 (dormand_prince.hpp) is SciPy's, row by row.
ROWS = {f"a_{i}": row for i, row in enumerate(DOP853.A)} | {f"a_{i}": row for i, row in enumerate(DOP853.A_EXTRA, 13)}
ROWS |= {"b": DOP853.B, "e_3": DOP853.E3, "e_5": DOP853.E5} | {f"d_{k}": row for k, row in enumerate(DOP853.D, 3)}
del ROWS["a_0"]  # the first stage is where the step begins


@pytest.fixture(scope="module")
def table() -> dict[str, np.ndarray]:
    """Rows by name; stage 12 is the end of the step."""
    text = (ROOT / "fmu-src" / "solver" / "dormand_prince.hpp").read_text(encoding="utf-8")
    rows = {}
    for name, terms in re.findall(r"constexpr Term (\w+)\[\] = \{(.*?)\};", text, re.DOTALL):
        rows[name] = np.zeros(16)
        for stage, weight in re.findall(r"\{(\d+), ([^}]+)\}", terms):
            rows[name][int(stage)] = float(weight)
    return rows


def test_the_table_has_the_rows_of_the_method(table):
    assert set(table) == set(ROWS)


@pytest.mark.parametrize("name", ROWS)
def test_a_row_is_scipys_and_one_wrong_digit_would_be_seen(table, name):
    row = np.resize(ROWS[name], 16) * (np.arange(16) < len(ROWS[name]))
    size = np.abs(row).max()
    within(absolute_error(table[name], row) / size, 4 * EPSILON, "weights")
    beyond(absolute_error(table[name] * (1 + 1e-12), row) / size, 4 * EPSILON, "weights with a wrong digit")


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
    within(abs(log2(coarse[0] / fine[0]) - 8.3), 0.7, "at_ends")
    within(abs(log2(coarse[1] / fine[1]) - 8.2), 0.8, "inside")  # local order 8


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
    within(tight / tolerance, 5, "error")
    beyond(loose / tight, 90, "error")
    assert few.steps < many.steps


def test_the_reading_grid_changes_no_bit_and_no_count(solver, method):
    coarse, fine = (solver(method, each_step=lambda t, y: y[0] + 2) for _ in range(2))
    for one, points in ((coarse, 1), (fine, 1000)):
        for i in range(1, points + 1):
            one.run(20 * i / points)
            one.read(20 * i / points)
    assert (coarse.now, coarse.read(20.0)) == (fine.now, fine.read(20.0))


def test_other_tolerances_change_the_counts_that_grids_do_not(solver, method):
    assert accuracy(solver, method, 1e-6)[1].rhs != accuracy(solver, method, 1e-8)[1].rhs


@pytest.mark.parametrize("gap", [1e-1 / 3, 1e-3, 1e-6, 1e-9, 1e-12, 1e-13, 1e-15])
def test_a_step_cut_at_any_instant_leaves_the_error_within_the_tolerance(solver, method, gap):
    """Over 20 s, cut every 0.1 s and again by the gap later."""
    one = solver(method)
    for cut in np.arange(1, 201) * 0.1:
        for t in (cut, cut + gap):
            while one.now.known < t * (1 - 64 * EPSILON):
                one.stop_before(t)
                assert one.step() == 0, one.failure
            within(abs(one.now.known - t), 64 * EPSILON * t, "end of the step, s")
            within(hypot(*(one.read(t) - harmonic(t))), 10e-8, "error")
    stops = 400 if gap > 1e-12 else 200  # closer instants are the same one
    assert method == "runge_kutta" or one.now.restarts >= stops - 1  # a history over nodes this close is dropped


def test_after_a_change_runge_kutta_steps_no_further_than_the_last_interval_and_then_remembers(solver):
    one = solver("runge_kutta", each_step=lambda t, y: y[0] + 2)
    one.run(inf, 5)
    before = one.now
    one.restart(before.known, one.read(before.known))
    one.limit_first_step(0.01)
    one.step()
    limited = one.now
    one.step()
    within(relative_error(limited.known - limited.begin, 0.01), 128 * EPSILON, "limited")
    beyond((one.now.known - one.now.begin) / (before.known - before.begin), 0.9, "next")
    assert limited.rhs - before.rhs == 12  # what only its dense output needs is left out


@pytest.mark.parametrize("problem", ["explosive", "ending"])
def test_a_solution_that_cannot_go_on_fails_with_a_sentence_where_it_ends(solver, method, problem):
    one = solver(method, problem)
    assert one.run(2.0, 100_000) == FAILED
    within(absolute_error(one.now.known, 1), 4e-8, "until")
    assert one.failure == "the step size became too small"


def test_rates_that_are_not_finite_are_named_as_the_reason(solver, method):
    one = solver(method, "ending")
    one.restart(2.0, [1.0])  # behind the instant from which its rate is no number
    assert one.run(3.0) == FAILED
    assert one.failure == "the rates of the states are not finite"


def test_bdf_solves_a_stiff_problem_in_a_hundredth_of_the_steps_of_an_explicit_method(solver):
    stiff, explicit = (solver(name, "stiff", 1000.0, 1e-7, 1000.0) for name in ("bdf", "runge_kutta"))
    for one in (stiff, explicit):
        one.run(100.0, 200_000)
    within(absolute_error(stiff.read(100.0)[0], explicit.read(100.0)[0]), 4e-8, "state")
    assert 100 * stiff.now.steps < explicit.now.steps
    assert stiff.now.jacobians > 0
    # An evaluation for each column of each difference quotient, besides those of the steps.
    assert stiff.now.rhs >= stiff.now.steps + 8 * stiff.now.jacobians


# Restored histories. What could not have been saved is refused: contract/test_serialization.py.


@pytest.fixture
def watched(solver, method):
    """watched(steps) -> a solver after so many steps, with something to watch."""

    def make(steps=0):
        made = solver(method, "stiff", 3.0, each_step=lambda t, y: y[0] + 10)
        made.run(inf, steps)
        return made

    return make


def seen(one, steps):
    """What each step does: its kind, the time known, the state halfway, evaluations."""
    rows = []
    for _ in range(steps):
        outcome, now = one.step(), one.now
        rows.append((outcome, now.known, one.read(0.5 * (now.begin + now.known)), now.rhs, now.roots))
    return rows


@pytest.mark.parametrize("steps", [0, 1, 2, 7, 60, 300])
def test_a_restored_solver_goes_on_with_the_same_bits(watched, steps):
    original, copy, once_more = watched(steps), watched(), watched()
    history = original.save()
    assert copy.restore(history) and copy.save() == history
    t = original.now.begin + 0.3 * (original.now.known - original.now.begin)
    assert original.read(t) == copy.read(t)
    assert seen(original, 200) == seen(copy, 200)
    assert once_more.restore(history) and copy.restore(history)  # back to the past, in a solver that has gone on
    assert seen(once_more, 100) == seen(copy, 100)


def test_a_history_is_small(watched):
    within(len(watched(60).save()), 4096, "bytes")


def resumed_at_events(solver, method, cuts, save=False):
    """The oscillator up to the last cut, with the crossings of y_0 as events after which the same step goes on. Each
    step may go up to the next of the cuts. With `save` another solver takes over after each step. For each way of
    watching the lengths of all steps, and the last counts."""
    runs = []
    for way in ("each_step", "by_margin"):
        sign = [1]
        watched = {way: lambda _, y, sign=sign: sign[0] * y[0] + 1e-9}
        one, lengths = solver(method, **watched), []
        for cut in cuts:
            while one.now.known < cut * (1 - 64 * EPSILON):
                one.stop_before(cut)
                outcome = one.step()
                assert outcome != FAILED, one.failure
                lengths.append(one.now.known - one.now.begin)
                if outcome == EVENT:
                    sign[0] = -sign[0]
                    one.resume()
                if save:
                    other = solver(method, **watched)
                    assert other.restore(one.save())
                    one = other
        runs.append((lengths, one.now))
    return runs


def test_a_stop_does_not_outlive_its_step_where_an_event_cut_the_step_in_two(solver, method):
    """An old stop that lies behind would make a step of no length, which CVODE refuses."""
    random = np.random.default_rng(7)
    for _ in range(20):
        for lengths, _ in resumed_at_events(solver, method, np.cumsum(random.uniform(0.05, 0.6, 30))):
            beyond(min(lengths), 64 * EPSILON * 20, "length of a step, s")


def test_a_history_saved_at_any_cut_leads_to_the_same_counts_also_between_events(solver, method):
    cuts = np.cumsum(np.random.default_rng(8).uniform(0.2, 1.5, 20))
    assert resumed_at_events(solver, method, cuts, save=True) == resumed_at_events(solver, method, cuts)
    assert resumed_at_events(solver, method, cuts[1:])[0][1] != resumed_at_events(solver, method, cuts)[0][1]
