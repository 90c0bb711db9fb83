"""The wheel as a benchmark: reference values, and error against run time of the programs that were run.

The values are computed in quadruple precision by two formulations at two tolerances; what is written is what all four
agree on. The problems in words are in docs/benchmark.md.
"""

from __future__ import annotations

from dataclasses import replace
from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd
from benchmark.problems import INSTANTS, OUTPUTS, PROBLEMS, by_fmu, by_reference, errors

from .page import Report, Row, part, write_csv

LOOSE, TIGHT = "1e-22", "1e-28"


def quadruple(report: Report) -> tuple[list[Row], dict[str, float]]:
    """Writes the reference values: two formulations; how long they took, and how far they are apart, by scene."""
    try:
        from .taylor import FORMS, Wheel, paper, quad
    except ImportError:
        raise SystemExit("The reference values need heyoka: ./scripts/report --peers benchmark installs it.") from None
    apart, rows = {}, []
    for name, problem in PROBLEMS.items():
        runs = {}
        for form in FORMS:
            for tolerance in (LOOSE, TIGHT):
                solver = Wheel(paper(quad, **problem.decimals), form, tolerance, quad)
                begin = perf_counter()
                best = solver.solve(INSTANTS)
                runs[form, tolerance] = best, perf_counter() - begin
        write(report, name, best)
        off = {key: distance(motion, best) for key, (motion, _) in runs.items()}
        apart[name] = max(off.values())
        for (form, tolerance), (_, seconds) in runs.items():
            program = f"heyoka, quadruple precision, {form}"
            rows.append(row(name, program, tolerance, seconds, off[form, tolerance]))
    return rows, apart


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


def row(scene: str, program: str, tolerance: str, seconds: float, error: float, instants: float | None = None) -> Row:
    case = {"scene": scene, "program": program, "tolerance": tolerance}
    return case | {"error / range": error, "instants, s": instants, "ms": 1e3 * seconds}


@part(90)
def programs(report: Report) -> dict[str, object]:
    """reference values in quadruple precision; error against run time"""
    rows, apart = quadruple(report)
    for name, problem in PROBLEMS.items():
        multibody = replace(problem, start={**problem.start, "formulation": 3})
        cases = [("wheel.fmu", problem, f"1e-{n}", 3 if report.quick else 20) for n in (6, 8, 10, 12, 13)]
        cases += [("wheel.fmu, the paper's (24)", multibody, "1e-12", 1)]
        for program, scene, tolerance, repeats in cases:
            runs = [by_fmu(report.library, scene, float(tolerance)) for _ in range(repeats)]
            best = min(run.seconds for run in runs)
            rows.append(row(name, program, tolerance, best, *errors(name, runs[0], report.folder)))
        for tolerance in ("1e-10", "1e-13"):
            begin = perf_counter()
            solution = by_reference(problem, float(tolerance))
            spent = perf_counter() - begin
            rows.append(row(name, "tests/reference", tolerance, spent, *errors(name, solution, report.folder)))
    worst = pd.DataFrame(rows).query("program == 'wheel.fmu' and tolerance == '1e-13'").max()
    rows.sort(key=lambda row: list(PROBLEMS).index(str(row["scene"])))
    formulations = [{"scene": name, "largest difference": value} for name, value in apart.items()]
    figures = {"ours": worst["error / range"], "instants": worst["instants, s"]}
    return {"programs": rows, "formulations": formulations} | figures
