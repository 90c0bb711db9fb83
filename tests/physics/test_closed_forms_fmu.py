"""Whole motions known in closed form: straight rolling and its critical speed, standing, tipping, falling, lifting off,
steady circles.

J_x = J_y; formulas and their derivations in support/closed_forms.py.
"""

from math import cosh, pi

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth import exact_motions as exact
from wheelfmu.truth.closed_forms import critical_spin, tipping_inertia, upright_stiffness
from wheelfmu.truth.motion import Library
from wheelfmu.truth.reference import Wheel

THIN = Wheel(r=0.0)


def test_upright_rolling_slows_down_linearly_and_then_stands(library: Library, formulation: int) -> None:
    rough = Wheel(s=0.03)
    within(exact.straight_error(library, formulation, 0.03, rough), 1024 * 2 * EPSILON, "spin, rad/s, and way, m")
    beyond(exact.straight_error(library, formulation, 0.03, Wheel(s=0.03, r=0.0)), 0.1, "spin and way of a disc")


def test_a_standing_wheel_tips_by_the_hyperbolic_cosine(library: Library) -> None:
    def gap(judged: Wheel) -> float:
        times = np.linspace(0, 1.5, 151)
        start = {**exact.UPRIGHT, "theta_start": pi / 2 - 1e-6, "phi_dot_start": 0.0}
        lean = pi / 2 - library.simulate(times, 1e-12, s=0.03, **start)["theta"]
        growth = (58.86 / tipping_inertia(judged)) ** 0.5
        return float(np.abs(lean / [1e-6 * cosh(growth * t) for t in times] - 1).max())

    within(gap(Wheel()), 2e-8, "lean, relative")  # the second order is lean^2
    beyond(gap(THIN), 0.1, "lean of a disc, relative")


def test_the_wheel_lies_flat_at_the_instant_of_the_closed_form(library: Library, formulation: int) -> None:
    within(exact.fall_error(library, formulation, Wheel()), 4e-10, "instant at which it lies flat, s")
    beyond(exact.fall_error(library, formulation, THIN), 1e-2, "instant at which a disc lies flat, s")


def test_a_wheel_released_without_spin_falls_as_printed(library: Library, formulation: int) -> None:
    """The row of docs/equations.md along the whole fall; a torus has a term more than a thin disc."""

    def gap(s: float, carried: float) -> float:
        run = library.simulate(np.linspace(0, 0.59, 60), 1e-11, formulation=formulation, phi_dot_start=0.0, s=s)
        theta, rate = run["theta"], run["theta_dot"]
        assert theta[-1] < 0.05
        inertia = 0.9 + 20 * (0.3**2 + 2 * 0.3 * 0.05 * np.sin(theta) + 0.05**2)
        printed = -20 * 0.3 * np.cos(theta) * (9.81 + carried * 0.05 * rate**2) / inertia
        return float(np.abs(run["theta_ddot"] - printed).max())

    for s in (0.0, 0.03):  # free, held
        within(gap(s, 1), 64 * 25 * EPSILON, "theta_ddot, rad/s2")
        beyond(gap(s, 0), 1, "theta_ddot without the term in theta_dot^2, rad/s2")


def test_a_light_rim_lifts_off_where_the_normal_force_of_the_fall_vanishes(library: Library, formulation: int) -> None:
    within(exact.lift_off_error(library, formulation, 0.0), 2e-8, "instant, s, and angle of the lift-off, rad")
    beyond(exact.lift_off_error(library, formulation, 1e-5), 1e-6, "instant, s, and angle of another lift-off, rad")


CIRCLES = [(THIN, Wheel(), 0.07, psi_dot, theta) for psi_dot, theta in ((1.0, 1.1), (-2.0, 1.1), (6.0, 0.3))]
OFF = Wheel(m=20 * (1 + 1e-5))
CIRCLES += [(Wheel(), OFF, 2e-6, psi_dot, theta) for psi_dot, theta in ((1.0, 1.1), (-2.0, 1.9), (6.0, 0.5))]


@pytest.mark.parametrize(("wheel", "other", "least", "psi_dot", "theta"), CIRCLES)
def test_thin_disc_and_torus_stay_each_in_its_steady_circle(library, formulation, wheel, other, least, psi_dot, theta):
    """That of the disc is in textbooks; there a torus wanders."""
    wander = exact.circle_error(library, wheel, wheel, formulation, psi_dot, theta)
    within(wander, 1e-11 if formulation == 3 else 4096 * EPSILON, "wander, rad, rad/s, m/s")
    beyond(exact.circle_error(library, other, wheel, formulation, psi_dot, theta), least, "wander off another circle")


# The critical speed of upright straight rolling: the paper's wheel needs 2.63 rad/s and has 2. A lean e = theta - pi/2
# follows e'' = -kappa^2 e with kappa^2 linear in omega_z^2.


def test_a_lean_swings_or_grows_by_the_linearised_equation(library: Library) -> None:
    times = np.linspace(0, 1.5, 31)

    def gap(judged: Wheel, factor: float) -> float:
        omega_z = factor * critical_spin(exact.TORUS)
        kappa = np.sqrt(complex(upright_stiffness(judged, omega_z)))
        return float(np.abs(exact.lean_of(library, omega_z, times) - np.cos(kappa * times).real).max())

    for factor in (0.5, 0.9, 1.1, 2.0):
        within(gap(exact.TORUS, factor), 2e-6, "lean over that at the start")
        beyond(gap(Wheel(r=0.0), factor), 1e-2, "lean of a disc over that at the start")


def test_the_critical_speed_is_the_zero_of_the_measured_stiffness(library: Library) -> None:
    found = exact.measured_critical_spin(library)
    within(abs(found / critical_spin(exact.TORUS) - 1), 3e-9, "critical spin, relative")
    beyond(abs(found / critical_spin(Wheel(r=0.0)) - 1), 0.05, "critical spin by the thin disc's formula, relative")
    lever = ((exact.TORUS.r_0 + exact.TORUS.r) / exact.TORUS.r_0) ** 0.5  # the weight's lever taken as r_0 + r
    beyond(abs(found / (lever * critical_spin(exact.TORUS)) - 1), 0.05, "critical spin by that lever, relative")
