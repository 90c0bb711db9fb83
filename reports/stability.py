"""Stiff and extreme wheels: every case of tests/robustness/sweep.py at five tolerances, the regularized law, long runs.

Cases, judges and bounds are those of tests/robustness. An error is judged by the energy, Chaplygin's linear integrals,
the independent reference or a closed form.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import nan

import numpy as np
from robustness import checks, drift, long_runs
from robustness.case import Case
from robustness.sweep import sweep
from robustness.verdicts import TOLERANCES, Verdict, judge_case

from . import plots
from .isolated import Broken, call, call_each
from .law import crossings, law
from .page import Report, Row, number
from .plots import style

DEADLINE = 120.0  # s
JUDGES = {
    "energy": "energy",
    "integrals": "linear integrals",
    "reference": "outputs against the reference",
    "instant": "instant of the ending, s",
}


def cases(report: Report) -> None:
    """the sweep: each case at five tolerances, in a process of its own"""
    chosen = sweep()[:: 6 if report.quick else 1]
    found = list(call_each(lambda case: judge_case(report.library, case), chosen, DEADLINE))
    report.table("cases", [row for case, verdicts in found for row in case_rows(case, verdicts)])
    faults = list(faults_of(found))
    report.table("faults", faults)
    report.words["cases"], report.words["runs"] = str(len(found)), str(len(found) * len(TOLERANCES))
    judged = [(case, verdicts) for case, verdicts in found if not isinstance(verdicts, Broken)]
    report.table("amplification", [amplification(judged, judge) for judge in JUDGES])
    report.table("loose", [{"case": str(c), "needs": c.loosest, "why": c.remark} for c, _ in found if c.loosest < 1e-4])
    what = "cases and tolerances that do not do as stated, hang or crash"
    report.figure("faults", what, len(faults), "", 0, relation="exactly")
    draw_cases(report, judged)


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


def faults_of(found: list[tuple[Case, list[Verdict] | Broken]]) -> Iterator[Row]:
    for case, verdicts in found:
        if isinstance(verdicts, Broken):
            yield {"case": str(case), "tolerance": "", "what": str(verdicts)}
            continue
        for v in verdicts:
            if not v.holds:
                yield {"case": str(case), "tolerance": v.tolerance, "what": "; ".join(v.faults)}


def amplification(found: list[tuple[Case, list[Verdict]]], judge: str) -> Row:
    """How many cases keep the error within the tolerance, and which exceed it most."""
    worst = {}
    for case, verdicts in found:
        seen = [(f, v.tolerance) for v in verdicts for f in v.errors if f.judge == judge and v.claimed]
        if seen:
            worst[str(case)] = max(max(f.error - f.floor, 0.0) / tolerance for f, tolerance in seen)
    top = sorted(worst.items(), key=lambda item: -item[1])[:3]
    return {
        "judge": JUDGES[judge],
        "cases": len(worst),
        "within the tolerance": sum(r <= 1 for r in worst.values()),
        "within 10 ×": sum(r <= 10 for r in worst.values()),
        "largest, in tolerances": "; ".join(f"{name} ({ratio:.0f})" for name, ratio in top),
    }


def seen_error(verdict: Verdict, judge: str) -> float:
    """nan where the judge itself sees no further, or nothing is claimed."""
    found = next((f for f in verdict.errors if f.judge == judge and verdict.claimed), None)
    return found.error if found and found.error > 2 * found.floor else nan


def draw_cases(report: Report, found: list[tuple[Case, list[Verdict]]]) -> None:
    figure, axes = plots.sheet(2)
    titles = {"energy": "energy balance", "reference": "outputs against the independent reference"}
    for ax, (judge, title) in zip(axes, titles.items(), strict=True):
        for case, verdicts in found:
            hard = str(case).startswith(("brushing", "friction: s = 1", "past upright: theta = 170"))
            look = {"color": style.VERMILLION if hard else style.BLUE, "alpha": 0.6, "lw": 0.8, "ms": 3}
            ax.plot(TOLERANCES, [seen_error(v, judge) for v in verdicts], ".-", **look)
        ax.plot(TOLERANCES, TOLERANCES, "--", color=style.INK, lw=0.9)
        plots.label(ax, "tolerance", "relative error", title, "xy")
    for colour, line, words in (
        (style.BLUE, ".-", "a case"),
        (style.VERMILLION, ".-", "grazing the ground, or s of 1 m and more"),
        (style.INK, "--", "error = tolerance"),
    ):
        axes[0].plot([], [], line, color=colour, label=words)
    plots.legend_below(figure, axes[0], 3)
    report.picture("cases", figure)


def contract(report: Report) -> None:
    """the contract at its edges"""
    rows = []
    for group, check in checks.GROUPS.items():
        answer = call(lambda _, check=check: check(report.library), None, DEADLINE)
        found = [("", "", str(answer), False)] if isinstance(answer, Broken) else answer
        names = ("what", "expected", "found", "holds")
        rows += [{"group": group, **dict(zip(names, row, strict=True))} for row in found]
    report.table("contract", rows)
    broken = sum(not row["holds"] for row in rows)
    report.words["checks"] = str(len(rows))
    report.figure("contract", "checks of the contract that fail", broken, "", 0, relation="exactly")


def hours(report: Report) -> None:
    """an hour and a day"""
    runs = long_runs.study(report.library, not report.quick)
    rows = []
    for r in runs:
        early, late = float(np.median(r.cost[1:11])), float(np.median(r.cost[-10:]))
        change = float((r.energy[-1] - r.energy[0]) / r.energy[0])
        rows.append(
            {
                "run": r.name,
                "µs/s, first sixth": early,
                "µs/s, last sixth": late,
                "energy change / E": change,
                "largest rise, J": max(r.rise, 0.0),
                "transitions": int(r.events[-1]),
                "amount of ω_z while held, rad/s": r.held,
                "memory growth, KiB": r.memory / 1024,
                "status": r.status,
            }
        )
    report.table("hours", rows)
    growth = max(row["µs/s, last sixth"] / row["µs/s, first sixth"] for row in rows)
    report.figure("growth", "cost per simulated second, last sixth over first, at worst", growth, "×", 1.5)
    rise = max(r.rise / (r.tolerance * r.energy[0]) for r in runs)
    report.figure("rise", "largest rise of the energy between readings / (tolerance E)", rise, "", 10)
    held = max(r.held for r in runs)
    report.figure("held", "amount of ω_z while held, rad/s", held, "", 0, relation="exactly")
    report.figure("memory", "growth of memory", max(r.memory for r in runs) / 2**20, "MiB", 4)
    resolved = long_runs.resolved(report.library, 600.0 if report.quick else 3600.0)
    names = ("tolerance", "transitions", "E, J")
    report.table("resolved", [dict(zip(names, row, strict=True)) for row in resolved])
    draw_hours(report, runs)


def draw_hours(report: Report, runs: list[long_runs.LongRun]) -> None:
    figure, axes = plots.sheet(3, 1, 62)
    for colour, r, line in zip(plots.COLOURS, runs, ("-", "-", "--", ":", ":"), strict=False):
        times, look = r.times[1:] / 3600, {"color": colour, "ls": line, "label": r.name}
        axes[0].plot(times, r.cost[1:], **look)
        if "friction" not in r.name:
            axes[1].plot(times, np.maximum(np.abs(r.energy[1:] / r.energy[0] - 1), 1e-17), **look)
        else:
            axes[2].plot(times, np.diff(r.events) / np.diff(r.times), **look)
    plots.label(axes[0], "t [h]", "cost [µs per simulated second]", log="xy")
    plots.label(axes[1], "t [h]", "change of energy / energy, s = 0", log="xy")
    plots.label(axes[2], "t [h]", "transitions per second", log="x")
    axes[2].set_ylim(0, 8)
    plots.legend_below(figure, axes[0], 5)
    report.picture("hours", figure)


def constraints(report: Report) -> None:
    """drift of the multibody form off its constraints"""
    found, rows = drift.study(report.library), []
    for d in found:
        half = len(d.t) // 2
        early, late = float(d.velocity[1:half].max()), float(d.velocity[half:].max())
        names = ("multibody, tolerance 1e-8", "velocity, first half", "velocity, second half", "height")
        rows.append(dict(zip(names, (d.name, early, late, float(d.height.max())), strict=True)))
    report.table("drift", rows)
    report.figure("drift", "constraint residual of the multibody form, relative", max(d.worst for d in found), "", 1e-9)


PARTS: dict[Callable[[Report], None], float] = {
    cases: 75,
    contract: 20,
    law: 15,
    crossings: 15,
    hours: 40,
    constraints: 20,
}
