"""The regularized law over its width, hours of motion, the drift of the paper's twelve states.

Stiff and extreme wheels: tests/robustness."""

from __future__ import annotations

from itertools import product
from time import perf_counter

import numpy as np
import pandas as pd

from wheelfmu.fmu.driver import WARNING, Values
from wheelfmu.truth.measure import law_error
from wheelfmu.truth.misprints import WHEEL, papers_start
from wheelfmu.truth.paper_transcription import FORMS, Paper, marched

from . import plots
from .page import Report, Row, Tables, number, part
from .plots import Sheet

METHODS = ("automatic", "bdf")
OF_LAW = {"tolerance": (1e-4, 1e-6, 1e-8), "omega_s, rad/s": tuple(10.0**-k for k in range(1, 9)), "method": METHODS}


@part(10, OF_LAW)
def law(report: Report, tolerance: float, omega_s: float, method: str) -> Row:
    """the regularized law in the paper's friction scene, against the exact law"""
    return {"error": law_error(report.library, omega_s, tolerance, method)}


@law.picture("law")
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


# ---- the paper's twelve states ----

STEPS, ENDS = (0.04, 0.02, 0.01), (1.0, 4.0, 16.0)  # s


def left(form: type[Paper], step: float, end: float, y: np.ndarray) -> Row:
    """How far a state of the paper's free wheel is off the constraints of (24)."""
    paper = form(WHEEL, y)
    off = {
        "velocity of the contact, m/s": np.abs(paper.slip).max(),
        "height off the contact, m": np.abs(paper.height_error),
    }
    name = next(name for name, each in FORMS.items() if each is form)
    return {"(24)": name, "step, s": step, "t, s": end} | {what: float(value) for what, value in off.items()}


@part(20)
def drift(_report: Report) -> dict[str, object]:
    """the paper's system in all its twelve states, by the classical Runge-Kutta method: what its constraints lose"""
    rows = []
    for form, step in product(FORMS.values(), STEPS):
        y, t = papers_start(), 0.0
        for end in ENDS:
            y, t = marched(form, WHEEL, y, step, round((end - t) / step)), end
            rows.append(left(form, step, end, y))
    return {"drift": pd.DataFrame(rows)}
