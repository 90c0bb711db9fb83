"""Error against run time beside other solvers, and what a step, an instance and the automatic rule cost.

The races are in race.py; here their comparison, the figures to reach, and what is measured without peers.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd
from support.driver import HEADLINE
from support.motion import Library
from support.paths import build_folder
from support.scenes import SCENES, SINES, sines

from .exchange import model_exchange
from .native import Master, Task, Timing
from .page import Report, Row, Tables, number, part
from .race import CPP, HEYOKA, METHODS, OURS, TITLES, at_default, draw_races, race, time_at
from .truth import headline_of, range_error

TARGETS = (1e-4, 1e-6, 1e-8)  # errors at which set-ups are compared


def master_of(report: Report) -> Master:
    if "master" not in report.kept:
        report.kept["master"] = Master(report.library)
    return report.kept["master"]


@part(108)
def races(report: Report) -> None:
    """error against run time, scene by scene"""
    rows = report.kept["runs"] = []
    for name in TITLES:
        rows += race(master_of(report), name, report.quick)
        report.table("runs", rows)


@part(3)
def compare(report: Report) -> None:
    """the races side by side"""
    runs = dict(list(pd.DataFrame(report.kept["runs"]).groupby("scene", sort=False)))
    free, friction = runs["free"], runs["friction"]
    Y = time_at(free, HEYOKA, 1e-6)
    report.figures(yardstick=1e6 * Y)
    for error in TARGETS:
        for peer, key in ((HEYOKA, "heyoka"), (CPP, "dop853")):
            ratio = time_at(free, OURS, error) / time_at(free, peer, error)
            report.figures(**{f"free_{key}_{-round(np.log10(error))}": ratio})
    for name in ("free", "friction"):
        ours = at_default(runs[name], OURS)
        in_Y = 1e-6 * ours.best_us / Y
        report.figures(**{name: in_Y, f"{name}_time": ours.best_us, f"{name}_error": ours.error})
    report.figures(friction_dop853=1e-6 * ours.best_us / time_at(friction, CPP, ours.error))


def views(tables: Tables) -> Tables:
    """The tables that follow from the runs."""
    scenes = tables["runs"].groupby("scene", sort=False)
    failed = tables["runs"][tables["runs"]["error"].isna()].assign(scene=lambda rows: rows["scene"].map(TITLES))
    reasons = failed.groupby(["setup", "scene", "note"], sort=False)["tolerance"]
    tolerances = reasons.agg(lambda t: " to ".join(map(number, dict.fromkeys((t.min(), t.max())))))
    heads = {"setup": "set-up", "note": "why", "tolerance": "tolerances"}
    return tables | {
        "fastest": pd.DataFrame([fastest_row(name, runs) for name, runs in scenes]),
        "behind": pd.DataFrame([row for name, runs in scenes if name != "stiff law" for row in behind(name, runs)]),
        "methods": pd.DataFrame([method_row(name, runs) for name, runs in scenes]),
        "failed": tolerances.reset_index().rename(columns=heads),
    }


def times_at(runs: pd.DataFrame, error: float) -> pd.Series:
    """Seconds of each set-up that gets there."""
    return pd.Series({setup: time_at(runs, setup, error) for setup in runs["setup"].unique()}).dropna()


def behind(name: str, runs: pd.DataFrame) -> list[Row]:
    """The fastest peer at each error, where it is more than 10 % faster than the FMU."""
    rows = []
    for error in TARGETS:
        times = times_at(runs, error)
        peers = times[[not setup.startswith("FMU") for setup in times.index]]
        if len(peers) and OURS in times and times[OURS] > 1.1 * peers.min():
            row = {"scene": TITLES[name], "error": number(error), "fastest peer": peers.idxmin()}
            rows.append({**row, "FMU over the peer": times[OURS] / peers.min()})
    return rows


def fastest_row(name: str, runs: pd.DataFrame) -> Row:
    """Who is fastest at each error, and the FMU's time over that of each peer that gets there."""
    row = {"scene": TITLES[name]}
    for error in TARGETS:
        times = times_at(runs, error)
        best = times.idxmin() if len(times) else "none"
        ratios = [f"{times[OURS] / times[p]:.2f}" if {p, OURS} <= set(times.index) else "–" for p in (CPP, HEYOKA)]
        row[f"at {number(error)}"] = f"{best} ({', '.join(ratios)})"
    return row


def method_row(name: str, runs: pd.DataFrame) -> Row:
    """At the default tolerance: what automatic costs beside each fixed method."""
    at = pd.DataFrame({method: at_default(runs, f"FMU {method}") for method in METHODS}).T
    cells = at.apply(
        lambda e: f"failed: {e.note}" if pd.isna(e.error) else f"{e.best_us:.0f} µs ({number(e.error)})", axis=1
    )
    fixed = at["best_us"].drop("automatic").dropna().astype(float)
    ratio = at["best_us"]["automatic"] / fixed.min()
    names = ("automatic over the fastest fixed one", "fastest fixed one")
    return {"scene": TITLES[name], **cells, **dict(zip(names, (ratio, fixed.idxmin()), strict=True))}


