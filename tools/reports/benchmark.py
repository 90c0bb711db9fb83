"""The problems of docs/benchmark.md, for `speed`: reference values, and error against run time.

Heyoka, where it is installed, computes the values anew, in quadruple precision by two formulations at two tolerances;
what is written is what all four agree on.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd
from benchmark.problems import INSTANTS, OUTPUTS, PROBLEMS, by_fmu, by_reference, errors

from .page import RESULTS, Report, Row, part, write_csv

LOOSE, TIGHT = "1e-22", "1e-28"
QUADRUPLE = "heyoka, quadruple precision"


def quadruple(report: Report, name: str) -> list[Row]:
    """Writes the reference values: two formulations at two tolerances, run times and differences; nothing without
    heyoka."""
    try:
        from .taylor import FORMS, Wheel, paper, quad
    except ImportError:
        return []
    runs = {}
    for case in product(FORMS, (LOOSE, TIGHT)):
        solver = Wheel(paper(quad, **PROBLEMS[name].decimals), *case, quad)
        begin = perf_counter()
        best = solver.solve(INSTANTS)
        runs[case] = best, perf_counter() - begin
    write(report, name, best)
    return [
        row(f"{QUADRUPLE}, {form}", tolerance, seconds, distance(motion, best))
        for (form, tolerance), (motion, seconds) in runs.items()
    ]


def distance(motion: Any, other: Any) -> float:
    """Largest difference of an output, relative to its largest value, or of an instant, s."""
    if [mode for _, mode in motion.transitions] != [mode for _, mode in other.transitions]:
        return np.inf
    values = float((np.abs(motion.rows - other.rows) / np.abs(other.rows).max(axis=0)).max())
    pairs = zip(motion.transitions, other.transitions, strict=True)
    return max([values, *(float(abs(a - b)) for (a, _), (b, _) in pairs)])


def write(report: Report, name: str, best: Any) -> None:
    """For other tools: thirteen significant digits; instants of transitions to 1e-13 s."""
    values = [[t, *(f"{float(value):#.13g}" for value in row)] for t, row in zip(INSTANTS, best.rows, strict=True)]
    write_csv(report.folder, f"benchmark_{name}", pd.DataFrame(values, columns=["t", *OUTPUTS]))
    if best.transitions:
        instants = [(f"{float(t):.13f}", mode) for t, mode in best.transitions]
        found = pd.DataFrame(instants, columns=["t", "sign of omega_z"])
        write_csv(report.folder, f"benchmark_{name}_transitions", found)


def row(program: str, tolerance: str, seconds: float, error: float, instants: float | None = None) -> Row:
    how = {"program": program, "tolerance": tolerance}
    return how | {"error / range": error, "instants, s": instants, "ms": 1e3 * seconds}


@part(90, {"scene": tuple(PROBLEMS)})
def programs(report: Report, name: str) -> list[Row]:
    """reference values in quadruple precision; error against run time"""
    rows, problem = quadruple(report, name), PROBLEMS[name]
    known = report.folder if rows else RESULTS
    multibody = replace(problem, start={**problem.start, "formulation": 3})
    cases = [("wheel.fmu", problem, f"1e-{n}", 3 if report.quick else 20) for n in (6, 8, 10, 12, 13)]
    for program, scene, tolerance, repeats in [*cases, ("wheel.fmu, the paper's (24)", multibody, "1e-12", 1)]:
        runs = [by_fmu(report.library, scene, float(tolerance)) for _ in range(repeats)]
        best = min(run.seconds for run in runs)
        rows.append(row(program, tolerance, best, *errors(name, runs[0], known)))
    for tolerance in ("1e-10", "1e-13"):
        begin = perf_counter()
        solution = by_reference(problem, float(tolerance))
        spent = perf_counter() - begin
        rows.append(row("tests/reference", tolerance, spent, *errors(name, solution, known)))
    return rows


@part(1)
def formulations(report: Report) -> dict[str, object]:
    """the differences between the four solutions in quadruple precision; the errors of wheel.fmu"""
    programs = report.tables["programs"]
    apart = programs[programs["program"].str.startswith(QUADRUPLE)].groupby("scene", sort=False)["error / range"].max()
    ours = programs.query("program == 'wheel.fmu' and tolerance == '1e-13'")[["error / range", "instants, s"]].max()
    table = apart.rename("largest difference").reset_index()
    return {"formulations": table, "benchmark": ours["error / range"], "instants": ours["instants, s"]}
