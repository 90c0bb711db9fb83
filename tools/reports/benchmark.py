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

from .page import Report, Row, part

LOOSE, TIGHT = "1e-22", "1e-28"


@part(60)
def quadruple(report: Report) -> None:
    """reference values in quadruple precision, two formulations"""
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
                motion = solver.solve(INSTANTS)
                runs[form, tolerance] = motion, perf_counter() - begin
        best, *others = [motion for motion, _ in runs.values()][::-1]
        apart[name] = max(distance(motion, best) for motion in others)
        write(report, name, best)
        for (form, tolerance), (motion, seconds) in runs.items():
            program = f"heyoka, quadruple precision, {form}"
            rows.append(entry(name, program, tolerance, (distance(motion, best), None), seconds))
    report.kept["rows"] = rows
    report.table("agreement", [{"scene": name, "largest difference": value} for name, value in apart.items()])
    report.figures(agreement=max(apart.values()))


def distance(motion: Any, other: Any) -> float:
    """Largest difference of an output, relative to its largest value, or of an instant, s."""
    if [mode for _, mode in motion.transitions] != [mode for _, mode in other.transitions]:
        return np.inf
    size = np.abs(other.rows).max(axis=0)
    values = float((np.abs(motion.rows - other.rows) / size).max())
    pairs = zip(motion.transitions, other.transitions, strict=True)
    return max([values, *(float(abs(a - b)) for (a, _), (b, _) in pairs)])


def write(report: Report, name: str, best: Any) -> None:
    """Thirteen significant digits; instants of transitions to 1e-13 s."""
    shown = [[f"{float(value):#.13g}" for value in row] for row in best.rows]
    names = ("t", *OUTPUTS)
    report.table(name, [dict(zip(names, (t, *row), strict=True)) for t, row in zip(INSTANTS, shown, strict=True)])
    if best.transitions:
        rows = [{"t": f"{float(t):.13f}", "sign of omega_z": mode} for t, mode in best.transitions]
        report.table(f"{name}_transitions", rows)


def entry(scene: str, program: str, tolerance: str, found: tuple[float, float | None], seconds: float) -> Row:
    error, instants = found
    return {
        **{"scene": scene, "program": program, "tolerance": tolerance, "error / range": error},
        **{"instants, s": instants, "ms": 1e3 * seconds},
    }


@part(30)
def programs(report: Report) -> None:
    """error against run time of wheel.fmu and of tests/reference"""
    rows = report.kept["rows"]
    for name, problem in PROBLEMS.items():
        for tolerance in ("1e-6", "1e-8", "1e-10", "1e-12", "1e-13"):
            runs = [by_fmu(report.library, problem, float(tolerance)) for _ in range(3 if report.quick else 20)]
            best = min(run.seconds for run in runs)
            rows.append(entry(name, "wheel.fmu", tolerance, errors(name, runs[0], report.folder), best))
        multibody = replace(problem, start={**problem.start, "formulation": 3})
        run = by_fmu(report.library, multibody, 1e-12)
        rows.append(entry(name, "wheel.fmu, the paper's (24)", "1e-12", errors(name, run, report.folder), run.seconds))
        for tolerance in ("1e-10", "1e-13"):
            begin = perf_counter()
            solution = by_reference(problem, float(tolerance))
            spent = perf_counter() - begin
            rows.append(entry(name, "tests/reference", tolerance, errors(name, solution, report.folder), spent))
    report.table("programs", sorted(rows, key=lambda row: list(PROBLEMS).index(str(row["scene"]))))
    worst = pd.DataFrame(rows).query("program == 'wheel.fmu' and tolerance == '1e-13'").max()
    report.figures(ours=worst["error / range"], instants=worst["instants, s"])
