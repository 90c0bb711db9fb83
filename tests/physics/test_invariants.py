"""What the free wheel keeps: Chaplygin's linear integrals and its constraints. s = 0, J_x = J_y."""

from dataclasses import replace

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth.closed_forms import linear_integrals
from wheelfmu.truth.measure import constraint_drift
from wheelfmu.truth.misprints import papers_start
from wheelfmu.truth.motion import Library
from wheelfmu.truth.paper_transcription import FORMS, Paper, marched, paper_table
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


@pytest.mark.parametrize("formulation", [2, 3])
def test_no_formulation_can_leave_its_constraints(library: Library, formulation: int) -> None:
    velocity, height = constraint_drift(library, TIMES, None, formulation=formulation)
    within(height.max(), 16 * EPSILON, "height off the contact, m")
    within(velocity.max(), 64 * EPSILON, "velocity of the contact, m/s")


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
def test_the_papers_twelve_states_lead_where_the_fmu_does(library: Library, form: type[Paper]) -> None:
    """(24) integrated as the paper has it: plain, and stabilized."""
    run = library.simulate([0.0, 2.0], 1e-12, formulation=3)
    names = ("X_O", "Y_O", "Z_O", "psi", "theta", "phi")
    told = np.array([run[name][-1] for name in (*names, *(f"{name}_dot" for name in names))])

    def error(step: float, **changes: float) -> float:
        return float(np.abs(marched(form, paper_table(**changes), papers_start(), step, round(2 / step)) - told).max())

    errors = [error(step) for step in (0.01, 0.005)]
    within(errors[1], 5e-5, "states apart, SI")
    within(errors[1] / errors[0], 0.1, "those of half the step over those of the whole")  # order 4: 1/16
    beyond(error(0.005, r=0.0501), 1e-4, "states of another r apart, SI")
