"""A given piecewise polynomial input may be cut into communication steps at will, down to the last bit of the time.

Cuts that a master makes by itself: at random, at sums of decimal steps, and in pairs whose gap is next to nothing. The
wheel leans: an upright one cannot see what these inputs do wrong.
"""

from itertools import accumulate, pairwise
from math import nextafter

import numpy as np
import pytest
from contract.properties import quick, some
from hypothesis import given
from hypothesis import strategies as st
from support.bounds import absolute_error, beyond, within
from support.driver import OK, Values, shifted
from support.pieces import Piece, play
from support.scenes import FORCED

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


OFF = 1e-6  # of three start values, to see how errors grow


def brake_of(rng):
    """A polynomial that falls through zero inside one second and may rise and fall again, and the instants at which it
    passes zero."""
    first = rng.uniform(0.05, 0.95)
    roots = np.array([first, *rng.uniform(first + 1e-3, 2.0, rng.integers(0, 3))])
    c = np.polynomial.polynomial.polyfromroots(roots)
    return c / c[0] * 10 ** rng.uniform(-1.5, 1), np.sort(roots[roots < 1])


def braked(wheel, start, brake, cuts, **choices):
    """The states at 1 s: the brake as one polynomial, or cut where it passes zero, its pieces below zero left out."""
    w = wheel().start(keep_contact=True, **start, **choices)
    for begin, end in pairwise([0.0, *cuts, 1.0]):
        acts = not cuts or np.polynomial.polynomial.polyval(0.5 * (begin + end), brake) > 0
        piece = shifted(brake, begin) if begin == 0 else [0.0, *shifted(brake, begin)[1:]]
        w.give({"M_brake": piece if acts else [0.0]})
        assert w.step_to(end) == OK, w.sentences
    states = np.array(w.get(*STATES))
    w.close()
    return states


@pytest.mark.parametrize("seed", range(40))
def test_a_brake_that_passes_zero_inside_a_step_is_as_exact_as_one_cut_there(wheel, seed):
    rng = np.random.default_rng(seed)
    start = {"theta_start": rng.uniform(1.0, 2.1), "psi_dot_start": rng.uniform(-2, 2), "s": rng.choice([0.0, 0.01])}
    start["phi_dot_start"] = rng.choice([-1, 1]) * 10 ** rng.uniform(-1.5, 0.7)
    brake, passed = brake_of(rng)
    exact = braked(wheel, start, brake, list(passed), tolerance=1e-13)
    moved = [{**start, name: start[name] + OFF} for name in ("theta_start", "psi_dot_start", "phi_dot_start")]
    growth = max(absolute_error(braked(wheel, m, brake, [], tolerance=1e-12), exact) / OFF for m in moved)

    def worst(kind, tolerances, factor=1.0):
        ends = [(braked(wheel, start, factor * brake, [], tolerance=t, **kind), t) for t in tolerances]
        return max(absolute_error(end, exact) / t for end, t in ends) / max(growth, 1)

    for kind in FORCED:
        within(worst(kind, [10 ** rng.uniform(-12, -8)]), 30, "tolerances over growth")
    tolerances = np.geomspace(1e-12, 1e-9, 7)  # Runge-Kutta's long steps see most of the corner
    within(worst(RUNGE_KUTTA, tolerances), 1, "tolerances over growth, Runge-Kutta")
    beyond(worst(RUNGE_KUTTA, tolerances, 1.001), 30, "tolerances over growth of a stronger brake")  # the partner


@pytest.mark.parametrize("kind", [kind for kind in FORCED if kind["method"] in (2, 3)], ids=str)
def test_a_method_that_is_not_cut_by_the_grid_passes_the_corner_with_the_same_bits(wheel, kind):
    rng = np.random.default_rng(3)
    for _ in range(5):
        brake, ends = brake_of(rng)[0], []
        for count in (0, 1, 20):
            w = wheel().start(**kind, **LEANING)
            cuts = rng.uniform(0, 1, count)  # a brake below zero cannot be set
            cuts = cuts[np.polynomial.polynomial.polyval(cuts, brake) > 0]
            assert play(w, [(0.0, {"M_brake": brake})], 1.0, cuts) == OK
            ends.append(w.bits())
        assert ends[0] == ends[1] == ends[2]
