"""What the free wheel keeps: Chaplygin's linear integrals and its constraints. s = 0, J_x = J_y."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth.closed_forms import linear_integrals
from wheelfmu.truth.measure import constraint_drift
from wheelfmu.truth.motion import Library
from wheelfmu.truth.reference import Wheel


def chaplygin_gap(library: Library, judged: Wheel, s: float = 0.0) -> float:
    """(omega_2, omega_3) of 10 s of motion, carried back to the start along Chaplygin's linear system in theta."""
    run = library.simulate(np.linspace(0, 10, 1001), 1e-12, s=s)
    constants = linear_integrals(judged, run["theta"], run["psi_dot"] * np.sin(run["theta"]), run["omega_z"])
    return float(np.abs(constants - constants[0]).max())


def test_omega_2_and_omega_3_are_functions_of_theta_that_obey_chaplygins_linear_system(library: Library) -> None:
    within(chaplygin_gap(library, Wheel()), 1e-11, "omega_2, omega_3 carried back, rad/s")
    beyond(chaplygin_gap(library, replace(Wheel(), r=0.05 * (1 + 1e-5))), 1e-7, "those with another r, rad/s")
    beyond(chaplygin_gap(library, Wheel(), s=1e-7), 4e-6, "those with friction, rad/s")  # friction leaves the curve


TIMES = np.linspace(0, 10, 201)


def test_the_reduced_formulation_cannot_leave_its_constraints(library: Library) -> None:
    velocity, height = constraint_drift(library, TIMES, None)
    within(height.max(), 16 * EPSILON, "height off the contact, m")
    within(velocity.max(), 64 * EPSILON, "velocity of the contact, m/s")
    multibody = constraint_drift(library, TIMES, None, formulation=3)
    beyond(max(multibody[0].max(), multibody[1].max()), 1e-10, "drift of the multibody form, m, m/s")


DRIFT = {tolerance: tolerance + 4096 * EPSILON for tolerance in (1e-6, 1e-8, 1e-10, 1e-12)}  # m, m/s


def test_the_drift_of_the_multibody_formulation_stays_small_and_falls_with_the_tolerance(library: Library) -> None:
    def drift(tolerance: float) -> float:
        velocity, height = constraint_drift(library, TIMES, tolerance, formulation=3)
        return float(max(velocity.max(), height.max()))

    found = {tolerance: drift(tolerance) for tolerance in DRIFT}
    for tolerance, bound in DRIFT.items():
        within(found[tolerance], bound, f"drift at {tolerance:g}, m, m/s")
    for coarse, fine in pairwise(DRIFT):
        within(found[fine] / found[coarse], 0.1, "drift over that of a tolerance a hundred times as large")
    beyond(drift(1e-4), DRIFT[1e-6], "drift at a tolerance of 1e-4, m, m/s")
