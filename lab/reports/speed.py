"""Error against run time, and the cost of the automatic rule, of a step, of inputs, of sliding and of an instance.

Races: every method, and heyoka in the FMU's place, at every tolerance, in turns in one process. The bounds are
ratios to another program, another method or an empty call of the FMU, which hold on other machines, too.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from math import exp, log, nan
from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd

from wheelfmu.diagrams import races
from wheelfmu.fmu.driver import Values
from wheelfmu.truth import sliding as slides
from wheelfmu.truth.errors import over_range
from wheelfmu.truth.problems import PROBLEMS, by_fmu, by_reference, errors
from wheelfmu.truth.reference import Inputs
from wheelfmu.truth.scenes import SCENES, Scene, sines

from . import plots
from .page import Report, Row, Tables, number, part
from .plots import Sheet
from .truth import Array, Solve, headline

TIMED_STEPS = 100  # of a run, whatever its length
APART = 0.01  # s, between the instants at which an error is taken, as by ./scripts/run
MOST_RUNS = 20_000
LEAST_RUNS, LONG = 5, 0.1  # runs; s: the best of two or three runs of some milliseconds still scatters by a quarter
METHODS = ("automatic", "adams", "bdf", "runge_kutta")
HEYOKA = "heyoka"
ERRORS = (1e-4, 1e-6, 1e-8, 1e-10)  # at which the FMU is compared with heyoka
TITLES = {
    "free": "Free wheel, the paper's scene, 10 s",
    "friction": "Rolling resistance, exact law, s = 0.03 m, 10 s",
    "general inertia": "J_x = 0.7, J_y = 1.2 kg m², 5 s",
    "stiff law": "Regularized law, ω_s = 1e-6 rad/s, 10 s",
    "fast rolling": "Fast spin, φ̇ = −60 rad/s, 1 s",
    "near flat": "Near flat, θ from 30° down to 1°, 2 s",
}
SPINS = (2.0, 10.0, 100.0)  # rad/s
PRICE = "automatic over the fastest fixed one"


@part(108, {"scene": tuple(TITLES)})
def runs(report: Report, name: str) -> list[Row]:
    """error against run time, scene by scene

    In rounds, so that noise of the machine meets all alike. A further run is compared with the reference: its steps of
    10 ms do not change the motion. A run that fails stays in the list with its reason.
    """
    scene, seconds = SCENES[name], 0.004 if report.quick else 0.01
    fine = round(scene.duration / APART)
    want, rows, solves = headline(scene, fine + 1), [], []
    for method in METHODS if name == "stiff law" else (*METHODS, HEYOKA):
        for tolerance in [10.0**-k for k in ((4, 6, 8, 10) if report.quick else range(3, 14))]:
            solve = made(report, scene, method, tolerance, TIMED_STEPS)
            row = {"method": method, "tolerance": tolerance, "note": ""}
            try:
                solve()  # warms up
                costs, _, counts = repeated(solve, seconds)
                _, found, _ = made(report, scene, method, tolerance, fine)()
                row |= {"error": over_range(found, want)} | {n: counts.get(n) for n in ("steps", "rhs", "events")}
                solves.append((row, solve, costs))
            except RuntimeError as trouble:
                row["note"] = str(trouble).split("\n")[0]
            rows.append(row)
    for _ in range(0 if report.quick else 4):
        for _, solve, costs in solves:
            costs += repeated(solve, seconds)[0]
    for row, _, costs in solves:
        row["best_us"] = 1e6 * min(costs)
    columns = ("method", "tolerance", "error", "best_us", "steps", "rhs", "events", "note")
    return [{name: row.get(name) for name in columns} for row in rows]


def repeated(solve: Solve, seconds: float) -> tuple[list[float], Array, dict[str, int]]:
    """Seconds of each repetition, for `seconds` in all, but not fewer than LEAST_RUNS of a run that is not long; the
    last one's outputs and counts."""
    costs: list[float] = []
    spent = 0.0
    while len(costs) < MOST_RUNS and (spent < seconds or (len(costs) < LEAST_RUNS and spent < LONG)):
        cost, rows, counts = solve()
        costs.append(cost)
        spent += cost
    return costs, rows, counts


def made(report: Report, scene: Scene, method: str, tolerance: float, steps: int) -> Solve:
    if method == HEYOKA:
        from .taylor import Wheel

        return partial(Wheel(scene, tolerance).solve, np.linspace(0, scene.duration, steps + 1))
    return report.master.made({**scene.start, "method": method}, scene.duration / steps, steps, tolerance)


