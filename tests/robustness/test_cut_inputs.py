"""A given piecewise polynomial input may be cut into communication steps at will, down to the last bit of the time.

Cuts that a master makes by itself: at random, at sums of decimal steps, and in pairs whose gap is next to nothing. The
wheel leans: an upright one cannot see what these inputs do wrong.
"""

from itertools import accumulate
from math import nextafter

import numpy as np
import pytest
from contract.properties import quick, some
from hypothesis import given
from hypothesis import strategies as st
from support.bounds import beyond, within
from support.driver import OK, Values
from support.pieces import Piece, play

STATES = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot")
LEANING: Values = {"theta_start": 1.2, "psi_dot_start": 0.5, "phi_dot_start": -6.0, "s": 0.03}
STOP = 2.0
VARIED: list[Piece] = [
    (0.0, {"M_3": (0.0, 0.5), "F_Y": (1.0, -2.0, 3.0, -0.5), "F_Z": (0.0, 0.0, 8.0)}),
    (0.5, {"M_3": (0.25, -0.5, 0.0, 0.4), "F_Y": (3.0,), "F_Z": (2.0, -4.0)}),
    (1.3, {"M_3": (0.0, 1.5, -1.0), "F_Y": (0.0,), "F_Z": (0.0,)}),
]
HELD: list[Piece] = [(0.0, {"M_3": (0.5,), "F_Z": (3.0,)}), (0.5, {"M_3": (-0.5,), "F_Z": (0.0,)})]
GAPS = (1e-3, 1e-6, 1e-9, 1e-12, 1e-13, 0.0)  # s, 0: to the next number
BOUND = 1  # tolerance of the range of each state over the run

random_cuts = st.lists(st.tuples(some(1e-3, STOP - 1e-3), st.sampled_from(GAPS)), max_size=12)


def motion(wheel, kind, pieces, cuts=(), tolerance=1e-7):
    w = wheel().start(tolerance=tolerance, **kind, **LEANING)
    assert play(w, pieces, STOP, cuts) == OK, w.sentences
    end = np.array(w.get(*STATES))
    w.close()
    return end


def ranges(wheel, pieces):
    """Of each state, from states every twentieth of the run."""
    w, rows = wheel().start(tolerance=1e-7, **LEANING), []
    for k in range(1, 21):
        begin, inputs = max((p for p in pieces if p[0] <= w.time), key=lambda p: p[0])
        w.give(inputs, w.time - begin).to(STOP * k / 20)
        rows.append(w.get(*STATES))
    w.close()
    return np.ptp(rows, axis=0)


def defect(wheel, kind, pieces, cuts, given_pieces=None, tolerance=1e-7):
    """Largest difference that the cuts make, in tolerances of the range."""
    whole = motion(wheel, kind, pieces, (), tolerance)
    cut = motion(wheel, kind, given_pieces or pieces, cuts, tolerance)
    return float(np.max(np.abs(cut - whole) / ranges(wheel, pieces)) / tolerance)


def with_gaps(drawn):
    """Each cut, and another one behind it by the gap."""
    return sorted({t for cut, gap in drawn for t in (cut, cut + gap if gap else nextafter(cut, 9.0))})


@pytest.mark.parametrize("pieces", [VARIED, HELD], ids=["varied", "held"])
def test_random_cuts_change_nothing(wheel, kind, pieces):
    worst = []

    @quick(8)
    @given(random_cuts)
    def check(drawn):
        worst.append(defect(wheel, kind, pieces, with_gaps(drawn)))
        within(worst[-1], BOUND, "difference")

    check()
    assert len(worst) > 4


def test_cuts_that_rounding_makes_change_nothing(wheel, kind):
    """Sums of a thousandth of a second, and a partner that splits at multiples of a tenth and its own sums."""
    sums = list(accumulate([1e-3] * 1999))
    tenths = [*(0.1 * k for k in range(1, 20)), *accumulate([0.1] * 19)]
    within(defect(wheel, kind, VARIED, sums), BOUND, "defect")
    within(defect(wheel, kind, VARIED, tenths), 0.2, "defect, 2")


@pytest.mark.parametrize("gap", GAPS)
def test_a_step_that_is_next_to_nothing_changes_nothing(wheel, kind, gap):
    for tolerance in (1e-9, 1e-6, 1e-4):
        cuts = with_gaps([(1.0, gap)])
        within(defect(wheel, kind, VARIED, cuts, tolerance=tolerance), BOUND, "defect")


def test_the_bound_sees_an_input_that_is_wrong_for_a_tenth_of_a_second(wheel, kind):
    """The partner: a thousandth of one input is too much in a small part of the run."""
    wrong = [*VARIED[:2], (1.2, {"M_3": (-0.099 * 1.001,), "F_Y": (3.0,), "F_Z": (-0.8,)}), VARIED[2]]
    beyond(defect(wheel, kind, VARIED, [1.25], wrong), 1000, "defect")
