"""The control engineer's example: each of its three parts against what it must come to."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from support.paths import ROOT

sys.path.insert(0, str(ROOT / "examples" / "control"))
import control


@pytest.fixture(scope="module")
def folder(fmu) -> str:
    return str(fmu)


def test_the_eigenvalues_vanish_at_the_critical_spin_of_the_closed_form(folder):
    for spin, unstable in ((control.CRITICAL - 1e-6, True), (control.CRITICAL + 1e-6, False)):
        A, _ = control.linearized(folder, -spin, ())
        assert (np.linalg.eigvals(A).real.max() > 5e-4) == unstable


def test_the_regulator_holds_a_wheel_that_falls_alone(folder):
    gains = control.regulator(folder, -1.5)
    assert np.abs(control.rolled(folder, None, -1.5)[2]).max() > 45  # degrees
    _, off, lean = control.rolled(folder, gains, -1.5)
    assert abs(lean[-1]) < 0.1 and abs(off[-1]) < 0.01


def test_the_optimal_moments_stay_in_their_bounds_and_lead_to_the_line(folder):
    t, x, moments = control.optimal(folder)
    assert (np.abs(moments).max(axis=1) <= np.array(control.BOUNDS) * (1 + 1e-6)).all()
    end = control.checked(folder, t, x, moments)
    off = np.abs(end - x[:, -1])[[1, 2, 3]]  # Y_O, psi, theta
    assert off.max() < 0.05  # the midpoint rule with steps of 50 ms
    assert np.abs(control.checked(folder, t, x, 0 * moments) - x[:, -1])[[1, 2, 3]].max() > 0.1
