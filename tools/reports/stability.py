"""Stiff and extreme wheels: every case of tests/robustness/sweep.py at five tolerances, the regularized law, long runs.

Cases, judges and bounds are those of tests/robustness. An error is judged by the energy, Chaplygin's linear integrals,
the independent reference or a closed form.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from math import nan
from multiprocessing import get_context
from typing import Any

import pandas as pd
from pebble import ProcessExpired, ProcessFuture, ProcessPool
from robustness.case import Case
from robustness.sweep import sweep
from robustness.verdicts import TOLERANCES, Verdict, judge_case
from support.motion import Library

from . import edges, plots
from .law import crossings, draw_law, draw_methods, law
from .long_runs import constraints, hours
from .page import Report, Row, number, part
from .plots import Sheet, style

DEADLINE = 120.0  # s
FAULT = ["case", "tolerance", "what"]
JUDGES = {
    "energy": "energy",
    "integrals": "linear integrals",
    "reference": "outputs against the reference",
    "instant": "instant of the ending, s",
}


class Broken(str):
    """What went wrong with the process: "hangs", or "crashes" with the signal."""


def isolated(calls: Sequence[tuple], folder: str) -> list[Any]:
    """Functions called with the library and arguments, each in a process of its own with a deadline: a hang or a crash
    is a result, not the end."""
    with ProcessPool(2, max_tasks=1, context=get_context("fork")) as pool:
        return [answer(f) for f in [pool.schedule(alone, (folder, *call), timeout=DEADLINE) for call in calls]]


def alone(folder: str, work: Callable, *arguments: object) -> Any:
    return work(Library(folder), *arguments)


def answer(future: ProcessFuture) -> Any:
    try:
        return future.result()
    except TimeoutError:
        return Broken(f"hangs: no answer within {DEADLINE:g} s")
    except ProcessExpired as end:
        return Broken(f"crashes: the process ended with exit code {end.exitcode}")


@part(75)
def cases(report: Report) -> None:
    """the sweep: each case at five tolerances, in a process of its own"""
    chosen = sweep()[:: 6 if report.quick else 1]
    found = list(zip(chosen, isolated([(judge_case, case) for case in chosen], report.library.folder), strict=True))
    report.table("cases", [row for case, verdicts in found for row in case_rows(case, verdicts)])
    faults = pd.DataFrame([row for case, verdicts in found for row in faults_of(case, verdicts)], columns=FAULT)
    report.table("faults", faults)
    judged = [(case, verdict) for case, verdicts in found if not isinstance(verdicts, Broken) for verdict in verdicts]
    report.table("amplification", [amplification(judged, judge) for judge in JUDGES])
    report.table("loose", [{"case": str(c), "needs": c.loosest, "why": c.remark} for c, _ in found if c.loosest < 1e-4])
    report.figures(cases=len(found), runs=len(found) * len(TOLERANCES), faults=len(faults))
    style.save_png(draw_cases(judged), report.folder / "stability_cases.png", plots.DPI)


def case_rows(case: Case, verdicts: list[Verdict] | Broken) -> Iterator[Row]:
    for i, tolerance in enumerate(TOLERANCES):
        verdict = None if isinstance(verdicts, Broken) else verdicts[i]
        errors = {f.judge: f.error for f in verdict.errors} if verdict else {}
        yield {
            "case": str(case),
            "expected": str(case.expect),
            "tolerance": tolerance,
            "outcome": verdict.outcome if verdict else str(verdicts),
            "as expected": verdict.holds if verdict else False,
            "judges": " ".join(errors),
            "errors": " ".join(number(e) for e in errors.values()),
            "steps": verdict.steps if verdict else None,
        }


def faults_of(case: Case, verdicts: list[Verdict] | Broken) -> list[tuple]:
    if isinstance(verdicts, Broken):
        return [(str(case), "", str(verdicts))]
    return [(str(case), v.tolerance, "; ".join(v.faults)) for v in verdicts if not v.holds]


def amplification(judged: list[tuple[Case, Verdict]], judge: str) -> Row:
    """How many cases keep the error within the tolerance, and which exceed it most."""
    ratios = [
        (str(case), max(f.error - f.floor, 0.0) / verdict.tolerance)
        for case, verdict in judged
        for f in verdict.errors
        if f.judge == judge and verdict.claimed
    ]
    worst = pd.DataFrame(ratios, columns=["case", "ratio"]).groupby("case", sort=False)["ratio"].max()
    top = worst.sort_values(ascending=False, kind="stable")[:3]
    return {
        "judge": JUDGES[judge],
        "cases": len(worst),
        "within the tolerance": (worst <= 1).sum(),
        "within 10 ×": (worst <= 10).sum(),
        "largest, in tolerances": "; ".join(f"{name} ({ratio:.0f})" for name, ratio in top.items()),
    }


def seen_error(verdict: Verdict, judge: str) -> float:
    """nan where the judge itself sees no further, or nothing is claimed."""
    found = next((f for f in verdict.errors if f.judge == judge and verdict.claimed), None)
    return found.error if found and found.error > 2 * found.floor else nan


def draw_cases(judged: list[tuple[Case, Verdict]]) -> Sheet:
    figure, axes = plots.sheet(2)
    titles = {"energy": "energy balance", "reference": "outputs against the independent reference"}
    for ax, (judge, title) in zip(axes, titles.items(), strict=True):
        for case, verdicts in groupby(judged, key=lambda pair: str(pair[0])):
            hard = case.startswith(("brushing", "friction: s = 1", "past upright: theta = 170"))
            look = {"color": style.VERMILLION, "label": "grazing the ground, or s of 1 m and more"}
            look = look if hard else {"color": style.BLUE, "label": "a case"}
            errors = [seen_error(verdict, judge) for _, verdict in verdicts]
            ax.plot(TOLERANCES, errors, ".-", alpha=0.6, lw=0.8, ms=3, **look)
        ax.plot(TOLERANCES, TOLERANCES, "--", color=style.INK, lw=0.9, label="error = tolerance")
        plots.label(ax, "tolerance", "relative error", title, "xy")
    plots.legend_below(figure, axes[0], 3)
    return figure


@part(20)
def contract(report: Report) -> None:
    """the contract at its edges"""
    rows = []
    for group, check in edges.GROUPS.items():
        (found,) = isolated([(check,)], report.library.folder)
        rows += [(group, *row) for row in ([("", "", found, False)] if isinstance(found, Broken) else found)]
    table = pd.DataFrame(rows, columns=["group", "what", "expected", "found", "holds"])
    report.table("contract", table)
    report.figures(checks=len(table), contract=(~table["holds"].astype(bool)).sum())


FURTHER = (law, crossings, hours, constraints)
PICTURES = {"law": draw_law, "methods": draw_methods}
