"""A given piecewise polynomial input may be cut into communication steps at will, down to the last bit of the time.

Cuts that a master makes by itself: at random, at sums of decimal steps, and in pairs whose gap is next to nothing. The
wheel leans: an upright one cannot see what these inputs do wrong.
"""

from itertools import accumulate, pairwise
from math import nextafter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bounds import absolute_error, beyond, within
from support.playing import Piece

from wheelfmu.fmu.driver import Values, shifted
from wheelfmu.truth.scenes import FORCED

STATES = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot")
RUNGE_KUTTA: Values = {"formulation": 2, "method": 4}
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
RESTART = 0.1  # the same, what a restart may add: a cut restarts CVODE where an input varies

random_cuts = st.lists(st.tuples(st.floats(1e-3, STOP - 1e-3), st.sampled_from(GAPS)), max_size=12)


@pytest.fixture
def defect(played):
    """defect(kind, pieces, cuts): the largest difference that the cuts make, in tolerances of each state's range."""

    def motion(pieces, stop=STOP, cuts=(), **choices):
        begun = [piece for piece in pieces if piece[0] < stop]
        return np.array(played(begun, stop, cuts, STATES, **LEANING, **choices))

    def find(kind, pieces, cuts, given_pieces=None, tolerance=1e-7):
        whole = motion(pieces, tolerance=tolerance, **kind)
        cut = motion(given_pieces or pieces, cuts=cuts, tolerance=tolerance, **kind)
        ranges = np.ptp([motion(pieces, STOP * k / 20, tolerance=1e-7) for k in range(1, 21)], axis=0)
        return float(np.max(np.abs(cut - whole) / ranges) / tolerance)

    return find


def bound_of(kind, pieces, cuts, share=1.0):
    """Of the difference that the cuts may make. A restart can turn a step of CVODE that is just accepted into one that
    is just rejected: the share does not reduce what restarts may add."""
    restarts = kind["method"] in (2, 3) and pieces is VARIED
    return share * BOUND + RESTART * len(cuts) * restarts


def with_gaps(drawn):
    """Each cut, and another one behind it by the gap."""
    return sorted({t for cut, gap in drawn for t in (cut, cut + gap if gap else nextafter(cut, 9.0))})


@pytest.mark.parametrize("pieces", [VARIED, HELD], ids=["varied", "held"])
def test_random_cuts_change_nothing(defect, kind, pieces):
    worst = []

    @settings(max_examples=8)
    @given(random_cuts)
    def check(drawn):
        cuts = with_gaps(drawn)
        worst.append(defect(kind, pieces, cuts))
        within(worst[-1], bound_of(kind, pieces, cuts), "difference by the cuts, tolerances of the range")

    check()
    assert len(worst) > 4


def test_cuts_that_rounding_makes_change_nothing(defect, kind):
    """Sums of a thousandth of a second, and a partner that splits at multiples of a tenth and its own sums."""
    sums = list(accumulate([1e-3] * 1999))
    tenths = [*(0.1 * k for k in range(1, 20)), *accumulate([0.1] * 19)]
    for cuts, share, name in ((sums, 1, "sums of steps"), (tenths, 0.2, "tenths and their sums")):
        bound = bound_of(kind, VARIED, cuts, share)
        within(defect(kind, VARIED, cuts), bound, f"difference by {name}, tolerances of the range")


@pytest.mark.parametrize("gap", GAPS)
def test_a_step_that_is_next_to_nothing_changes_nothing(defect, kind, gap):
    for tolerance in (1e-9, 1e-6, 1e-4):
        cuts = with_gaps([(1.0, gap)])
        found = defect(kind, VARIED, cuts, tolerance=tolerance)
        within(found, bound_of(kind, VARIED, cuts), "change by the step, tolerances of the range")


def test_the_bound_sees_an_input_that_is_wrong_for_a_tenth_of_a_second(defect, kind):
    """The partner: a thousandth of one input is too much in a small part of the run."""
    wrong = [*VARIED[:2], (1.2, {"M_3": (-0.099 * 1.001,), "F_Y": (3.0,), "F_Z": (-0.8,)}), VARIED[2]]
    beyond(defect(kind, VARIED, [1.25], wrong), 1000, "difference by a wrong input, tolerances of the range")


OFF = 1e-6  # of three start values, to see how errors grow


def brake_of(rng):
    """A polynomial that falls through zero inside one second and may rise and fall again, and the instants at which it
    passes zero."""
    first = rng.uniform(0.05, 0.95)
    roots = np.array([first, *rng.uniform(first + 1e-3, 2.0, rng.integers(0, 3))])
    c = np.polynomial.polynomial.polyfromroots(roots)
    return c / c[0] * 10 ** rng.uniform(-1.5, 1), np.sort(roots[roots < 1])


def cut_where_it_passes_zero(brake, passed):
    """The brake in several pieces, none where the polynomial is below zero."""
    pieces = []
    for begin, end in pairwise([0.0, *passed, 1.0]):
        acts = np.polynomial.polynomial.polyval(0.5 * (begin + end), brake) > 0
        piece = [brake[0] if begin == 0 else 0.0, *shifted(brake, begin)[1:]]
        pieces.append((begin, {"M_brake": piece if acts else [0.0]}))
    return pieces


@pytest.mark.parametrize("seed", range(40))
def test_a_brake_that_passes_zero_inside_a_step_is_as_exact_as_one_cut_there(played, seed):
    rng = np.random.default_rng(seed)
    start = {"theta_start": rng.uniform(1.0, 2.1), "psi_dot_start": rng.uniform(-2, 2), "s": rng.choice([0.0, 0.01])}
    start |= {"phi_dot_start": rng.choice([-1, 1]) * 10 ** rng.uniform(-1.5, 0.7), "keep_contact": True}
    brake, passed = brake_of(rng)

    def error(tolerance, pieces, **choices):
        return absolute_error(played(pieces, 1.0, (), STATES, tolerance=tolerance, **start | choices), exact)

    exact = played(cut_where_it_passes_zero(brake, passed), 1.0, (), STATES, tolerance=1e-13, **start)
    whole = [(0.0, {"M_brake": brake})]
    moved = [{name: start[name] + OFF} for name in ("theta_start", "psi_dot_start", "phi_dot_start")]
    growth = max(error(1e-12, whole, **choices) / OFF for choices in moved)

    def worst(kind, tolerances, pieces=whole):
        return max(error(tolerance, pieces, **kind) / tolerance for tolerance in tolerances) / max(growth, 1)

    for kind in FORCED:
        within(worst(kind, [10 ** rng.uniform(-12, -8)]), 30, "error over growth, tolerances")
    tolerances = np.geomspace(1e-12, 1e-9, 7)  # Runge-Kutta's long steps see most of the corner
    within(worst(RUNGE_KUTTA, tolerances), 1, "error over growth by Runge-Kutta, tolerances")
    stronger = [(0.0, {"M_brake": 1.001 * brake})]  # the partner
    beyond(worst(RUNGE_KUTTA, tolerances, stronger), 30, "error over growth of a stronger brake, tolerances")
