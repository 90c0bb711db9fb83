"""The reference's brake over time, against closed forms: stopping instant and distance, holding, release.

An upright wheel, straight rolling; the FMU is judged by this reference elsewhere.
"""

from math import pi

import numpy as np
import pytest
from reference import Inputs, Start, Wheel, solve
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within

ROLLING = Start(psi=0.0, theta=pi / 2, phi_dot=-20.0, X_O=0.0)
RESTING = Start(psi=0.0, theta=pi / 2, phi_dot=0.0, X_O=0.0)
R, INERTIA = 0.35, 1.8 + 20 * 0.35**2  # m; kg m2 about the contact


@pytest.mark.parametrize("s", [0.0, 0.01])
def test_the_wheel_stops_at_the_instant_and_place_of_constant_deceleration_and_stays(s: float) -> None:
    brake, wheel = 30.0, Wheel(s=s)
    deceleration = (brake + s * wheel.m * wheel.g) / INERTIA  # rad/s2
    stop, way = 20 / deceleration, R * 20**2 / (2 * deceleration)
    run = solve(wheel, ROLLING, [0, stop / 2, stop + 1, stop + 2], Inputs(brake=lambda t: brake))
    assert [mode for _, mode in run.events] == [-1, 0]
    within(relative_error(run.events[1][0], stop), 64 * EPSILON, "instant")
    within(relative_error(run["X_O"][1:], [0.75 * way, way, way]), 64 * EPSILON, "X_O")
    assert run["omega_z"][2:].tolist() == [0, 0]
    without = solve(wheel, ROLLING, [0, stop + 1])
    beyond(without["X_O"][-1] / way, 1.1, "X_O")


def test_a_held_wheel_goes_where_a_ramp_of_force_exceeds_the_brake() -> None:
    inputs = Inputs(force=lambda t: (10 * t, 0.0, 0.0), brake=lambda t: 7.0)
    run = solve(Wheel(), RESTING, np.array([0, 1, 3]), inputs)
    assert [mode for _, mode in run.events] == [0, -1]
    within(relative_error(run.events[1][0], 7 / (R * 10)), 64 * EPSILON, "instant")  # R F = brake at 2 s
    within(absolute_error(run["X_O"][1], 0), 4 * EPSILON, "X_O")  # m
    within(relative_error(run["tau"][1], R * 10), 64 * EPSILON, "tau")
    beyond(run["X_O"][2], 0.01, "X_O")


def test_a_brake_that_is_let_off_holds_no_longer() -> None:
    inputs = Inputs(force=lambda t: (10.0, 0.0, 0.0), brake=lambda t: 7.0 if t < 1 else 1.0, jumps=(1.0,))
    run = solve(Wheel(), RESTING, np.array([0, 1, 2]), inputs)
    acceleration = R * (R * 10 - 1) / INERTIA
    within(absolute_error(run["X_O"][1:] / acceleration, [0, 0.5]), 64 * EPSILON, "X_O")
