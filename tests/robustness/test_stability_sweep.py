"""A quick part of the report's sweep: stiff and extreme wheels go as stated, and every judge can say no.

The bounds stand with the cases (sweep.py), in multiples of the tolerance. Measured, largest of
all five tolerances: energy 1 x (grazing the ground 35 x), linear integrals 3 x (grazing 12 x), reference 30 x.
"""

from dataclasses import replace

import numpy as np
import pytest
from support.bounds import beyond, within
from support.motion import Library, Run, run

from robustness import judges
from robustness.case import Case, Expectation
from robustness.sweep import sweep
from robustness.verdicts import judge, judge_case

SLOW = ("friction", "omega_z = 0")  # with the reference and dense outputs: a second each
CASES = {str(case): case for case in sweep()}
QUICK = [case for name, case in CASES.items() if "friction" not in name and not name.startswith(SLOW)]
SLIPPING = ("friction: the paper's, s = 0.03 m", "inertia: J_x = 2 J_y, friction")
ROLLING = [replace(CASES[name], samples=4000) for name in SLIPPING]


@pytest.mark.parametrize("case", [*QUICK, *ROLLING], ids=str)
def test_an_extreme_wheel_goes_as_stated_at_every_tolerance(library: Library, case: Case) -> None:
    verdicts = judge_case(library, case, (1e-6, 1e-10) if case in ROLLING else (1e-4, 1e-8, 1e-12))
    assert [v.faults for v in verdicts if not v.holds] == []


def ran(library: Library, name: str) -> tuple[Case, Run]:
    return CASES[name], run(library, CASES[name].start, CASES[name].times, 1e-8)


def tampered(done: Run, **changes: np.ndarray) -> Run:
    return Run({**done.columns, **changes}, done.messages, done.status, done.end, done.seconds, done.counters)


def faults_of(case: Case, done: Run) -> str:
    return " ".join(judge(case, 1e-8, done, None).faults)


def test_energy_that_leaks_is_found(library: Library) -> None:
    case, done = ran(library, "spin: 1 rad/s")
    within(judges.energy(case, done), 4e-10, "energy")
    leak = done["E"] * (1 - 1e-6 * np.linspace(0, 1, len(done["t"])))
    assert "energy" in faults_of(case, tampered(done, E=leak))  # 1e-6


def test_a_wrong_turn_breaks_the_linear_integrals(library: Library) -> None:
    case, done = ran(library, "spin: 1 rad/s")
    within(judges.integrals(case, done), 6e-10, "integrals")
    assert "integrals" in faults_of(case, tampered(done, omega_z=done["omega_z"] + 1e-5))
    other_wheel = replace(case, start={**case.start, "r": 0.051})
    beyond(judges.integrals(other_wheel, done), 1e-4, "integrals")


def test_friction_that_takes_too_little_is_found(library: Library) -> None:
    case = replace(CASES["friction: the paper's, s = 0.03 m"], samples=4000, judges=(("energy", 10.0),))
    done = run(library, case.start, case.times, 1e-8, rates=judges.RATES)
    within(judges.energy(case, done), 3e-8, "energy")
    lighter = replace(case, start={"s": 0.03 * (1 - 1e-5)})
    beyond(judges.energy(lighter, done), 1e-6, "energy")


def test_spin_while_held_is_found(library: Library) -> None:
    case = CASES["friction: the paper's, s = 0.03 m"]
    done = run(library, case.start, case.times[::10], 1e-8)
    assert judges.fixed(case, done) == 0
    assert judges.fixed(case, tampered(done, omega_z=done["omega_z"] + 1e-15)) > 0


def test_a_number_that_is_not_finite_is_found(library: Library) -> None:
    case, done = ran(library, "spin: 1 rad/s")
    theta = done["theta"].copy()
    theta[7] = np.nan
    assert "not finite" in faults_of(case, tampered(done, theta=theta))


def test_another_outcome_than_the_stated_one_is_found(library: Library) -> None:
    case, done = ran(library, "fall from rest: 75 deg")
    assert faults_of(case, done) == ""
    assert "flat instead of finishes" in faults_of(replace(case, expect=Expectation()), done)
    late = Expectation("flat", case.expect.at + 1e-6)
    assert "instant" in faults_of(replace(case, expect=late), done)
