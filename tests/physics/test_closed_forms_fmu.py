"""Whole motions known in closed form: straight rolling, standing, tipping, falling, lifting off, steady circles.

J_x = J_y; formulas and their derivations in support/closed_forms.py.
"""

from math import cosh, pi

import numpy as np
import pytest
from reference import Wheel
from support.bounds import EPSILON, beyond, within
from support.closed_forms import rolling_inertia, tipping_inertia
from support.motion import Library
from support.schedule import Schedule

from .exact_motions import UPRIGHT, circle_error, fall_error, lift_off_error, straight_error

THIN = Wheel(r=0.0)


def test_upright_rolling_slows_down_linearly_and_then_stands(library: Library, formulation: int) -> None:
    rough = Wheel(s=0.03)
    within(straight_error(library, formulation, 0.03, rough), 1024 * 2 * EPSILON, "straight error")  # of 2 rad/s
    beyond(straight_error(library, formulation, 0.03, Wheel(s=0.03, r=0.0)), 0.1, "straight error")


def test_a_standing_wheel_tips_by_the_hyperbolic_cosine(library: Library) -> None:
    def gap(judged: Wheel) -> float:
        times = np.linspace(0, 1.5, 151)
        start = {**UPRIGHT, "theta_start": pi / 2 - 1e-6, "phi_dot_start": 0.0}
        lean = pi / 2 - library.simulate(times, 1e-12, s=0.03, **start)["theta"]
        growth = (58.86 / tipping_inertia(judged)) ** 0.5
        return float(np.abs(lean / [1e-6 * cosh(growth * t) for t in times] - 1).max())

    within(gap(Wheel()), 2e-8, "gap")  # the second order is lean^2
    beyond(gap(THIN), 0.1, "gap")


def test_drive_and_brake_torque_move_an_upright_wheel_as_a_roller(library: Library) -> None:
    torque = Schedule(((0.0, {"M_3": (3.0, -4.0, 1.5)}), (1.0, {"M_3": -2.0})))

    def gap(judged: Wheel) -> float:
        times = np.linspace(0, 2, 41)
        run = library.simulate(times, inputs=torque, **{**UPRIGHT, "phi_dot_start": -10.0})
        smooth, late = np.minimum(times, 1), np.maximum(times - 1, 0)
        impulse = 3 * smooth - 2 * smooth**2 + 0.5 * smooth**3 - 2 * late
        return float(np.abs(run["omega_z"] + 10 - impulse / rolling_inertia(judged)).max())

    within(gap(Wheel()), 128 * 10 * EPSILON, "gap")  # of 10 rad/s; the method is exact for a cubic
    beyond(gap(THIN), 0.01, "gap")


def test_the_wheel_falls_flat_at_the_instant_of_the_closed_form(library: Library, formulation: int) -> None:
    within(fall_error(library, formulation, Wheel()), 4e-10, "fall error")  # s
    beyond(fall_error(library, formulation, THIN), 1e-2, "fall error")


def test_a_light_rim_lifts_off_where_the_normal_force_of_the_fall_vanishes(library: Library, formulation: int) -> None:
    within(lift_off_error(library, formulation, 0.0), 2e-8, "lift off error")
    beyond(lift_off_error(library, formulation, 1e-5), 1e-6, "lift off error")


CIRCLES = [(THIN, Wheel(), 0.07, psi_dot, theta) for psi_dot, theta in ((1.0, 1.1), (-2.0, 1.1), (6.0, 0.3))]
OFF = Wheel(m=20 * (1 + 1e-5))
CIRCLES += [(Wheel(), OFF, 2e-6, psi_dot, theta) for psi_dot, theta in ((1.0, 1.1), (-2.0, 1.9), (6.0, 0.5))]


@pytest.mark.parametrize(("wheel", "other", "least", "psi_dot", "theta"), CIRCLES)
def test_thin_disc_and_torus_stay_each_in_its_steady_circle(library, formulation, wheel, other, least, psi_dot, theta):
    """That of the disc is in textbooks; there a torus wanders."""
    within(circle_error(library, wheel, wheel, formulation, psi_dot, theta), 1e-10, "circle error")  # ten tolerances
    beyond(circle_error(library, other, wheel, formulation, psi_dot, theta), least, "circle error")
