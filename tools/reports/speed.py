"""Error against run time, compared with other solvers, and the cost of a step, an instance and the automatic rule.

Races: every set-up at every tolerance, FMU and heyoka in turns in one process. What fails stays in the list with its
reason. The requirements are ratios to heyoka or to an empty call of the FMU, which hold on other machines, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property, partial
from math import exp, log, nan
from typing import Any

import numpy as np
import pandas as pd
from reference import Inputs
from support import sliding as slides
from support.driver import HEADLINE, Values
from support.paths import build_folder
from support.scenes import SCENES, Scene, sines

from . import plots
from .native import Master, Solve, bytes_in_use, ffi, repeated, width
from .options import EXAMPLES
from .page import Report, Row, Tables, number, part
from .plots import Sheet, style
from .truth import Array, headline, range_error

TARGETS = {4: 1e-4, 6: 1e-6, 8: 1e-8}  # errors at which set-ups are compared
POINTS = 101
HEYOKA = "heyoka"
OURS, METHODS = "FMU automatic", ("automatic", "adams", "bdf", "runge_kutta")
TITLES = {
    "free": "Free wheel, the paper's scene, 10 s",
    "friction": "Rolling friction, exact law, s = 0.03 m, 10 s",
    "general inertia": "J_x = 0.7, J_y = 1.2 kg m², 5 s",
    "stiff law": "Regularized friction, ω_s = 1e-6 rad/s, 10 s",
    "fast rolling": "Fast spin, φ̇ = −60 rad/s, 1 s",
    "near flat": "Near flat, θ from 30° down to 1°, 2 s",
}
SPINS = (2.0, 10.0, 100.0)  # rad/s
SLOW = 0.05  # s: what takes longer is measured once


@dataclass
class Entry:
    """One set-up at one tolerance; seconds of every repetition; why it has no error."""

    setup: str
    tolerance: float
    make: Callable[[], Solve]
    error: float = nan
    note: str = ""
    counts: dict[str, int] = field(default_factory=dict)
    seconds: list[float] = field(default_factory=list)

    @cached_property
    def solve(self) -> Solve:
        """Compiled and warmed up."""
        solve = self.make()
        solve()
        return solve

    def take_turn(self, seconds: float, want: Array) -> None:
        try:
            costs, rows, self.counts = repeated(self.solve, seconds)
            self.seconds += costs
            error = range_error(rows, want)
            self.error, self.note = (error, "") if np.isfinite(error) else (nan, "no finite result")
        except (RuntimeError, ImportError, ValueError, ArithmeticError) as trouble:
            self.note = str(trouble).split("\n")[0]

    def row(self) -> Row:
        micro = 1e6 * np.array(self.seconds or [nan])
        row = {"setup": self.setup, "tolerance": self.tolerance, "error": self.error}
        row |= {"best_us": micro.min(), "median_us": np.median(micro)}
        return row | {name: self.counts.get(name) for name in ("steps", "rhs", "events")} | {"note": self.note}


def in_fmu(master: Master, method: str, scene: Scene, tolerance: float, points: int) -> Solve:
    steps = points - 1
    return master.made({**scene.start, "method": method}, scene.duration / steps, steps, tolerance)


def in_heyoka(scene: Scene, tolerance: float, points: int) -> Solve:
    """Or an ImportError, where it is not installed."""
    from . import taylor

    wheel = taylor.Wheel(asdict(scene.wheel) | asdict(scene.motion), "angles", tolerance, omega_s=width(scene))
    grid, shown = np.linspace(0, scene.duration, points), [taylor.OUTPUTS.index(name) for name in HEADLINE]

    def solve() -> tuple[float, Array, dict[str, int]]:
        found = wheel.solve(grid)
        return found.seconds, found.rows[:, shown], {"steps": found.steps, "events": len(found.transitions)}

    return solve


PEERS = {HEYOKA: in_heyoka}


@part(108, {"scene": tuple(TITLES)})
def runs(report: Report, name: str) -> list[Row]:
    """error against run time, scene by scene

    In rounds, so that noise of the machine meets all alike. A peer that failed at a looser tolerance is not asked
    again: it is missing, or takes too long.
    """
    scene, entries = SCENES[name], []
    want = headline(scene, POINTS)
    setups = {f"FMU {method}": partial(in_fmu, report.master, method) for method in METHODS} | PEERS
    for setup, make in setups.items():
        slow = name == "stiff law" and setup in ("FMU adams", "FMU runge_kutta")
        tolerances = [10.0**-k for k in ((4, 6, 8, 10) if report.quick or slow else range(3, 14))]
        entries += [Entry(setup, tolerance, partial(make, scene, tolerance, POINTS)) for tolerance in tolerances]
    for turn in range(1 if report.quick else 5):
        reasons: dict[str, str] = {}
        for entry in entries:
            entry.note = entry.note or reasons.get(entry.setup, "")
            if not entry.note and not (turn and min(entry.seconds) > SLOW):
                entry.take_turn(0.004 if report.quick else 0.01, want)
            if entry.note and entry.setup in PEERS:
                reasons[entry.setup] = entry.note
    return [entry.row() for entry in entries]


def time_at(runs: pd.DataFrame, setup: str, error: float) -> float:
    """Microseconds to this error or a smaller one, by lines through log(time) over log(error); nan out of reach.

    A run that another one beats in both is left out.
    """
    points = runs[(runs["setup"] == setup) & runs["error"].notna()].sort_values(["error", "best_us"])
    points = points[points["best_us"] < points["best_us"].cummin().shift(fill_value=np.inf)]
    if points.empty:
        return nan
    return exp(np.interp(log(error), *np.log(points[["error", "best_us"]].to_numpy(float)).T, left=nan))


def at_default(runs: pd.DataFrame, setup: str) -> pd.Series:
    """The run at the FMU's default tolerance."""
    return runs[(runs["setup"] == setup) & np.isclose(runs["tolerance"], 1e-8, rtol=1e-6, atol=0)].iloc[0]


