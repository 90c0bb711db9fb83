"""What the free wheel keeps: its orbit, Chaplygin's linear integrals, its constraints; and the limits without weight.

s = 0, J_x = J_y. The wheel of the paper starts at a turning point of theta (theta_dot = 0).
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from reference import Wheel
from scipy.optimize import brentq
from support.bounds import EPSILON, beyond, within
from support.closed_forms import linear_integrals
from support.motion import Library
from support.schedule import Schedule

from .measure import constraint_drift, unstabilised_drift

Array = NDArray[np.float64]


def turning_point(library: Library) -> float:
    """Half a period of theta: the first instant after the start at which theta_dot is 0 again, s."""
    return brentq(lambda t: library.simulate([0.0, t], 1e-13)["theta_dot"][-1], 0.6, 1.2, xtol=1e-13)


def omegas(columns) -> Array:
    """theta, omega_2, omega_3 along the motion."""
    return np.array([columns["theta"], columns["psi_dot"] * np.sin(columns["theta"]), columns["omega_z"]])


def mirror_gap(library: Library, centre: float) -> float:
    """theta, omega_2, omega_3 as long before as after `centre`, and theta_dot turned round."""
    shifts = np.linspace(0, centre, 101)
    run = library.simulate(np.concatenate([centre - shifts[::-1], centre + shifts[1:]]), 1e-12)
    even, odd = omegas(run), run["theta_dot"]
    return float(max(np.abs(even - even[:, ::-1]).max(), np.abs(odd + odd[::-1]).max()))


def test_the_second_half_of_each_period_mirrors_the_first(library: Library) -> None:
    half = turning_point(library)
    within(mirror_gap(library, half), 1e-11, "mirror gap")  # rad, rad/s
    beyond(mirror_gap(library, half + 1e-6), 5e-6, "mirror gap")


def test_everything_repeats_after_a_period(library: Library) -> None:
    def gap(period: float, s: float = 0.0) -> float:
        times = np.linspace(0, 0.7, 71)
        first, later = (
            library.simulate([0.0, *(t + times)[1 if t == 0 else 0 :]], 1e-12, s=s) for t in (0, 5 * period)
        )
        return float(np.abs(omegas(first) - omegas(later)[:, 1:]).max())

    period = 2 * turning_point(library)
    within(gap(period), 3e-11, "gap")  # after five periods
    beyond(gap(period, s=1e-6), 4e-4, "gap")


def chaplygin_gap(library: Library, judged: Wheel, s: float = 0.0) -> float:
    """(omega_2, omega_3) of 10 s of motion, carried back to the start along Chaplygin's linear system in theta."""
    constants = linear_integrals(judged, *omegas(library.simulate(np.linspace(0, 10, 1001), 1e-12, s=s)))
    return float(np.abs(constants - constants[0]).max())


def test_omega_2_and_omega_3_are_functions_of_theta_that_obey_chaplygins_linear_system(library: Library) -> None:
    within(chaplygin_gap(library, Wheel()), 2e-10, "chaplygin gap")  # rad/s
    beyond(chaplygin_gap(library, replace(Wheel(), r=0.05 * (1 + 1e-5))), 1e-7, "chaplygin gap")
    beyond(chaplygin_gap(library, Wheel(), s=1e-7), 4e-6, "chaplygin gap, 2")  # friction leaves the curve


TIMES = np.linspace(0, 10, 201)


def test_the_reduced_formulation_cannot_leave_its_constraints(library: Library) -> None:
    velocity, height, _ = constraint_drift(library, TIMES, None)
    within(height.max(), 16 * EPSILON, "height")  # m
    within(velocity.max(), 64 * EPSILON, "velocity")  # m/s
    multibody = constraint_drift(library, TIMES, None, formulation=3)
    beyond(max(multibody[0].max(), multibody[1].max()), 1e-10, "multibody")


DRIFT = {tolerance: tolerance + 4096 * EPSILON for tolerance in (1e-6, 1e-8, 1e-10, 1e-12)}  # m, m/s


