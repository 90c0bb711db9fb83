"""The reference values of docs/benchmark.md, met by the FMU, its system (24) and the independent reference."""

from dataclasses import replace

import pytest
from support.bounds import beyond, within

from wheelfmu.truth.motion import Library
from wheelfmu.truth.problems import PROBLEMS, by_fmu, by_reference, errors

each = pytest.mark.parametrize("name", PROBLEMS)


def check(name: str, found: tuple[float, float | None], program: str) -> None:
    error, instants = found
    within(error, 2e-11, f"{name}, {program}: error / range")
    if instants is not None:
        within(instants, 2e-9 if program == "FMU" else 2e-11, f"{name}, {program}: instants, s")


@each
def test_the_fmu_its_papers_system_and_the_reference_have_the_reference_values(library: Library, name: str) -> None:
    check(name, errors(name, by_fmu(library, PROBLEMS[name], 1e-14)), "FMU")
    check(name, errors(name, by_reference(PROBLEMS[name], 1e-13)), "reference")
    multibody = replace(PROBLEMS[name], start={**PROBLEMS[name].start, "formulation": 3})
    check(name, (errors(name, by_fmu(library, multibody, 1e-13))[0], None), "multibody")


@each
def test_a_parameter_that_is_off_by_a_billionth_shows(library: Library, name: str) -> None:
    off = replace(PROBLEMS[name], start={**PROBLEMS[name].start, "r": 0.05 * (1 + 1e-9)})
    beyond(errors(name, by_fmu(library, off, 1e-14))[0], 6e-10, f"{name}, another r: error / range")