@part(1)
def compare(report: Report) -> Row:
    """the races side by side"""
    return {**compared(report.tables["runs"]), "archive": (build_folder() / "wheel.fmu").stat().st_size / 1024}


def compared(table: pd.DataFrame) -> Row:
    """Times and errors at the default tolerance; the FMU's time over heyoka's at the same error."""
    runs = dict(list(table.groupby("scene", sort=False)))
    found = {"heyoka": time_at(runs["free"], HEYOKA, 1e-6)}
    for digits, error in TARGETS.items():
        found[f"free_heyoka_{digits}"] = time_at(runs["free"], OURS, error) / time_at(runs["free"], HEYOKA, error)
    for name in ("free", "friction"):
        ours = at_default(runs[name], OURS)
        found |= {f"{name}_time": ours.best_us, f"{name}_error": ours.error}
    return found | {"friction_heyoka": ours.best_us / time_at(runs["friction"], HEYOKA, ours.error)}


def sine_table(steps: int, orders: int, shift: float = 0.0) -> Array:
    """Values and derivatives of the six inputs for each step of 1 ms, taken `shift` (s) after its start."""
    return np.array([[sines(1e-3 * k + shift, order) for order in range(orders + 1)] for k in range(steps)])


def timed_steps(report: Report, values: Values, count: int, table: Array | None = None) -> Row:
    """Of 1 ms each, four outputs read."""
    solve, paces = report.master.made(values, 1e-3, count, None, table), np.zeros(count)
    costs, *_ = repeated(solve, 0.1 if report.quick else 0.5)
    solve(paces)
    best = min(costs) / count
    row = {"per step, best run, ns": 1e9 * best, "in empty calls": best / empty_call(report)}
    row |= {"median single step, ns": 1e9 * np.median(paces), "99.9th percentile, µs": 1e6 * np.percentile(paces, 99.9)}
    return row | {"longest, µs": 1e6 * paces.max()}


@part(2, {"scene": ("free", "friction")})
def steps(report: Report, scene: str) -> Row:
    """steps of 1 ms, inputs never set"""
    return timed_steps(report, SCENES[scene].start, 10_000)


@part(6, {"spin, rad/s": SPINS})
def inputs_held(report: Report, spin: float) -> Row:
    """steps of 1 ms, six inputs that change, held"""
    return timed_inputs(report, spin, 0)


@part(6, {"spin, rad/s": SPINS})
def inputs_linear(report: Report, spin: float) -> Row:
    """steps of 1 ms, six inputs that change, with first derivatives"""
    return timed_inputs(report, spin, 1)


# Start, what makes it slide, and s; the reduced equations are stepped, not unfolded.
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
    """wheels that slide, over the same wheels that are stepped without sliding"""
    start, more, duration = case
    solves = [report.master.made(values, 0.1, round(duration / 0.1)) for values in (start, start | more)]
    found = [repeated(solve, 0.1 if report.quick else 0.5) for solve in solves]
    times, steps = zip(*((1e6 * min(costs), counts["steps"]) for costs, _, counts in found), strict=True)
    row = {"rolls, µs": times[0], "slides, µs": times[1], "ratio of times": times[1] / times[0]}
    return row | {"steps, rolls": steps[0], "steps, slides": steps[1], "ratio of steps": steps[1] / steps[0]}


def timed_inputs(report: Report, spin: float, orders: int) -> Row:
    start = {"theta_start": 1.4, "phi_dot_start": -spin}
    return timed_steps(report, start, 1000, sine_table(1000, orders))


# ---- cost and accuracy of inputs: the free wheel pushed by six sines, or by constants, in steps of 1 ms ----

STEP, EVERY = 1e-3, 100  # s; steps between compared instants
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


