"""Error against run time beside other solvers, and what a step, an instance and the automatic rule cost.

The races are in race.py; here their comparison, the figures to reach, and what is measured without peers.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from support.driver import HEADLINE
from support.motion import Library
from support.paths import build_folder
from support.scenes import SCENES, SINES, sines

from . import code_lines, older
from .native import Master, Task
from .page import Report, number
from .race import CPP, HEYOKA, METHODS, OURS, TITLES, Entry, draw, entry_at, race, time_at
from .truth import range_error

TARGETS = (1e-4, 1e-6, 1e-8)  # errors at which set-ups are compared


def master_of(report: Report) -> Master:
    if "master" not in report.kept:
        report.kept["master"] = Master(build_folder() / "wheel.fmu")
    return report.kept["master"]


def run_race(name: str) -> Callable[[Report], None]:
    def part(report: Report) -> None:
        report.kept.setdefault("races", {})[name] = race(master_of(report), name, report.quick)

    part.__doc__ = f"error against run time: {TITLES[name]}"
    return part


def compare(report: Report) -> None:
    """the races side by side"""
    races: dict[str, list[Entry]] = report.kept["races"]
    report.table("runs", [e.row() for entries in races.values() for e in entries])
    report.table("fastest", [fastest_row(name, entries) for name, entries in races.items()])
    report.table("methods", [method_row(name, entries) for name, entries in races.items()])
    report.table("failed", failed_rows(races))
    free, friction = races["free"], races["friction"]
    Y = time_at(free, HEYOKA, 1e-6)
    report.figure("yardstick", "Y: heyoka, paper's free wheel, 10 s, error 1e-6", 1e6 * Y, "µs")
    ours = {name: entry_at(races[name], OURS) for name in ("free", "friction")}
    report.figure("free", "free wheel, 10 s, 100 reads", ours["free"].best / Y, "Y", 0.7)
    for error in TARGETS:
        for peer, key in ((HEYOKA, "heyoka"), (CPP, "dop853")):
            ratio = time_at(free, OURS, error) / time_at(free, peer, error)
            report.figure(
                f"free_{key}_{-log10(error)}", f"free wheel at error {number(error)}: over {peer}", ratio, "×", 1
            )
    report.figure("friction", "friction wheel, 10 s", ours["friction"].best / Y, "Y", 2.5)
    theirs = time_at(friction, CPP, ours["friction"].error or 1e-8)
    ratio = ours["friction"].best / theirs
    report.figure("friction_dop853", f"friction wheel at the same error: over {CPP}", ratio, "×", 1.25)
    for name, entry in ours.items():
        report.figure(f"{name}_time", f"{name} wheel, 10 s", 1e6 * entry.best, "µs")
        report.figure(f"{name}_error", f"{name} wheel, 10 s: error / range", entry.error or np.inf)
    report.picture("races", draw(races))


def log10(value: float) -> int:
    return round(np.log10(value))


def fastest_row(name: str, entries: list[Entry]) -> dict[str, object]:
    """Who is fastest at each error, and the FMU's time over that of each peer that gets there."""
    row: dict[str, object] = {"scene": TITLES[name]}
    for error in TARGETS:
        times = {setup: time_at(entries, setup, error) for setup in dict.fromkeys(e.setup for e in entries)}
        times = {setup: t for setup, t in times.items() if t == t}
        best = min(times, key=lambda setup: times[setup]) if times else "none"
        ratios = [f"{p} {times[OURS] / times[p]:.2f}" for p in (CPP, HEYOKA) if p in times and OURS in times]
        row[f"fastest at {number(error)} (FMU over {CPP}, heyoka)"] = f"{best} ({', '.join(ratios) or 'no peer'})"
    return row


def method_row(name: str, entries: list[Entry]) -> dict[str, object]:
    """At the default tolerance: what automatic costs beside each fixed method."""
    at = {method: entry_at(entries, f"FMU {method}") for method in METHODS}
    row: dict[str, object] = {"scene": TITLES[name]}
    for method, e in at.items():
        row[method] = f"{1e6 * e.best:.0f} µs ({number(e.error)})" if e.error is not None else f"failed: {e.note}"
    fixed = {m: e.best for m, e in at.items() if m != "automatic" and e.error is not None}
    if fixed and at["automatic"].error is not None:
        row["automatic over the fastest fixed one"] = at["automatic"].best / min(fixed.values())
        row["fastest fixed one"] = min(fixed, key=lambda m: fixed[m])
    return row


def failed_rows(races: dict[str, list[Entry]]) -> list[dict[str, object]]:
    """One row per set-up, scene and reason, with the tolerances."""
    reasons: dict[tuple[str, str, str], list[float]] = {}
    for entries in races.values():
        for e in entries:
            if e.error is None:
                reasons.setdefault((e.setup, TITLES[e.scene], e.note), []).append(e.tolerance)
    return [
        {"set-up": setup, "scene": scene, "why": note, "tolerances": " to ".join(map(number, sorted({max(t), min(t)})))}
        for (setup, scene, note), t in reasons.items()
    ]


def best_of(master: Master, task: Task, seconds: float = 0.2) -> float:
    done = master.run(task, seconds)
    if not done.reached:
        raise RuntimeError(f"The run stopped after {done.steps} of {task.steps} steps.")
    return done.best


def long_and_general(report: Report) -> None:
    """1000 s of the free wheel; 10 s of one with J_x ≠ J_y"""
    master, Y = master_of(report), report.figures["yardstick"].measured * 1e-6
    long = master.run(Task({}, 1.0, 1000), 0.2)
    report.figure("long", "free wheel, 1000 s, 1000 reads", long.best / Y, "Y", 2)
    report.figure("long_error", "the same: error / range", long_error(report.library), "", 1e-6)
    seconds = best_of(master, Task(SCENES["general inertia"].start, 0.1, 100))
    report.figure("general", "J_x = 0.7, J_y = 1.2 kg m², 10 s", seconds / Y, "Y", 4)


