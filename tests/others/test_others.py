"""wheel.fmu and its equations against derivations, reference results and closed forms that other people made."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physics.leaning import measured_critical_spin
from support.motion import Library

from . import kane_states, wheels
from .numbers import read


@pytest.mark.parametrize("symmetric", [True, False], ids=["J_x = J_y", "any J"])
def test_kanes_method_gives_the_same_accelerations_and_normal_force(symmetric: bool) -> None:
    assert kane_states.distance(symmetric=symmetric) < 1e-11  # measured 2.6e-13
    assert kane_states.distance(10, symmetric, stretched=1 + 1e-9) > 1e-10  # partner: the tube 1e-9 thicker


def test_modelicas_wheel_is_as_far_from_ours_as_from_an_independent_integration(library: Library) -> None:
    true, ours = wheels.modelica_reference(), wheels.modelica(library)
    assert wheels.apart({"x": true["X_O"], "y": true["Y_O"]}, ours) < 1e-8  # m; measured 8.1e-10
    for other in (true, ours):
        assert wheels.apart(read("modelica_wheel"), other) == pytest.approx(5.84e-4, abs=1e-6)  # m


def test_the_drift_of_modelicas_wheel_is_seen_in_its_energy(library: Library) -> None:
    energy, ours = wheels.modelica_energy(), wheels.modelica(library)["E"]
    assert energy[0] == pytest.approx(ours[0], rel=1e-14)
    assert np.ptp(ours) < 1e-8 * ours[0]  # measured 1e-10
    assert 5e-6 < np.abs(energy / energy[0] - 1).max() < 5e-5  # measured 1.3e-5: the table's error, not ours


def test_exudyns_coin_converges_to_ours(library: Library) -> None:
    table, ours = read("exudyn_coin"), wheels.coin(library, 1e-12)
    assert np.abs(wheels.coin_limit(table) - ours).max() < 1e-12  # m; measured 3.5e-14
    off = np.abs(table["x"] - ours[0])
    assert off[:-1] / off[1:] == pytest.approx(4, rel=1e-3)  # second order; measured 4.0000
    assert off[0] > 1e-7  # partner: at its own step it is 8.4e-7 away


def test_the_critical_spin_is_that_of_sympys_disc(library: Library) -> None:
    found = measured_critical_spin(library, wheels.SYMPY_DISC)
    assert found == pytest.approx(wheels.SYMPY_CRITICAL_SPIN, abs=1e-8)  # measured 1.5e-10
    tube = replace(wheels.SYMPY_DISC, r=0.01)
    assert measured_critical_spin(library, tube) != pytest.approx(wheels.SYMPY_CRITICAL_SPIN, abs=1e-4)


@pytest.mark.parametrize("disc", wheels.DISCS, ids=lambda disc: f"m = {disc.m:g}, r_0 = {disc.r_0:g}")
def test_the_rolling_disc_follows_legendre_functions(library: Library, disc: wheels.Wheel) -> None:
    assert wheels.legendre_error(library, disc) < 1e-12  # measured 4e-15 to 6e-14
    judged = replace(disc, J_x=disc.J_x * (1 + 1e-9))
    assert wheels.legendre_error(library, disc, judged) > 1e-11  # partner
