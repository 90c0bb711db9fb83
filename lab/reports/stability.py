"""Stiff and extreme wheels: every case of truth/sweep.py at five tolerances, the regularized law, long runs.

Cases, judges and bounds are those of tests/robustness. An error is judged by the energy, Chaplygin's linear integrals,
the independent reference or a closed form.
"""

from __future__ import annotations

from multiprocessing import get_context
from time import perf_counter

import numpy as np
import pandas as pd
from pebble import ProcessExpired, ProcessFuture, ProcessPool

from wheelfmu.fmu.driver import WARNING, Values
from wheelfmu.truth.judges import TOLERANCES, Verdict, judge_case, law_bound, law_error
from wheelfmu.truth.motion import Library
from wheelfmu.truth.sweep import Case, sweep

from . import plots
from .page import Report, Row, Tables, number, part
from .plots import Sheet, style

DEADLINE = 120.0  # s
METHODS = ("automatic", "bdf")
OF_LAW = {"tolerance": (1e-4, 1e-6, 1e-8), "omega_s, rad/s": tuple(10.0**-k for k in range(1, 9)), "method": METHODS}
COLUMNS = ("case", "expected", "tolerance", "outcome", "as expected", "claimed", "steps", "fault")
JUDGES = {"energy": "energy", "integrals": "linear integrals", "reference": "outputs against the reference"}
JUDGES |= {"instant": "instant of the ending, s"}


def alone(folder: str, case: Case) -> list[Verdict]:
    return judge_case(Library(folder), case)


def answer(future: ProcessFuture) -> list[Verdict]:
    """A hang or a crash is a result, not the end."""
    try:
        return future.result()
    except TimeoutError:
        fault = f"hangs: no answer within {DEADLINE:g} s"
    except ProcessExpired as end:
        fault = f"crashes: the process ended with exit code {end.exitcode}"
    return [Verdict(tolerance, fault, faults=[fault]) for tolerance in TOLERANCES]


@part(75)
def cases(report: Report) -> dict[str, object]:
    """the sweep: each case at five tolerances, in a separate process with a deadline"""
    chosen = sweep()[:: 6 if report.quick else 1]
    with ProcessPool(2, max_tasks=1, context=get_context("fork")) as pool:
        futures = [pool.schedule(alone, (report.library.folder, case), timeout=DEADLINE) for case in chosen]
        rows = [row_of(case, v) for case, future in zip(chosen, futures, strict=True) for v in answer(future)]
    rows = pd.DataFrame(rows).reindex(columns=[*COLUMNS, *JUDGES, *(f"{judge}: floor" for judge in JUDGES)])
    faults = rows[~rows["as expected"]]
    found = {"sweep": rows, "faults": faults}
    loose = [(str(case), case.loosest, case.remark) for case in chosen if case.loosest < 1e-4]
    found["loose"] = pd.DataFrame(loose, columns=["case", "needs", "why"])
    return found | {"cases": len(chosen), "faults_found": len(faults)}


def row_of(case: Case, verdict: Verdict) -> Row:
    """Each judge's error, and what the judge itself cannot see."""
    head = (str(case), str(case.expect), verdict.tolerance, verdict.outcome, verdict.holds, verdict.claimed)
    row = dict(zip(COLUMNS, (*head, verdict.steps, "; ".join(verdict.faults)), strict=True))
    return row | {f.judge: f.error for f in verdict.errors} | {f"{f.judge}: floor": f.floor for f in verdict.errors}


def draw_cases(tables: Tables) -> Sheet:
    """Errors that the judge sees, of what is claimed."""
    figure, axes = plots.sheet("ab")
    titles = {"energy": "energy balance", "reference": "outputs against the independent reference"}
    for ax, (judge, title) in zip(axes, titles.items(), strict=True):
        for case, rows in tables["sweep"].groupby("case", sort=False):
            hard = case.startswith(("brushing", "friction: s = 1", "past upright: theta = 170"))
            look = {"color": style.VERMILLION, "label": "grazing the ground, or s of 1 m and more"}
            look = look if hard else {"color": style.BLUE, "label": "a case"}
            seen = rows[judge].where(rows["claimed"] & (rows[judge] > 2 * rows[f"{judge}: floor"]))
            ax.plot(rows["tolerance"], seen, ".-", alpha=0.6, lw=0.8, ms=3, **look)
        ax.plot(TOLERANCES, TOLERANCES, "--", color=style.INK, lw=0.9, label="error = tolerance")
        plots.label(ax, "tolerance", "relative error", title, "xy")
    plots.legend_below(figure, axes, 3)
    return figure


@part(10, OF_LAW)
def law(report: Report, tolerance: float, omega_s: float, method: str) -> Row:
    """the regularized law in the paper's friction scene, against the exact law"""
    error = law_error(report.library, omega_s, tolerance, method)
    return {"error": error, "error / bound": error / law_bound(omega_s, tolerance)}


def draw_law(tables: Tables) -> Sheet:
    figure, (ax,) = plots.sheet("a")
    for colour, (tolerance, points) in zip(plots.COLOURS, tables["law"].groupby("tolerance", sort=False), strict=False):
        for method, marker in zip(METHODS, ("o-", "x--"), strict=True):
            chain, words = points[points["method"] == method], f"{method}, tolerance {number(tolerance)}"
            ax.plot(chain["omega_s, rad/s"], chain["error"], marker, color=colour, ms=4, lw=0.8, label=words)
    plots.label(ax, r"$\omega_s$ [rad/s]", "error against the exact law", log="xy")
    plots.legend_below(figure, [ax], 3)
    return figure


# ---- hours of the paper's wheel; times in s of the model unless said ----

HOUR = 3600.0
TOLERANCE = 1e-8
ROUNDING = 1e-13  # of the energy, relative
SCENES: dict[str, Values] = {"free": {}, "friction": {"s": 0.03}, "multibody": {"formulation": "multibody"}}


def long_run(report: Report, scene: str, hours: int) -> Row:
    """One run, read at 600 instants; the cost in us per simulated second, the rise of the energy beyond rounding."""
    rows, step = [], hours * HOUR / 600
    with report.library.wheel() as wheel:
        wheel.start(tolerance=TOLERANCE, **SCENES[scene]).step_to(0.0)
        read = wheel.reader(["E"])
        for t in step * np.arange(601):
            before = perf_counter()
            assert wheel.step_to(float(t)) <= WARNING, wheel.sentences
            rows.append((1e6 * (perf_counter() - before) / step, *read()))
        transitions = int(wheel.get("n_events")[0])
    cost, E = np.array(rows).T
    costs = {"µs/s, first sixth": np.median(cost[1:101]), "µs/s, last sixth": np.median(cost[-100:])}
    rise = max((np.diff(E) - ROUNDING * E[0]).max(), 0.0)
    energy = {"energy change / E": (E[-1] - E[0]) / E[0], "largest rise, J": rise}
    return {"run": f"{scene}, {hours} h"} | costs | energy | {"transitions": transitions, "E": E[0]}


@part(40)
def hours(report: Report) -> dict[str, object]:
    """an hour and a day"""
    chosen = [(scene, 1) for scene in SCENES] + [("free", 24), ("friction", 24)] * (not report.quick)
    runs = pd.DataFrame([long_run(report, *run) for run in chosen])
    growth, rise = runs["µs/s, last sixth"] / runs["µs/s, first sixth"], runs["largest rise, J"] / runs["E"]
    return {"hours": runs.drop(columns="E"), "growth": growth.max(), "rise": rise.max() / TOLERANCE}


PICTURES = {"cases": draw_cases, "law": draw_law}