def best_of(master: Master, task: Task, seconds: float = 0.2) -> Timing:
    done = master.run(task, seconds)
    if not done.reached:
        raise RuntimeError(f"The run stopped after {done.steps} of {task.steps} steps.")
    return done


@part(4)
def long_and_general(report: Report) -> None:
    """1000 s of the free wheel; 10 s of one with J_x ≠ J_y"""
    master, Y = master_of(report), report.measured["yardstick"] * 1e-6
    long, general = Task({}, 1.0, 1000), Task(SCENES["general inertia"].start, 0.1, 100)
    report.figures(long=best_of(master, long).best / Y, general=best_of(master, general).best / Y)
    report.figures(long_error=long_error(report.library))


def long_error(library: Library, tolerance: float | None = None) -> float:
    """Error / range of the free wheel over 1000 s, against half a nutation of the reference laid end to end."""
    from orbit.orbit import Halves  # tests/orbit

    times = np.arange(0.05, 1000, 0.73)
    want = headline_of(Halves(SCENES["free"].wheel, SCENES["free"].motion).read(times))
    run = library.simulate([0.0, *times], tolerance)
    return range_error(np.column_stack([run[name][1:] for name in HEADLINE]), want)


def sine_table(steps: int, orders: int, shift: float = 0.0) -> np.ndarray:
    """Values and derivatives of the six inputs for each step of 1 ms, taken `shift` (s) after its start."""
    return np.array([[sines(1e-3 * k + shift, order) for order in range(orders + 1)] for k in range(steps)])


@part(14)
def small_steps(report: Report) -> None:
    """steps of 1 ms: outputs read, inputs that change"""
    master, rows, seconds = master_of(report), [], 0.1 if report.quick else 0.5
    for name in ("free", "friction"):
        done = best_of(master, Task(SCENES[name].start, 1e-3, 10_000), seconds)
        rows.append(step_row(f"{name}, inputs never set", done))
        report.figures(**{f"step_{name}": 1e9 * done.best / 10_000, f"step_{name}_longest": 1e6 * done.paces.max()})
    for orders, words in enumerate(("held", "first derivatives")):
        worst = 0.0
        for spin in (2.0, 10.0, 100.0, 300.0):
            values = {"theta_start": 1.4, "phi_dot_start": -spin}
            task = Task(values, 1e-3, 1000, inputs=tuple(SINES), table=sine_table(1000, orders))
            done = best_of(master, task, seconds)
            worst = max(worst, 1e6 * done.best / 1000) if spin <= 100 else worst
            rows.append(step_row(f"six inputs that change, {words}; {spin:g} rad/s", done))
        report.figures(**{("inputs_held", "inputs_linear")[orders]: worst})
    report.table("steps", rows)


def step_row(name: str, done: Timing) -> Row:
    return {
        "scene": name,
        "per step, best run, ns": 1e9 * done.best / done.steps,
        "median single step, ns": 1e9 * np.median(done.paces),
        "99.9th percentile, µs": 1e6 * np.percentile(done.paces, 99.9),
        "longest, µs": 1e6 * done.paces.max(),
    }


@part(1)
def left_out(report: Report) -> None:
    """what is left out, and what that saves"""
    master, base = master_of(report), Task({}, 0.1, 100)
    outputs = tuple(name for name, v in master.variables.items() if v.causality == "output")
    jumps = np.tile([0.01, 0.02], 50).reshape(100, 1, 1)  # N
    forced = {
        "nothing forced": base,
        "stepping instead of unfolding: method = adams": replace(base, values={"method": "adams"}),
        "Jacobian and Newton iteration: method = bdf": replace(base, values={"method": "bdf"}),
        "the paper's system (24): formulation = multibody": replace(base, values={"formulation": "multibody"}),
        "event function of the friction: s = 1e-15 m": replace(base, values={"s": 1e-15}),
        "an input that jumps at each of 100 points": replace(base, inputs=("F_X",), table=jumps),
        "reading all outputs instead of four": replace(base, outputs=outputs),
    }
    rows = []
    for what, task in forced.items():
        done = master.run(task, 0.1)
        counts = {name: done.counters[f"n_{name}"] for name in ("steps", "rhs", "jac", "roots", "restarts")}
        rows.append({"forced": what, "µs": 1e6 * done.best, **counts})
    report.table("left_out", rows)


@part(4)
def instances(report: Report) -> None:
    """what an instance takes"""
    rows = []
    for name in ("free", "friction"):
        done = master_of(report).run(Task(SCENES[name].start, 0.1, 15), 0.1)
        memory = np.median(done.costs[:, 3]) / 1024
        rows.append({"scene": name, "memory, KiB": memory, "create, initialize and free, µs": 1e6 * done.life})
    report.table("instances", rows)
    memory, life = pd.DataFrame(rows).drop(columns="scene").max()
    report.figures(memory=memory, life=life, archive=(build_folder() / "wheel.fmu").stat().st_size / 1024)


FURTHER = (model_exchange,)
PICTURES = {"races": draw_races}
