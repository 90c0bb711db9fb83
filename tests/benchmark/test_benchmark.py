"""The reference values of docs/benchmark.md, met by the FMU, its system (24) and the independent reference."""

from dataclasses import replace

import numpy as np
import pytest
from support.bounds import beyond, within
from support.motion import Library

from .problems import DATA, INSTANTS, OUTPUTS, PROBLEMS, by_fmu, by_reference, errors, table, transitions

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
    within(errors(name, by_fmu(library, multibody, 1e-13))[0], 2e-11, f"{name}, multibody: error / range")


@each
def test_a_parameter_that_is_off_by_a_billionth_shows(library: Library, name: str) -> None:
    off = replace(PROBLEMS[name], start={**PROBLEMS[name].start, "r": 0.05 * (1 + 1e-9)})
    beyond(errors(name, by_fmu(library, off, 1e-14))[0], 6e-10, f"{name}: error / range")


def test_the_tables_have_thirteen_digits_and_all_transitions() -> None:
    for row in (DATA / "benchmark.csv").read_text(encoding="utf-8").splitlines()[1 :: len(INSTANTS)]:
        for cell in row.split(",")[2:]:
            assert len(cell.lstrip("-0.").replace(".", "")) == 13
    for name in PROBLEMS:
        assert table(name).shape == (len(INSTANTS), len(OUTPUTS))
    instants = [t for t, _ in transitions("friction")]
    assert len(instants) == 37
    assert (np.diff(instants) > 0).all()