def test_the_drift_of_the_multibody_formulation_stays_small_and_falls_with_the_tolerance(library: Library) -> None:
    def drift(tolerance: float) -> float:
        velocity, height, _ = constraint_drift(library, TIMES, tolerance, formulation=3)
        return float(max(velocity.max(), height.max()))

    found = {tolerance: drift(tolerance) for tolerance in DRIFT}
    for tolerance, bound in DRIFT.items():
        within(found[tolerance], bound, f"drift at {tolerance:g}")
    for coarse, fine in pairwise(DRIFT):
        within(found[fine] / found[coarse], 0.1, "drift over that of a tolerance a hundred times as large")
    beyond(drift(1e-4), DRIFT[1e-6], "drift at a tolerance of 1e-4")


def late_height_drift(offsets: Array) -> float:
    """Median height off the constraint in the last 10 of 60 s, as a multiple of that in the first 10 s."""
    return float(np.median(offsets[-100:]) / np.median(offsets[:100]))


def test_stabilised_constraints_do_not_drift_away_as_those_of_24_do(library: Library) -> None:
    times = np.linspace(0, 60, 601)
    within(late_height_drift(constraint_drift(library, times, 1e-8, formulation=3)[1]), 5, "late height drift")
    beyond(late_height_drift(unstabilised_drift(times, 1e-8)[1]), 5, "late height drift")


def test_the_height_that_is_watched_is_that_of_the_torus(library: Library) -> None:
    run = library.simulate(TIMES, 1e-12, formulation=3)
    # integrated, over some hundred steps
    within(np.abs(run["Z_O"] - 0.3 * np.sin(run["theta"]) - 0.05).max(), 1024 * EPSILON, "Z_O")
    beyond(np.abs(run["Z_O"] - 0.3 * np.sin(run["theta"])).max(), 1e-2, "Z_O")  # the tube forgotten in (32)


WEIGHTLESS = {"g": 0.0, "keep_contact": True}


def test_without_weight_twice_the_speed_goes_the_same_way_in_half_the_time(library: Library) -> None:
    def gap(g: float) -> float:
        rates = {"psi_dot_start": 0.5, "theta_dot_start": -0.2, "phi_dot_start": -2.0}
        slow = library.simulate(np.linspace(0, 2, 41), 1e-12, **{**WEIGHTLESS, "g": g}, **rates)
        twice = {name: 2 * value for name, value in rates.items()}
        fast = library.simulate(np.linspace(0, 1, 41), 1e-12, **{**WEIGHTLESS, "g": g}, **twice)
        return max(float(np.abs(slow[name] - fast[name]).max()) for name in ("X_O", "Y_O", "psi", "theta", "phi"))

    within(gap(0.0), 64 * EPSILON, "gap")
    beyond(gap(1e-6), 1e-8, "gap")


def test_a_lift_of_the_weight_at_its_centre_is_as_no_weight(library: Library) -> None:
    def gap(lift: float) -> float:
        lifted = library.simulate(TIMES[:41], 1e-12, Schedule(((0.0, {"F_Z": lift}),)), keep_contact=True)
        free = library.simulate(TIMES[:41], 1e-12, **WEIGHTLESS)
        return max(float(np.abs(lifted[name] - free[name]).max()) for name in ("X_O", "Y_O", "psi", "theta", "phi"))

    within(gap(20 * 9.81), 128 * EPSILON, "gap")
    beyond(gap(20 * 9.81 + 1e-5), 1e-8, "gap")


def test_a_little_friction_makes_a_proportional_change(library: Library) -> None:
    free = library.simulate(TIMES[:41], 1e-13)["X_O"]
    changes = [np.abs(library.simulate(TIMES[:41], 1e-13, s=s)["X_O"] - free).max() for s in (1e-5, 1e-6)]
    within(abs(changes[0] / changes[1] - 10), 1e-2, "changes")
    beyond(changes[1], 8e-7, "changes")
