"""The trusted tables of the paper's two scenes: the reference solution makes them again, all transitions included.

Every bound has a partner that breaks an equation, a parameter or a law, and must exceed the bound.
"""

import numpy as np
import pytest
from support.bounds import beyond, within

from reference import Start, Wheel, newton_euler, solve
from reference.judge import table_error
from reference.tables import read_table

FRICTION = Wheel(s=0.03)
PAPER = {"paper_free": Wheel(), "paper_friction": FRICTION}
both_tables = pytest.mark.parametrize("table", PAPER)


@pytest.fixture
def wrong_gyroscopic_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    """w x J w with the sign turned, as (16) prints it."""
    right = newton_euler.gyroscopic
    monkeypatch.setattr(newton_euler, "gyroscopic", lambda *of: tuple(-c for c in right(*of)))


# The rounding to 12 digits. Other processors and other versions of SciPy round otherwise.
TABLE_BOUND = 1e-10


def order(table: str) -> float:
    """Decades of error per decade of rtol, from 1e-6 to 1e-10."""
    coarse, fine = (table_error(table, PAPER[table], rtol) for rtol in (1e-6, 1e-10))
    return np.log10(coarse / fine) / 4


@both_tables
def test_the_trusted_tables_are_made_again(table: str) -> None:
    within(table_error(table, PAPER[table]), TABLE_BOUND, "table error")


@both_tables
def test_the_error_falls_in_proportion_to_the_tolerance(table: str) -> None:
    within(abs(order(table) - 1), 0.15, "order")


@both_tables
@pytest.mark.usefixtures("wrong_gyroscopic_sign")
def test_a_wrong_gyroscopic_sign_neither_meets_nor_approaches_the_tables(table: str) -> None:
    beyond(table_error(table, PAPER[table], rtol=1e-9), 0.2, "table error")
    within(abs(order(table)), 0.1, "order")


def instants_error(s: float) -> float:
    want = read_table("paper_friction_events")
    events = np.array(solve(Wheel(s=s), Start(), [0.0, 10.0]).events)
    assert events[:, 1].tolist() == want["mode"].tolist()
    return np.abs(events[:, 0] - want["t"]).max()


def test_all_transitions_of_the_friction_scene_are_at_their_instants() -> None:
    within(instants_error(0.03), 6e-11, "instants error")  # the rounding of the table
    beyond(instants_error(0.03 * (1 + 1e-6)), 1e-6, "instants error")


@pytest.mark.parametrize("rtol", [1e-4, 1e-6])
def test_no_transition_is_lost_at_a_coarse_tolerance(rtol: float) -> None:
    events = solve(FRICTION, Start(), [0.0, 10.0], rtol=rtol).events
    assert [mode for _, mode in events] == read_table("paper_friction_events")["mode"].tolist()