def time_at(runs: pd.DataFrame, method: str, error: float) -> float:
    """Microseconds to this error or a smaller one, by lines through log(time) over log(error); nan out of reach.

    A run that another one beats in both is left out.
    """
    points = runs[(runs["method"] == method) & runs["error"].notna()].sort_values(["error", "best_us"])
    points = points[points["best_us"] < points["best_us"].cummin().shift(fill_value=np.inf)]
    if points.empty:
        return nan
    errors, times = np.log(points[["error", "best_us"]].to_numpy(float)).T
    return exp(np.interp(log(error), errors, times, left=nan))


def over(runs: pd.DataFrame, method: str, other: str) -> np.ndarray:
    """The time of a method over another's at each of the equal errors; nan where one of them was not asked."""
    return np.array([time_at(runs, method, error) / time_at(runs, other, error) for error in ERRORS])


def over_heyoka(runs: pd.DataFrame) -> float:
    """The FMU's time over heyoka's, the largest of all errors; nan where heyoka was not asked."""
    ratios = over(runs, "automatic", HEYOKA)
    return nan if np.isnan(ratios).all() else np.nanmax(ratios)


def at_default(runs: pd.DataFrame, method: str) -> pd.Series:
    """The run at the FMU's default tolerance."""
    return runs[(runs["method"] == method) & np.isclose(runs["tolerance"], 1e-8, rtol=1e-6, atol=0)].iloc[0]


def figures(tables: Tables) -> Row:
    """Of the races side by side, and the error of wheel.fmu in the benchmark."""
    scenes = dict(list(tables["runs"].groupby("scene", sort=False)))
    ratios = pd.Series({name: price_of_choice(runs)[PRICE] for name, runs in scenes.items()})
    found = {f"{name}_time": at_default(scenes[name], "automatic").best_us for name in ("free", "friction")}
    beside = {name: over_heyoka(runs) for name, runs in scenes.items()}
    found["heyoka_unfolded"] = max(beside[name] for name in ("free", "fast rolling", "near flat"))
    found["heyoka_stepped"] = max(beside[name] for name in ("friction", "general inertia"))
    smooth = [over(runs, "adams", "runge_kutta") for name, runs in scenes.items() if name != "stiff law"]
    found |= {"adams_least": np.nanmin(smooth), "adams_most": np.nanmax(smooth)}
    of_wheel = tables["programs"].query("program == 'wheel.fmu'")
    is_tight = np.isclose(of_wheel["tolerance"].astype(float), 1e-13, rtol=1e-6, atol=0)
    found["benchmark"] = of_wheel.loc[is_tight, "error / range"].max()
    return found | {"rule": ratios.max(), "free_rule": ratios["free"]}


def sine_table(steps: int, orders: int, shift: float = 0.0) -> Array:
    """Values and derivatives of the six inputs for each step of 1 ms, taken `shift` (s) after its start."""
    return np.array([[sines(1e-3 * k + shift, order) for order in range(orders + 1)] for k in range(steps)])


def timed_steps(report: Report, values: Values, count: int, table: Array | None = None) -> Row:
    """Of 1 ms each, four outputs read. A single step's time is its least of five runs: the rest are interruptions."""
    solve, paces = report.master.made(values, 1e-3, count, None, table), np.zeros((5, count))
    costs, *_ = repeated(solve, 0.1 if report.quick else 0.5)
    for run in paces:
        solve(run)
    paces = paces.min(axis=0)
    best, empty = min(costs) / count, report.master.empty_call()
    row = {"per step, best run, ns": 1e9 * best, "in empty calls": best / empty, "empty call, ns": 1e9 * empty}
    row |= {"median single step, ns": 1e9 * np.median(paces), "99.9th percentile, µs": 1e6 * np.percentile(paces, 99.9)}
    return row | {"longest, µs": 1e6 * paces.max()}


@part(2, {"scene": ("free", "friction")})
def steps(report: Report, scene: str) -> Row:
    """steps of 1 ms, inputs never set"""
    return timed_steps(report, SCENES[scene].start, 10_000)


@part(6, {"spin, rad/s": SPINS})
def inputs_held(report: Report, spin: float, orders: int = 0) -> Row:
    """steps of 1 ms, six inputs that change, held"""
    return timed_steps(report, {"theta_start": 1.4, "phi_dot_start": -spin}, 1000, sine_table(1000, orders))