def long_error(library: Library, tolerance: float | None = None) -> float:
    """Error / range of the free wheel over 1000 s, against half a nutation of the reference laid end to end."""
    from orbit.orbit import Halves  # tests/orbit

    times = np.arange(0.05, 1000, 0.73)
    y = Halves(SCENES["free"].wheel, SCENES["free"].motion).read(times)
    psi_dot = y[:, 2] / np.sin(y[:, 0])
    want = np.column_stack([y[:, 6], y[:, 0], y[:, 3] - psi_dot * np.cos(y[:, 0]), psi_dot])
    run = library.simulate([0.0, *times], tolerance)
    return range_error(np.column_stack([run[name][1:] for name in HEADLINE]), want)


def sine_table(steps: int, orders: int, shift: float = 0.0) -> np.ndarray:
    """Values and derivatives of the six inputs for each step of 1 ms, taken `shift` (s) after its start."""
    return np.array([[sines(1e-3 * k + shift, order) for order in range(orders + 1)] for k in range(steps)])


def small_steps(report: Report) -> None:
    """steps of 1 ms: outputs read, inputs that change"""
    master, rows, seconds = master_of(report), [], 0.1 if report.quick else 0.5
    for name in ("free", "friction"):
        task = Task(SCENES[name].start, 1e-3, 10_000)
        each, paces = best_of(master, task, seconds) / 10_000, master.pace(task)
        report.figure(f"step_{name}", f"1 ms steps, four outputs read, {name}", 1e9 * each, "ns", 100)
        rows.append(step_row(f"{name}, inputs never set", each, paces))
        report.figure(f"step_{name}_longest", f"the same: longest single step, {name}", 1e6 * paces.max(), "µs")
    for orders, words in ((0, "held"), (1, "first derivatives")):
        worst = 0.0
        for spin in (2.0, 10.0, 100.0, 300.0):
            values = {"theta_start": 1.4, "phi_dot_start": -spin}
            task = Task(values, 1e-3, 1000, inputs=tuple(SINES), table=sine_table(1000, orders))
            each, paces = best_of(master, task, seconds) / task.steps, master.pace(task)
            worst = max(worst, each) if spin <= 100 else worst
            rows.append(step_row(f"six inputs that change, {words}; {spin:g} rad/s", each, paces))
        what = f"1 ms steps, six inputs that change, {words}, up to 100 rad/s"
        report.figure(f"inputs_{'held' if orders == 0 else 'linear'}", what, 1e6 * worst, "µs", 1.0)
    report.table("steps", rows)


def step_row(name: str, each: float, paces: np.ndarray) -> dict[str, object]:
    """each: seconds per step of the best run; paces: of single steps, measured one by one."""
    tail = float(np.percentile(paces, 99.9))
    return {
        "scene": name,
        "per step, best run, ns": 1e9 * each,
        "median single step, ns": 1e9 * float(np.median(paces)),
        "99.9th percentile, µs": 1e6 * tail,
        "longest, µs": 1e6 * float(paces.max()),
    }


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


def instances(report: Report) -> None:
    """what an instance takes"""
    master, rows = master_of(report), []
    for name in ("free", "friction"):
        task = Task(SCENES[name].start, 0.1, 15)
        alone, crowd = master.run(task, 0.1), master.crowd(task, 200 if report.quick else 2000)
        rows.append(
            {
                "scene": name,
                "memory, KiB": crowd["bytes"] / 1024,
                "create, initialise and free, alone, µs": 1e6 * alone.life,
                "the same, 2000 at once, µs": 1e6 * (crowd["start"] + crowd["end"]),
                "other bits than one alone": crowd["different"],
            }
        )
    report.table("instances", rows)
    worst = {key: max(float(row[key]) for row in rows) for key in rows[0] if key != "scene"}
    memory, life, _, different = worst.values()
    report.figure("memory", "an instance: memory", memory, "KiB", 128)
    report.figure("life", "an instance: create, initialise and free", life, "µs", 10)
    what = "instances with other bits than one alone, stepped in turn by two threads"
    report.figure("different", what, different, "", 0, relation="exactly")
    size = (build_folder() / "wheel.fmu").stat().st_size
    report.figure("archive", "wheel.fmu of this machine alone", size / 1024, "KiB")


def older_release(report: Report) -> None:
    """beside an older version, and the size of the core"""
    task = Task({**SCENES["loaded"].start, "method": "adams"}, 0.1, 100)
    lines = code_lines.of_core()
    revision = report.options.get("against", "")
    report.words["against"] = revision
    asked: float | None = None
    if revision:
        old = older.built(revision)
        then, now = Master(old.fmu, "older"), master_of(report)
        loads = SCENES["loaded"].inputs.derivatives(0.0)[:1]
        task = replace(task, inputs=tuple(SINES), table=np.repeat(loads[None], 100, axis=0))
        times = [(best_of(now, task, 0.1), best_of(then, task, 0.1)) for _ in range(5)]
        ratio = min(a for a, _ in times) / min(b for _, b in times)
        report.figure("loaded", f"smooth loaded scene, CVODE Adams: over {revision}", ratio, "×", 2)
        asked = old.lines
    report.figure("lines", "code lines of equations, solver, wheel, FMI", lines, "", asked)


PARTS: dict[Callable[[Report], None], float] = {
    **{run_race(name): 18.0 for name in TITLES},
    **{compare: 3, long_and_general: 4, small_steps: 14, left_out: 1, instances: 4, older_release: 5},
}
