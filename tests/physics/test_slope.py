"""A road that slopes: rolling down, standing and braked against closed forms and the reference.

The axes are the road's, Z across it; the weight is m g (-sin a cos b, -sin a sin b, -cos a) for a slope a that rises
towards b. Upright wheels head along X (psi = 0), R = r_0 + r. SI units.
"""

from functools import partial
from math import atan, cos, pi, sin

import numpy as np
import pytest
from reference import Wheel, solve
from support.bounds import EPSILON, beyond, within
from support.closed_forms import rolling_inertia
from support.kept import kept
from support.motion import Library, start_values

from .cases import random_scene
from .exact_motions import UPRIGHT

R, WEIGHT = 0.35, 20 * 9.81
REST = {**UPRIGHT, "phi_dot_start": 0.0}
DOWNHILL = {"slope_direction": pi}  # the road falls towards X


def rolled(library: Library, formulation: int, slope: float, s: float) -> float:
    """X_O at 1.5 s over the way of a uniform acceleration by R m g (R sin a - s cos a) / (J_z + m R^2), less one."""
    acceleration = R * WEIGHT * (R * sin(0.2) - s * cos(0.2)) / rolling_inertia(Wheel())
    run = library.simulate([0.0, 1.5], 1e-10, slope=slope, s=s, formulation=formulation, **DOWNHILL, **REST)
    return abs(run["X_O"][-1] / (acceleration * 1.5**2 / 2) - 1)


@pytest.mark.parametrize("s", [0.0, 0.03], ids=["free", "friction"])
def test_a_wheel_rolls_straight_down_with_uniform_acceleration(library: Library, formulation: int, s: float) -> None:
    within(rolled(library, formulation, 0.2, s), 128 * EPSILON, "way")
    beyond(rolled(library, formulation, 0.2 * (1 + 1e-8), s), 1e-9, "way on a steeper road")


@pytest.mark.parametrize("s", [0.01, 0.03])
def test_a_wheel_set_down_stays_exactly_while_the_rolling_friction_can_hold_it(library: Library, s: float) -> None:
    steepest = atan(s / R)
    stays = library.simulate([0.0, 5.0], slope=steepest * (1 - 1e-9), s=s, **REST)
    assert (stays["omega_z"] == 0).all()
    within(np.abs(stays["X_O"]).max(), EPSILON, "creep, m")
    rolls = library.simulate([0.0, 5.0], slope=steepest * (1 + 1e-9), s=s, **REST)
    assert rolls["X_O"][-1] < 0 and rolls["friction_mode"][-1] == 1  # downhill, away from X


def parked(library: Library, slope: float, seconds: float) -> float:
    """X_O of an upright wheel with a brake of 20 N m; M_1 and M_2, every 50 ms, keep it upright and straight."""
    with library.wheel() as wheel:
        wheel.set(slope=slope, **REST)
        wheel.initialise(1e-10)
        wheel.set(M_brake=20.0)
        for k in range(round(seconds / 0.05)):
            tilt, tilt_rate, heading, turn = wheel.get("theta", "theta_dot", "psi", "psi_dot")
            wheel.put(M_1=-120 * (tilt - pi / 2) - 20 * tilt_rate, M_2=-50 * heading - 20 * turn).to((k + 1) * 0.05)
        return wheel.get("X_O")[0]


def test_a_brake_holds_exactly_up_to_its_capacity_and_lets_go_beyond(library: Library) -> None:
    steepest = np.arcsin(20.0 / (R * WEIGHT))
    within(abs(parked(library, steepest * (1 - 1e-9), 600.0)), EPSILON, "creep, m")  # in ten minutes
    beyond(-parked(library, steepest * (1 + 1e-6), 5.0), 2e-6, "way beyond the capacity, m")


def test_a_level_road_has_no_direction(library: Library) -> None:
    motion = {"theta_start": 1.2, "psi_start": 0.4, "phi_dot_start": -6.0, "psi_dot_start": 0.5}
    level, turned = (library.simulate([0.0, 2.5, 5.0], slope_direction=way, **motion) for way in (0.0, 0.7))
    assert all((level[c] == turned[c]).all() for c in level.columns)


def reference_gap(library: Library, seed: int, formulation: int) -> tuple[float, float]:
    """Largest difference from the reference after 0.5 s and 1 s; and that of a slope that is 1e-6 steeper."""
    wheel, start = random_scene(np.random.default_rng(seed))
    names = ("X_O", "Y_O", "theta", "psi", "phi", "omega_z", "E")
    question = (wheel, start, [0.0, 0.5, 1.0])
    want = kept(question, partial(solve, *question, rtol=1e-12))
    gaps = []
    for slope in (wheel.slope, wheel.slope * (1 + 1e-6)):
        values = {**start_values(wheel, start), "slope": slope, "formulation": formulation}
        run = library.simulate(question[2], 1e-11, keep_contact=True, **values)
        gaps.append(max(float(np.abs(run[c] - want[c]).max() / (1 + np.abs(want[c]).max())) for c in names))
    return gaps[0], gaps[1]


@pytest.mark.parametrize("decade", range(4))
def test_forty_random_slopes_agree_with_the_independent_reference(library: Library, decade: int) -> None:
    gaps = [reference_gap(library, 10 * decade + k, 2 + k % 2) for k in range(10)]
    within(max(found for found, _ in gaps), 3e-10, "gap")
    beyond(max(steeper for _, steeper in gaps), 1e-7, "gap to a steeper road")


def test_a_road_of_ninety_degrees_is_refused_with_a_message(library: Library) -> None:
    with library.wheel(logging=True) as wheel:
        wheel.set(slope=pi / 2)
        wheel.initialise()
        assert any("slope = 1.57079633 rad: it must be less than 1.5708." in sentence for sentence in wheel.sentences)