@part(6, {"spin, rad/s": SPINS})
def inputs_linear(report: Report, spin: float) -> Row:
    """steps of 1 ms, six inputs that change, with first derivatives"""
    return inputs_held.measure(report, spin, 1)


LEANS: Values = {**slides.UPRIGHT, "theta_start": 1.4, "phi_dot_start": -28.0}
CARRIED: Values = {**LEANS, "guided": True}
# Start, the input that follows a sine, and its amplitude.
VARIED = {
    "free, M_3": (LEANS, "M_3", 0.5),
    "guided, M_3": (CARRIED, "M_3", 0.5),
    "guided, psi_dot_guide": (CARRIED, "psi_dot_guide", 0.5),
    "guided, theta_dot_guide": (CARRIED, "theta_dot_guide", 0.1),
}


@part(4)
def steered(report: Report) -> list[Row]:
    """steps of 1 ms with first derivatives of one input, in turns"""
    count = 1000
    costs: dict[str, list[float]] = {}
    t = 1e-3 * np.arange(count)[:, np.newaxis]
    for _ in range(1 if report.quick else 5):
        for name, (values, varied, size) in VARIED.items():
            table = size * np.stack([np.sin(2 * t), 2 * np.cos(2 * t)], axis=1)
            solve = report.master.made(values, 1e-3, count, None, table, (varied,))
            costs.setdefault(name, []).extend(repeated(solve, 0.1)[0])
    best = {name: 1e6 * min(of) / count for name, of in costs.items()}
    first = next(iter(best.values()))
    return [{"wheel": name, "µs per step": cost, "times the first": cost / first} for name, cost in best.items()]


# Start, what makes it slide, and the duration, s. The reduced equations are stepped, not unfolded.
STEPPED: Values = {"formulation": "reduced"}
ROLLING: Values = {**STEPPED, **slides.UPRIGHT, "phi_dot_start": -20.0}
LOCKED: Values = {**slides.ROAD, "M_brake": 1e3, "phi_dot_start": 0.0, "slip_x_start": 7.0}
SLIDES = {
    "free, mu_max = 0.45, mu_slide = 0.4": (STEPPED, slides.ROAD, 10.0),
    "free, both 0.4": (STEPPED, slides.EQUAL, 10.0),
    "locked, 7 m/s": (ROLLING, LOCKED, 2.0),
}


@part(3, {"wheel": SLIDES})
def sliding(report: Report, case: tuple[Values, Values, float]) -> Row:
    """wheels that slide, over the same wheels that are stepped without sliding, in turns"""
    start, more, duration = case
    solves = [report.master.made(values, 0.1, round(duration / 0.1)) for values in (start, start | more)]
    steps = [solve()[2]["steps"] for solve in solves]
    rounds = [[min(repeated(solve, 0.05)[0]) for solve in solves] for _ in range(2 if report.quick else 20)]
    rolls, slips = 1e6 * np.median(rounds, axis=0)
    row = {"rolls, µs": rolls, "slides, µs": slips, "ratio of times": slips / rolls}
    return row | {"steps, rolls": steps[0], "steps, slides": steps[1], "ratio of steps": steps[1] / steps[0]}


# ---- cost and accuracy of inputs: the free wheel pushed by six sines, or by constants, in steps of 1 ms ----

STEP = 1e-3  # s
EVERY = round(APART / STEP)  # steps between compared instants
CONSTANT = sines(1.0)


def halves(inputs: Any) -> Inputs:
    """Forces and moments out of all six."""
    return Inputs(lambda t: inputs(t)[:3], lambda t: inputs(t)[3:])


TRUTHS = {"none": Inputs(), "constant": halves(lambda _t: CONSTANT), "sines": halves(sines)}
# How the inputs are given: what judges it, and the table of the master, of so many steps.
CASES = {
    "never set": ("none", lambda steps: None),
    "constant, set at every step": ("constant", lambda steps: np.tile(CONSTANT, (steps, 1, 1))),
    "sines, held over the step": ("sines", lambda steps: sine_table(steps, 0)),
    "sines, held at their value in mid-step": ("sines", lambda steps: sine_table(steps, 0, STEP / 2)),
    "sines, first derivative given": ("sines", lambda steps: sine_table(steps, 1)),
    "sines, derivatives up to order 2": ("sines", lambda steps: sine_table(steps, 2)),
    "sines, derivatives up to order 3": ("sines", lambda steps: sine_table(steps, 3)),
}