@part(20, {"inputs": CASES, "method": ("automatic", "adams", "bdf")})
def inputs(report: Report, case: tuple, method: str) -> Row:
    """cost of inputs, and their error"""
    scene, (judge, table_of) = replace(SCENES["free"], duration=2.0 if report.quick else 10.0), case
    steps = round(scene.duration / STEP)
    want = headline(scene, steps // EVERY + 1, judge, TRUTHS[judge])
    solve = report.master.made({"method": method}, STEP, steps, None, table_of(steps))
    try:
        costs, rows, counts = repeated(solve, 0.05)
    except RuntimeError:
        return {"µs per step": np.nan, "error / range": np.inf}
    found = {name: counts[name] for name in ("steps", "rhs", "restarts")}
    return found | {"µs per step": 1e6 * min(costs) / steps, "error / range": range_error(rows[::EVERY], want)}


@part(4, {"scene": {"free": 0, "friction": 1}})
def instances(report: Report, scene: int) -> Row:
    """what an instance takes"""
    code, guid = report.master.code, report.library.description.guid.encode()
    for _ in range(2):  # the second time Python itself takes nothing new
        before = bytes_in_use(code)
        with report.library.wheel() as wheel:
            wheel.start(s=0.03 * scene)
            for k in range(15):
                wheel.step_to(0.1 * (k + 1))
            memory = (bytes_in_use(code) - before) / 1024
    life = np.median([code.life(guid, scene) for _ in range(2000)])
    empty = empty_call(report)
    row = {"memory, KiB": memory, "create, initialize and free, µs": 1e6 * life, "in empty calls": life / empty}
    return row | {"empty call, ns": 1e9 * empty}


def empty_call(report: Report) -> float:
    """Seconds of an FMI call that does nothing."""
    with report.library.wheel() as wheel:
        wheel.start()
        component = ffi.cast("void *", wheel.component)
        return min(report.master.code.empty_call(component, 10_000) for _ in range(20))


def views(tables: Tables) -> Tables:
    """The tables that follow from the runs."""
    scenes = [(TITLES[name], runs) for name, runs in tables["runs"].groupby("scene", sort=False)]
    failed = tables["runs"][tables["runs"]["error"].isna()].drop_duplicates(["scene", "setup"])
    return tables | {
        "fastest": pd.DataFrame([{"scene": title} | fastest(runs) for title, runs in scenes]),
        "methods": pd.DataFrame([{"scene": title} | price_of_choice(runs) for title, runs in scenes]),
        "failed": failed.assign(scene=failed["scene"].map(TITLES)),
    }


def fastest(runs: pd.DataFrame) -> Row:
    """The fastest set-up at each error, and the FMU's time over that of heyoka, if it reaches the error."""
    row = {}
    for error in TARGETS.values():
        times = pd.Series({setup: time_at(runs, setup, error) for setup in runs["setup"].unique()}).dropna()
        ratio = f"{times[OURS] / times[HEYOKA]:.2f}" if {HEYOKA, OURS} <= set(times.index) else "–"
        row[f"at {number(error)}"] = f"{times.idxmin() if len(times) else 'none'} ({ratio})"
    return row


def price_of_choice(runs: pd.DataFrame) -> Row:
    """At the default tolerance: automatic, and beside the fastest fixed method."""
    automatic, *fixed = (at_default(runs, f"FMU {method}") for method in METHODS)
    ratio = automatic.best_us / np.nanmin([run.best_us for run in fixed])
    shown = f"{automatic.best_us:.0f} µs ({number(automatic.error)})"
    return {"automatic": shown, "automatic over the fastest fixed one": ratio}


LOOKS = {  # colour, marker and line
    OURS: (style.BLUE, "o-"),
    "FMU adams": (style.SKY, "v-"),
    "FMU bdf": (style.SKY, "<--"),
    "FMU runge_kutta": (style.SKY, ">:"),
    HEYOKA: (style.GREEN, "^-"),
}


def draw_races(tables: Tables) -> Sheet:
    """A sheet for each scene, one legend; automatic lies on top, half transparent, so that what it equals shows."""
    figure, axes = plots.sheet("ab;cd;ef", 68)
    solved = tables["runs"].dropna(subset="error")
    for ax, (scene, title) in zip(axes, TITLES.items(), strict=True):
        for setup, points in solved[solved["scene"] == scene].groupby("setup", sort=False):
            colour, mark = LOOKS[setup]
            look = {"lw": 3.5, "alpha": 0.55, "ms": 5} if setup == OURS else {"lw": 1, "ms": 3}
            ax.plot(points["best_us"], points["error"].clip(lower=1e-14), mark, color=colour, label=setup, **look)
        plots.label(ax, "best time [µs]", "error / range", title, "xy", ylim=(1e-14, 3))
    plots.legend_below(figure, axes, 3)
    return figure


FURTHER = ("benchmark", *["studies"] * (EXAMPLES / "studies").exists())
PICTURES = {"races": draw_races}
