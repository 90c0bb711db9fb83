"""A case at a tolerance: what happened, every judge's error, and whether that is what was expected."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from support.driver import DISCARD, WARNING
from support.motion import Library, Run, run

from .case import Case
from .judges import JUDGES, RATES, floor, reference_table

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)


class Finding(NamedTuple):
    """One judge's error; floor: what the judge itself cannot see."""

    judge: str
    error: float
    allowed: float
    floor: float


@dataclass
class Verdict:
    """faults: sentences, empty where all is as expected."""

    tolerance: float
    outcome: str
    errors: list[Finding] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    claimed: bool = True  # the tolerance is within those for which the case promises anything
    steps: int = 0
    events: int = 0
    seconds: float = 0.0

    @property
    def holds(self) -> bool:
        return not self.faults or not self.claimed


def outcome_of(run: Run) -> str:
    if not run.columns:
        return "refused"
    if run.end is not None:
        return "flat" if np.sin(run["theta"][-1]) < 1e-6 else "lifts"
    return "finishes" if run.status <= WARNING else ("discarded" if run.status == DISCARD else "fails")


def judge(case: Case, tolerance: float, done: Run, table: dict | None) -> Verdict:
    outcome = outcome_of(done)
    verdict = Verdict(tolerance, outcome, seconds=done.seconds, claimed=tolerance <= case.loosest)
    if outcome != case.expect.kind:
        verdict.faults.append(f"{outcome} instead of {case.expect}: {' '.join(done.messages[-1:])}")
    if not done.columns:
        return verdict
    verdict.steps, verdict.events = done.counters["n_steps"], done.counters["n_events"]
    if not all(np.isfinite(column).all() for name, column in done.columns.items() if name != "mu_required"):
        verdict.faults.append("an output is not finite")
        return verdict
    if done.end is not None and case.expect.at is not None:
        error = abs(done.end - case.start_time - case.expect.at)
        weigh(verdict, "instant", error, case.instant, case.instant_floor)
    for name, bound in case.judges:
        extra = (table,) if name == "reference" else ()
        weigh(verdict, name, JUDGES[name](case, done, *extra), bound, floor(name, case, done))
    return verdict


def weigh(verdict: Verdict, name: str, error: float, bound: float, unseen: float) -> None:
    """Allowed: bound times the tolerance, and what the judge cannot see."""
    allowed = bound * verdict.tolerance + unseen
    verdict.errors.append(Finding(name, error, allowed, unseen))
    if not error <= allowed:
        verdict.faults.append(f"{name}: {error:.1e}, allowed {allowed:.1e}")


def judge_case(library: Library, case: Case, tolerances: tuple[float, ...] = TOLERANCES) -> list[Verdict]:
    wants_reference = any(name == "reference" for name, _ in case.judges)
    table = reference_table(case) if wants_reference else None
    return [judge(case, t, run(library, case.start, case.times, t, rates=RATES), table) for t in tolerances]
