"""Scenes beside the paper's, against the independent reference of truth/reference.

Fast rolling, near flat, thin disc, J_x != J_y, heavy and light friction, past upright, spin either way,
and the six inputs: the cases of cases.py.
"""

import pytest
from support.bounds import beyond, within

from wheelfmu.truth.cases import CASES, error, transitions_gap
from wheelfmu.truth.motion import Library

all_cases = pytest.mark.parametrize("name", CASES)


@all_cases
def test_every_output_agrees_with_the_independent_reference(library: Library, name: str) -> None:
    within(error(library, CASES[name]), 9e-7, "error, relative")
    beyond(error(library, CASES[name], J_z=CASES[name].wheel.J_z * (1 - 1e-4)), 1e-5, "error with another J_z")


@all_cases
def test_the_agreement_deepens_with_the_tolerance(library: Library, name: str) -> None:
    within(error(library, CASES[name], 1e-12), 1e-9, "error, relative")
    beyond(error(library, CASES[name], 1e-4, method=4), 7e-7, "error at a loose tolerance, relative")  # stepped through


@pytest.mark.parametrize("name", [n for n, case in CASES.items() if case.wheel.s > 0])
def test_the_same_transitions_of_friction_at_the_same_instants(library: Library, name: str) -> None:
    case, s = CASES[name], CASES[name].wheel.s
    within(transitions_gap(library, case, s), 7e-8, "instants of the transitions, s")
    if case.solved().events[1:]:
        beyond(transitions_gap(library, case, s * (1 + 1e-4)), 3e-6, "instants with another s, s")
