"""The sweep: stiff and extreme wheels go as stated, and every judge can say no.

The bounds stand with the cases (sweep.py), in multiples of the tolerance. Measured, largest of
all five tolerances: energy 1 x (grazing the ground 35 x), linear integrals 3 x (grazing 12 x), reference 30 x.
"""

from dataclasses import replace

import numpy as np
import pytest
from robustness import judges
from robustness.judges import judge, judge_case
from robustness.sweep import Case, Expectation, sweep
from support.bounds import beyond, within

from wheelfmu.truth.motion import Library, run

CASES = {str(case): case for case in sweep()}


@pytest.mark.parametrize("case", CASES.values(), ids=str)
def test_an_extreme_wheel_goes_as_stated_at_every_tolerance(library: Library, case: Case) -> None:
    assert judge_case(library, case, (1e-4, 1e-8, 1e-12)) == []


GRAZING = [case for name, case in CASES.items() if name.startswith("lift-off: just")]  # leaves, and stays


@pytest.mark.parametrize("s", [0.0, 0.03])
@pytest.mark.parametrize("case", GRAZING, ids=str)
def test_a_dip_of_the_normal_force_inside_one_step_ends_the_run_only_below_zero(library, kind, case, s) -> None:
    """Least N = -1e-6 m g, or 1e-6 m g, by any method and formulation."""
    forced = replace(case, start={**case.start, **kind, "s": s}, judges=())
    assert judge_case(library, forced, (1e-8,)) == []


def faults_of(library: Library, name: str, changed: dict | None = None, **columns: np.ndarray) -> str:
    """Of a run at a tolerance of 1e-8, judged as another case, or with some columns changed (factors)."""
    case = CASES[name]
    done = run(library, case.start, case.times, 1e-8)
    done = replace(done, columns=done.columns | {column: done[column] * by for column, by in columns.items()})
    return " ".join(judge(replace(case, **changed or {}), 1e-8, done, None))


SPIN, PAPERS, FALL = "spin: 1 rad/s", "friction: the paper's, s = 0.03 m", "fall from rest: 75 deg"
LEAK = 1 - 1e-6 * np.linspace(0, 1, 401)
ALL_BUT_ONE = np.where(np.arange(401) == 7, np.nan, 1)
BROKEN = [
    ("energy", SPIN, {}, {"E": LEAK}),
    ("integrals", SPIN, {}, {"omega_z": 1 + 1e-5}),
    ("integrals", SPIN, {"start": {**CASES[SPIN].start, "r": 0.051}}, {}),
    ("not finite", SPIN, {}, {"theta": ALL_BUT_ONE}),
    ("flat instead of finishes", FALL, {"expect": Expectation()}, {}),
    ("instant", FALL, {"expect": Expectation("flat", CASES[FALL].expect.at + 1e-6)}, {}),
]


@pytest.mark.parametrize(("fault", "name", "changed", "columns"), BROKEN)
def test_every_judge_finds_what_is_broken_and_nothing_else(library, fault, name, changed, columns) -> None:
    assert faults_of(library, name) == ""
    assert fault in faults_of(library, name, changed, **columns)


def test_friction_that_takes_too_little_and_spin_while_held_are_found(library: Library) -> None:
    case = CASES[PAPERS]
    done, lighter = run(library, case.start, case.times, 1e-8), replace(case, start={"s": 0.03 * (1 - 1e-5)})
    within(judges.energy(case, done, judges.reference_table(case)), 2e-9, "energy off the reference's, relative")
    beyond(judges.energy(case, done, judges.reference_table(lighter)), 1e-6, "off that under a lighter friction")
    assert judges.fixed(case, done, None) == 0
    slips = replace(done, columns=done.columns | {"omega_z": done["omega_z"] + 1e-15})
    assert judges.fixed(case, slips, None) > 0
