"""A case of the sweep at a tolerance: every judge's error, and what is not as expected.

A judge compares a run with what must hold, and returns one error, 0 for the exact motion.

energy       change of the energy, with friction its distance from that of truth/reference, over the largest energy
integrals    Chaplygin's two linear integrals (closed_forms.py), over the largest rate
reference    headline outputs against truth/reference, over the range of each
still        the wheel keeps its lean: |theta - theta_start|, rad
uniform      without weight: all rates stay as they are, over the largest
fixed        omega_z is exactly zero wherever friction holds it, rad/s
"""

import numpy as np
from robustness.sweep import Case

from wheelfmu.fmu.driver import DISCARD, HEADLINE, WARNING
from wheelfmu.truth.closed_forms import linear_integrals
from wheelfmu.truth.motion import Library, Run, run
from wheelfmu.truth.reference import Solution


def energy(case: Case, run: Run, table: Solution | None) -> float:
    if case.wheel.s == 0:
        return float(np.abs(run["E"] - run["E"][0]).max() / (np.abs(run["E"]).max() or 1.0))
    assert table
    rows = rows_before_the_end(case, run)
    return float(np.abs(run["E"][rows] - table["E"][: len(rows)]).max() / np.abs(run["E"]).max())


def integrals(case: Case, run: Run, _: Solution | None) -> float:
    omega_2 = run["psi_dot"] * np.sin(run["theta"])
    kept = np.sin(run["theta"]) > 1e-6  # an ending flat is left to its own instant
    order = np.argsort(-np.sin(run["theta"][kept]), kind="stable")  # carried to the highest point: well conditioned
    columns = (column[kept][order] for column in (run["theta"], omega_2, run["omega_z"]))
    constants = linear_integrals(case.wheel, *columns)
    size = max(np.abs(omega_2).max(), np.abs(run["omega_z"]).max(), np.abs(run["theta_dot"]).max())
    start = constants[np.flatnonzero(order == 0)[0]]
    return float(np.abs(constants - start).max() / (size or 1.0))


def reference_rows(case: Case) -> np.ndarray:
    """Rows of the case's times at which the reference is asked."""
    return np.linspace(0, case.samples, 21).astype(int)


def reference_table(case: Case) -> Solution:
    flat = None if case.start.get("keep_contact", False) else 1e-7
    return case.solved(case.times[reference_rows(case)] - case.start_time, rtol=1e-13, flat=flat)


def rows_before_the_end(case: Case, run: Run) -> np.ndarray:
    """The ending has its own judge."""
    rows = reference_rows(case)
    return rows[rows < len(run["t"]) - (run.end is not None)]


def reference(case: Case, run: Run, table: Solution | None) -> float:
    assert table
    rows, wheel = rows_before_the_end(case, run), case.wheel
    rate = np.sqrt(wheel.g / (wheel.r_0 + wheel.r))
    least = {"X_O": wheel.r_0, "theta": 1.0, "phi_dot": rate, "psi_dot": rate}
    worst = 0.0
    for name in HEADLINE:
        want = table[name][: len(rows)]
        worst = max(worst, np.abs(run[name][rows] - want).max() / max(np.abs(want).max(), least[name]))
    return float(worst)


def still(_: Case, run: Run, _table: Solution | None) -> float:
    return float(np.abs(run["theta"] - run["theta"][0]).max())


def uniform(_: Case, run: Run, _table: Solution | None) -> float:
    rates = np.column_stack([run[name] for name in ("theta_dot", "psi_dot", "phi_dot")])
    return float(np.abs(rates - rates[0]).max() / (np.abs(rates).max() or 1.0))


def fixed(_: Case, run: Run, _table: Solution | None) -> float:
    held = run["friction_mode"] == 0
    return float(np.abs(run["omega_z"][held]).max(initial=0.0))


JUDGES = {of.__name__: of for of in (energy, integrals, reference, still, uniform, fixed)}
FLOORS = {"energy": 2e-12, "integrals": 1e-10, "reference": 1e-9, "uniform": 1e-12}
WITH_FRICTION = 1e-10  # of the energy: the reference's own error


def floor(name: str, case: Case) -> float:
    """What a judge cannot see."""
    return WITH_FRICTION if name == "energy" and case.wheel.s > 0 else FLOORS.get(name, 0.0)


def outcome_of(run: Run) -> str:
    if not run.columns:
        return "refused"
    if run.end is not None:
        return "flat" if np.sin(run["theta"][-1]) < 1e-6 else "lifts"
    return "finishes" if run.status <= WARNING else ("discarded" if run.status == DISCARD else "fails")


def judge(case: Case, tolerance: float, done: Run, table: Solution | None) -> list[str]:
    """What is not as expected, a sentence each; nothing is expected of a tolerance beyond the case's loosest."""
    outcome, faults = outcome_of(done), []
    if tolerance > case.loosest:
        return []
    if outcome != case.expect.kind:
        faults.append(f"{outcome} instead of {case.expect}: {' '.join(done.messages[-1:])}")
    if not done.columns:
        return faults
    if not all(np.isfinite(column).all() for name, column in done.columns.items() if name != "mu_required"):
        return [*faults, "an output is not finite"]
    found = [(name, JUDGES[name](case, done, table), bound, floor(name, case)) for name, bound in case.judges]
    if done.end is not None and case.expect.at is not None:
        error = abs(done.end - case.start_time - case.expect.at)
        found.append(("instant", error, case.instant, case.instant_floor))
    for name, error, bound, unseen in found:
        if not error <= bound * tolerance + unseen:
            faults.append(f"{name}: {error:.1e}, allowed {bound * tolerance + unseen:.1e}")
    return faults


def judge_case(library: Library, case: Case, tolerances: tuple[float, ...]) -> list[str]:
    table = reference_table(case) if "reference" in dict(case.judges) else None
    return [fault for t in tolerances for fault in judge(case, t, run(library, case.start, case.times, t), table)]
