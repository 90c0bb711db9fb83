"""Scenes beside the paper's, against the independent reference of tests/reference.

Fast rolling, near flat, thin disc, J_x != J_y (multibody), heavy and light friction, past upright, spin either way,
and the six inputs: the cases of cases.py.
"""

from __future__ import annotations

import pytest
from support.motion import Library

from .cases import BOUNDS, CASES, error, expected, transitions_gap

all_cases = pytest.mark.parametrize("name", CASES)


@all_cases
def test_every_output_agrees_with_the_independent_reference(library: Library, name: str) -> None:
    bound = BOUNDS[name]
    assert error(library, name) < bound  # measured at most 3.2e-7; near flat 7.8e-7
    assert error(library, name, J_z=CASES[name].wheel.J_z * (1 - 1e-4)) > bound  # measured at least 1.3e-4


@all_cases
def test_the_agreement_deepens_with_the_tolerance(library: Library, name: str) -> None:
    assert error(library, name, 1e-12) < 5e-9  # measured at most 2.1e-10
    assert error(library, name, 1e-4, method=4) > 5e-9  # stepped through; measured at least MEASURE


@pytest.mark.parametrize("name", [n for n, case in CASES.items() if case.wheel.s > 0])
def test_the_same_transitions_of_friction_at_the_same_instants(library: Library, name: str) -> None:
    s = CASES[name].wheel.s
    assert transitions_gap(library, name, s) < 1e-6  # measured at most 7.2e-8
    if expected(name).events[1:]:
        assert transitions_gap(library, name, s * (1 + 1e-4)) > 1e-6  # measured at least 4.7e-5
