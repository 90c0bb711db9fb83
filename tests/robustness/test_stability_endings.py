"""Runs end flat or by lift-off at the instant of the closed forms, and tell the master so."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from reference import Start, Wheel, solve
from support.bounds import beyond, within
from support.closed_forms import critical_spin, fall_lift_off, fall_time
from support.driver import Values
from support.motion import Library, run
from support.scenes import PAPER, THETA_0

from robustness import checks
from robustness.sweep import FLAT, LIGHT, grazing, inertia

INSTANT = 1e-6  # s, the contract
SPAN = np.array([0.0, 5.0])
AT_REST: Values = {"phi_dot_start": 0.0}


@pytest.mark.parametrize("degrees", [80.0, 75.0, 45.0, 10.0, 1.0])
def test_a_wheel_dropped_at_rest_falls_flat_at_the_instant_of_quadrature(library: Library, degrees: float) -> None:
    theta = float(np.radians(degrees))
    done = run(library, {**AT_REST, "theta_start": theta}, SPAN)
    within(abs(done.end - fall_time(PAPER, theta, FLAT)), 4e-10, "fall time")
    beyond(abs(done.end - fall_time(Wheel(r=0.051), theta, FLAT)), INSTANT, "fall time")
    within(np.sin(done["theta"][-1]), 2 * FLAT, "theta")


def test_the_quadrature_of_the_fall_agrees_with_the_reference() -> None:
    found = solve(PAPER, Start(phi_dot=0.0), [0.0, 2.0], flat=FLAT)
    within(abs(found.ended.time - fall_time(PAPER, THETA_0, FLAT)), 2e-14, "fall time")
    beyond(abs(found.ended.time - fall_time(PAPER, THETA_0 - 1e-8, FLAT)), 7e-10, "fall time")


def test_a_light_wheel_leaves_the_ground_where_its_normal_force_vanishes(library: Library) -> None:
    lifts = fall_lift_off(LIGHT, THETA_0)
    done = run(library, {**AT_REST, **inertia(LIGHT)}, SPAN)
    within(abs(done.end - lifts), 2e-9, "lifts")
    beyond(abs(done.end - fall_lift_off(Wheel(J_x=0.0101, J_y=0.01, J_z=0.01), THETA_0)), INSTANT, "fall lift off")
    assert "lifted off" in done.messages[-1]
    kept = run(library, {**AT_REST, **inertia(LIGHT), "keep_contact": True}, SPAN)
    within(abs(kept.end - fall_time(LIGHT, THETA_0, FLAT)), 3e-10, "fall time")  # goes on to fall flat


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-9, 1e-10, 1e-12])
def test_a_dip_of_a_millionth_of_the_weight_below_zero_is_a_lift_off(library: Library, tolerance: float) -> None:
    leaves, stays = grazing(-1e-6), grazing(1e-6)
    bound = INSTANT if tolerance <= 1e-8 else 10 * INSTANT
    done = run(library, {**AT_REST, **inertia(leaves)}, SPAN, tolerance)
    within(abs(done.end - fall_lift_off(leaves, THETA_0)), bound, "fall lift off")
    done = run(library, {**AT_REST, **inertia(stays)}, SPAN, tolerance)
    within(abs(done.end - fall_time(stays, THETA_0, FLAT)), 2e-10, "fall time")


def test_a_master_sees_the_ending_as_the_standard_says(library: Library) -> None:
    assert [check for check in checks.endings(library) if not check[-1]] == []


def test_contact_kept_goes_on_through_a_pulling_ground_and_says_so_once(library: Library) -> None:
    assert [check for check in checks.kept_contact(library) if not check[-1]] == []


def test_fmpy_simulate_ends_with_the_data_up_to_the_fall(simulate) -> None:
    table = simulate(step=0.01, stop=2.0, phi_dot_start=0.0)
    flat = fall_time(PAPER, THETA_0, FLAT)
    assert flat - 0.01 < table["time"][-1] < flat + INSTANT
    rolling = simulate(step=0.01, stop=2.0)
    beyond(rolling["time"][-1], 1.99, "time")


@pytest.mark.parametrize("ratio", [0.98, 1.02])
def test_upright_rolling_is_stable_above_the_critical_spin_only(library: Library, ratio: float) -> None:
    start = {"theta_start": pi / 2 - 1e-6, "phi_dot_start": -ratio * critical_spin(PAPER)}
    done = run(library, start, np.linspace(0, 60, 601), 1e-10)
    lean = np.abs(done["theta"] - pi / 2).max()
    if ratio > 1:
        within(lean, 1e-4, "lean")
    else:
        beyond(lean, 0.1, "lean")