@part(8, {"inputs": CASES})
def inputs(report: Report, case: tuple) -> Row:
    """cost of inputs, and their error"""
    scene, (judge, table_of) = replace(SCENES["free"], duration=2.0 if report.quick else 10.0), case
    steps = round(scene.duration / STEP)
    want = headline(scene, steps // EVERY + 1, judge, TRUTHS[judge])
    costs, rows, counts = repeated(report.master.made({}, STEP, steps, None, table_of(steps)), 0.05)
    found = {name: counts[name] for name in ("steps", "rhs", "restarts")}
    return found | {"µs per step": 1e6 * min(costs) / steps, "error / range": over_range(rows[::EVERY], want)}


@part(4, {"scene": {"free": 0, "friction": 1}})
def instances(report: Report, scene: int) -> Row:
    """what an instance takes"""
    master = report.master
    for _ in range(2):  # the second time Python itself takes nothing new
        before = master.bytes_in_use()
        with report.library.wheel() as wheel:
            wheel.start(s=0.03 * scene)
            for k in range(15):
                wheel.step_to(0.1 * (k + 1))
            memory = (master.bytes_in_use() - before) / 1024
    life = np.median([master.life(scene) for _ in range(2000)])
    empty = master.empty_call()
    row = {"memory, KiB": memory, "create, initialize and free, µs": 1e6 * life, "in empty calls": life / empty}
    return row | {"empty call, ns": 1e9 * empty}


@part(20, {"scene": tuple(PROBLEMS)})
def programs(report: Report, name: str) -> list[Row]:
    """error against run time in the scenes of docs/benchmark.md, against its reference values"""
    rows, problem = [], PROBLEMS[name]
    multibody = replace(problem, start={**problem.start, "formulation": 3})
    cases = [("wheel.fmu", problem, f"1e-{n}", 3 if report.quick else 20) for n in (6, 8, 10, 12, 13)]
    cases.append(("wheel.fmu, the paper's (24)", multibody, "1e-12", 1))
    for program, scene, tolerance, repeats in cases:
        found = [by_fmu(report.library, scene, float(tolerance)) for _ in range(repeats)]
        rows.append((program, tolerance, *errors(name, found[0]), 1e3 * min(run.seconds for run in found)))
    for tolerance in ("1e-10", "1e-13"):
        begin = perf_counter()
        solution = by_reference(problem, float(tolerance))
        spent = 1e3 * (perf_counter() - begin)
        rows.append(("truth/reference", tolerance, *errors(name, solution), spent))
    return [dict(zip(("program", "tolerance", "error / range", "instants, s", "ms"), row, strict=True)) for row in rows]


def views(tables: Tables) -> Tables:
    """The tables that follow from the runs."""
    scenes = [(TITLES[name], runs) for name, runs in tables["runs"].groupby("scene", sort=False)]
    failed = tables["runs"][tables["runs"]["error"].isna()].drop_duplicates(["scene", "method"])
    return tables | {
        "methods": pd.DataFrame([{"scene": title} | price_of_choice(runs) for title, runs in scenes]),
        "failed": failed.assign(scene=failed["scene"].map(TITLES)),
    }


def price_of_choice(runs: pd.DataFrame) -> Row:
    """At the default tolerance: automatic, and beside the fastest fixed method."""
    automatic, *fixed = (at_default(runs, method) for method in METHODS)
    ratio = automatic.best_us / np.nanmin([run.best_us for run in fixed])
    row = {"automatic": f"{automatic.best_us:.0f} µs ({number(automatic.error)})", PRICE: ratio}
    return row | {"over heyoka at equal error, at most": over_heyoka(runs)}


@runs.picture("races")
def draw_races(tables: Tables) -> Sheet:
    """A panel for each scene, one legend."""
    figure, axes = plots.sheet("ab;cd;ef", 68)
    solved = tables["runs"].dropna(subset="error")
    for ax, (scene, title) in zip(axes, TITLES.items(), strict=True):
        for method, points in solved[solved["scene"] == scene].groupby("method", sort=False):
            races.curve(ax, method, points["best_us"], points["error"])
        races.dress(ax, title)
    plots.legend_below(figure, axes)
    return figure
