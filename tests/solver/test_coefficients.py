"""The table of DOP853 (dormand_prince.hpp) satisfies the order conditions: of the step and of the dense output."""

import re

import pytest
import trees
from support.bounds import EPSILON, beyond, within
from support.paths import ROOT


@pytest.fixture(scope="module")
def table():
    """Rows by name, each of (stage, weight)."""
    text = (ROOT / "fmu-src" / "solver" / "dormand_prince.hpp").read_text(encoding="utf-8")
    rows = re.findall(r"constexpr Term (\w+)\[\] = \{(.*?)\};", text, re.DOTALL)
    return {name: [(int(i), float(w)) for i, w in re.findall(r"\{(\d+), ([^}]+)\}", row)] for name, row in rows}


@pytest.fixture(scope="module")
def a(table):
    """Rows of a_ij as (stage, weight); stage 12 is the end of the step."""
    names = [f"a_{i}" for i in range(1, 12)] + ["b"] + [f"a_{i}" for i in (13, 14, 15)]
    return [[]] + [table[name] for name in names]


def column(terms, stages=16):
    weights = [0.0] * stages
    for stage, weight in terms:
        weights[stage] = weight
    return weights


def dense_weights(table, x):
    """b_i(x) of y = y_0 + h sum b_i(x) f_i from the nested products of the dense output."""
    unit = [[float(i == k) for i in range(16)] for k in range(16)]
    delta = column(table["b"])
    p = [delta, [u - d for u, d in zip(unit[0], delta, strict=True)]]
    p.append([2 * d - u - v for d, u, v in zip(delta, unit[0], unit[12], strict=True)])
    p += [column(table[f"d_{k}"]) for k in (3, 4, 5, 6)]
    total = [0.0] * 16
    for k in range(6, -1, -1):
        total = [(t + c) * (1 - x if k % 2 else x) for t, c in zip(total, p[k], strict=True)]
    return total


def worst(weights, a, order, at=1.0):
    return max(map(abs, trees.residuals(weights, a, order, at)))


def test_there_are_200_trees_up_to_order_8():
    assert [len(trees.trees(n)) for n in range(1, 9)] == [1, 1, 2, 4, 9, 20, 48, 115]


@pytest.mark.parametrize("order", range(1, 9))
def test_the_step_satisfies_every_condition_up_to_order_8(table, a, order):
    within(worst(column(table["b"]), a, order), 6 * 43 * EPSILON, "b")  # weights up to 6, a_ij up to 43


def test_the_step_misses_order_9(table, a):
    beyond(worst(column(table["b"]), a, 9), 1e-6, "b")


@pytest.mark.parametrize("x", [0.1, 0.37, 0.5, 0.83, 1.0])
def test_the_dense_output_satisfies_every_condition_up_to_order_7(table, a, x):
    weights = dense_weights(table, x)
    within(max(worst(weights, a, order, x) for order in range(1, 8)), 528 * EPSILON, "difference")  # terms up to 528


def test_the_dense_output_misses_order_8(table, a):
    beyond(worst(dense_weights(table, 0.37), a, 8, 0.37), 2e-6, "difference")


@pytest.mark.parametrize(("name", "order"), [("e_5", 5), ("e_3", 3)])
def test_the_error_estimates_vanish_up_to_their_order_and_not_beyond(table, a, name, order):
    weights = column(table[name])

    def largest(n):
        return max(
            abs(sum(w * v for w, v in zip(weights, trees.stage_values(t, a), strict=True))) for t in trees.trees(n)
        )

    within(max(largest(n) for n in range(1, order + 1)), 2 * 6 * 43 * EPSILON, "largest")  # as above, of two sums
    beyond(largest(order + 1), 3e-5, "largest")


def test_one_wrong_digit_in_the_table_breaks_the_conditions(table, a):
    wrong = [list(row) for row in a]
    stage, weight = wrong[8][2]
    wrong[8][2] = (stage, weight + 1e-9)
    beyond(worst(column(table["b"]), wrong, 6), 2e-11, "b")
