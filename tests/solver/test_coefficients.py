"""The table of DOP853 (dormand_prince.hpp) is SciPy's, row by row; its orders are measured in test_steps.py."""

import re

import numpy as np
import pytest
from scipy.integrate import DOP853
from support.bounds import EPSILON, absolute_error, beyond, within
from support.paths import ROOT

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
