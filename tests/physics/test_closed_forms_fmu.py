"""Whole motions known in closed form: straight rolling and its critical speed, standing, tipping, falling, lifting off,
steady circles. A table of motion, truth and bound.

J_x = J_y; the formulas are in truth/closed_forms.py, their distance from the FMU's motion in truth/exact_motions.py.
"""

from collections.abc import Callable
from math import cosh, pi

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.truth import exact_motions as exact
from wheelfmu.truth.closed_forms import critical_spin, tipping_inertia, upright_stiffness
from wheelfmu.truth.exact_motions import TORUS
from wheelfmu.truth.motion import Library
from wheelfmu.truth.reference import Wheel

THIN = Wheel(r=0.0)
Error = Callable[[Library, int, Wheel], float]  # of the FMU's torus off the closed form of the wheel


def tipping(library: Library, formulation: int, judged: Wheel) -> float:
    """Of a standing wheel, relative: the lean grows by the hyperbolic cosine."""
    times, start = np.linspace(0, 1.5, 151), {**exact.UPRIGHT, "theta_start": pi / 2 - 1e-6, "phi_dot_start": 0.0}
    lean = pi / 2 - library.simulate(times, 1e-12, s=0.03, formulation=formulation, **start)["theta"]
    growth = (58.86 / tipping_inertia(judged)) ** 0.5
    return absolute_error(lean / [1e-6 * cosh(growth * t) for t in times], 1)


def falling(s: float) -> Error:
    """The row of docs/equations.md along the whole fall without spin, free or held; a torus has a term more than a thin
    disc."""

    def error(library: Library, formulation: int, judged: Wheel) -> float:
        run = library.simulate(np.linspace(0, 0.59, 60), 1e-11, formulation=formulation, phi_dot_start=0.0, s=s)
        theta, rate = run["theta"], run["theta_dot"]
        assert theta[-1] < 0.05
        inertia = 0.9 + 20 * (0.3**2 + 2 * 0.3 * 0.05 * np.sin(theta) + 0.05**2)
        printed = -20 * 0.3 * np.cos(theta) * (9.81 + judged.r * rate**2) / inertia
        return absolute_error(run["theta_ddot"], printed)

    return error


def circling(psi_dot: float, theta: float) -> Error:
    return lambda library, form, judged: exact.circle_error(library, TORUS, judged, form, psi_dot, theta)


def swinging(factor: float) -> Error:
    """Near the critical speed, of which the paper's wheel has 2 of 2.63 rad/s: a lean e = theta - pi/2 follows
    e'' = -kappa^2 e with kappa^2 linear in omega_z^2."""
    times = np.linspace(0, 1.5, 31)

    def error(library: Library, _: int, judged: Wheel) -> float:
        omega_z = factor * critical_spin(TORUS)
        kappa = np.sqrt(complex(upright_stiffness(judged, omega_z)))
        return absolute_error(exact.lean_of(library, omega_z, times), np.cos(kappa * times).real)

    return error


# Error, its bound, another wheel and the error that its closed form must at least show.
MOTIONS: dict[str, tuple[Error, float, Wheel, float]] = {
    "slows down and stands": (
        lambda library, form, judged: exact.straight_error(library, form, 0.03, Wheel(s=0.03, r=judged.r)),
        *(1024 * 2 * EPSILON, THIN, 0.1),
    ),
    "tips": (tipping, 2e-8, THIN, 0.1),  # the second order is lean^2
    "lies flat": (exact.fall_error, 4e-10, THIN, 1e-2),
    "falls free": (falling(0.0), 64 * 25 * EPSILON, THIN, 1.0),
    "falls held": (falling(0.03), 64 * 25 * EPSILON, THIN, 1.0),
}
OFF = Wheel(m=20 * (1 + 1e-5))
MOTIONS |= {f"circles at {at}": (circling(*at), 1e-11, OFF, 2e-6) for at in ((1.0, 1.1), (-2.0, 1.9), (6.0, 0.5))}
MOTIONS |= {f"{factor} of the critical speed": (swinging(factor), 2e-6, THIN, 1e-2) for factor in (0.5, 0.9, 1.1, 2.0)}


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
def test_the_motion_is_that_of_the_closed_form(library: Library, formulation: int, motion) -> None:
    error, bound, other, least = motion
    within(error(library, formulation, TORUS), bound, "error, SI or relative")
    beyond(error(library, formulation, other), least, "error off the closed form of another wheel")


def test_a_thin_disc_stays_in_the_steady_circle_of_textbooks_where_a_torus_wanders(library, formulation) -> None:
    for psi_dot, theta in ((1.0, 1.1), (-2.0, 1.1), (6.0, 0.3)):
        within(exact.circle_error(library, THIN, THIN, formulation, psi_dot, theta), 1e-11, "wander, rad, rad/s, m/s")
        beyond(exact.circle_error(library, TORUS, THIN, formulation, psi_dot, theta), 0.07, "wander of a torus")


def test_a_light_rim_lifts_off_where_the_normal_force_of_the_fall_vanishes(library: Library, formulation: int) -> None:
    within(exact.lift_off_error(library, formulation, 0.0), 2e-8, "instant, s, and angle of the lift-off, rad")
    beyond(exact.lift_off_error(library, formulation, 1e-5), 1e-6, "instant, s, and angle of another lift-off, rad")


def test_the_critical_speed_is_the_zero_of_the_measured_stiffness(library: Library) -> None:
    found = exact.measured_critical_spin(library)
    within(abs(found / critical_spin(TORUS) - 1), 3e-9, "critical spin, relative")
    beyond(abs(found / critical_spin(THIN) - 1), 0.05, "critical spin by the thin disc's formula, relative")
    lever = ((TORUS.r_0 + TORUS.r) / TORUS.r_0) ** 0.5  # the weight's lever taken as r_0 + r
    beyond(abs(found / (lever * critical_spin(TORUS)) - 1), 0.05, "critical spin by that lever, relative")
