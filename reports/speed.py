"""Error against run time beside other solvers, and what a step, an instance and the automatic rule cost.

FMU and peers run in one process, in turns; what fails stays in the table. Time of the FMU: the C master's run of a hundred
steps, four outputs read at each; start and end apart.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import exp, log

import numpy as np
from support.driver import HEADLINE
from support.motion import Library
from support.paths import build_folder
from support.scenes import SCENES, SINES, Scene, sines

from . import code_lines, older, plots
from .native import Master, Task
from .page import Report
from .peers import peers
from .truth import kept_headline, range_error

POINTS, TARGETS = 101, (1e-4, 1e-6, 1e-8)
DEFAULT = 1e-8  # tolerance
METHODS = ("automatic", "adams", "bdf", "runge_kutta")
OURS, CPP, HEYOKA = "FMU automatic", "DOP853 C++", "heyoka"
TITLES = {
    "free": "Free wheel, the paper's scene",
    "friction": "Rolling friction, exact law, s = 0.03 m",
    "general inertia": "J_x = 0.7, J_y = 1.2 kg m²",
    "stiff law": "Regularized friction, ω_s = 1e-6 rad/s",
    "fast rolling": "Fast spin, φ̇ = −60 rad/s",
    "near flat": "Near flat, θ from 30° down to 1°",
}
SLOW = 0.05  # s: what takes longer is measured once


def scene_of(name: str) -> Scene:
    """keep_contact, so that no solver has to know of endings."""
    scene = SCENES[name]
    return replace(scene, start={**scene.start, "keep_contact": True}, duration=max(scene.duration, 1.0))


@dataclass
class Entry:
    """One set-up at one tolerance; seconds of every repetition. error None: not solved, and note says why."""

    scene: str
    setup: str
    tolerance: float
    error: float | None = None
    note: str = ""
    counts: dict[str, int] = field(default_factory=dict)
    seconds: list[float] = field(default_factory=list)

    @property
    def best(self) -> float:
        return min(self.seconds)

    def row(self) -> dict[str, object]:
        solved = self.error is not None
        times = {"best_us": 1e6 * self.best, "median_us": 1e6 * float(np.median(self.seconds))} if solved else {}
        keys = ("steps", "rhs", "events")
        return {
            **{"scene": self.scene, "setup": self.setup, "tolerance": self.tolerance, "error": self.error},
            **{key: times.get(key) for key in ("best_us", "median_us")},
            **{key: self.counts.get(key) for key in keys},
            "note": self.note,
        }


Attempt = Callable[[float, float], tuple[list[float], np.ndarray, dict[str, int]]]  # tolerance, seconds


def by_fmu(master: Master, scene: Scene, method: str) -> Attempt:
    def attempt(tolerance: float, seconds: float) -> tuple[list[float], np.ndarray, dict[str, int]]:
        values = {**scene.start, "method": method}
        done = master.run(Task(values, scene.duration / (POINTS - 1), POINTS - 1, tolerance), seconds)
        if not done.reached:
            raise RuntimeError(f"stopped with status {done.status} after {done.steps} of {POINTS - 1} steps")
        return done.times[:, 1].tolist(), done.rows, {k[2:]: v for k, v in done.counters.items()}

    return attempt


def by_peer(scene: Scene, make: Callable) -> Attempt:
    def attempt(tolerance: float, seconds: float) -> tuple[list[float], np.ndarray, dict[str, int]]:
        peer = make(scene, tolerance, POINTS)
        peer.solve()  # compiles, warms up
        times = [peer.solve()]
        while sum(times) < seconds:
            times.append(peer.solve())
        return times, peer.rows(), peer.counts()

    return attempt


def setups(master: Master, scene: Scene) -> dict[str, Attempt]:
    found = {f"FMU {method}": by_fmu(master, scene, method) for method in METHODS}
    return found | {name: by_peer(scene, make) for name, make in peers(scene).items()}


def try_once(entry: Entry, attempt: Attempt, seconds: float, want: np.ndarray) -> None:
    try:
        times, rows, entry.counts = attempt(entry.tolerance, seconds)
    except (RuntimeError, ImportError, ValueError, ArithmeticError) as trouble:
        entry.note = str(trouble).split("\n")[0]
        return
    error = range_error(rows, want)
    entry.error, entry.note = (error, "") if np.isfinite(error) else (None, "no finite result")
    entry.seconds += times


def race(report: Report, name: str) -> list[Entry]:
    """Every set-up at every tolerance, in rounds, so that noise of the machine meets all alike."""
    scene, rounds, seconds = scene_of(name), 1 if report.quick else 5, 0.004 if report.quick else 0.01
    want, attempts = kept_headline(scene, POINTS), setups(master_of(report), scene)
    entries = []
    for setup in attempts:
        slow = setup.startswith("SciPy")
        decades = (4, 6, 8, 10) if report.quick or slow else range(3, 14)
        entries += [Entry(name, setup, 10.0**-k) for k in decades]
    for turn in range(rounds):
        for entry in entries:
            failed = turn and entry.error is None
            if failed or (turn and entry.best > SLOW) or hopeless(entries, entry):
                continue
            try_once(entry, attempts[entry.setup], seconds, want)
    return entries


def hopeless(entries: list[Entry], entry: Entry) -> bool:
    """A set-up that failed at a looser tolerance is not asked again: it is missing, or takes too long."""
    looser = [e for e in entries if e.setup == entry.setup and e.tolerance > entry.tolerance and e.note]
    if looser and entry.error is None and not entry.setup.startswith("FMU"):
        entry.note = looser[0].note
    return bool(looser) and entry.error is None and not entry.setup.startswith("FMU")


def frontier(entries: list[Entry], setup: str) -> list[tuple[float, float]]:
    """(error, best time) of what solved, errors falling; a point that another beats in both is left out."""
    points = sorted((e.error, e.best) for e in entries if e.setup == setup and e.error is not None)
    kept: list[tuple[float, float]] = []
    for error, seconds in points:
        if not kept or seconds < kept[-1][1]:
            kept.append((error, seconds))
    return kept[::-1]


def time_at(entries: list[Entry], setup: str, error: float) -> float:
    """Seconds to this error or a smaller one, by lines through log(time) over log(error); nan out of reach."""
    points = frontier(entries, setup)
    if points and points[0][0] <= error:
        return points[0][1]
    for (e_0, t_0), (e_1, t_1) in zip(points, points[1:], strict=False):
        if e_1 <= error <= e_0:
            share = (log(e_0) - log(error)) / (log(e_0) - log(e_1))
            return exp(log(t_0) + share * (log(t_1) - log(t_0)))
    return np.nan


def entry_at(entries: list[Entry], setup: str, tolerance: float = DEFAULT) -> Entry:
    return next(e for e in entries if e.setup == setup and np.isclose(e.tolerance, tolerance, rtol=1e-6, atol=0))


MASTERS: dict[int, Master] = {}
RACES: dict[str, list[Entry]] = {}


def master_of(report: Report) -> Master:
    return MASTERS.setdefault(id(report), Master(build_folder() / "wheel.fmu"))


def run_race(name: str) -> Callable[[Report], None]:
    def part(report: Report) -> None:
        RACES[name] = race(report, name)

    part.__doc__ = f"error against run time: {TITLES[name]}"
    return part


def compare(report: Report) -> None:
    """The races side by side: figures, tables, picture."""
    report.table("runs", [e.row() for entries in RACES.values() for e in entries])
    report.table("fastest", [fastest_row(name, entries) for name, entries in RACES.items()])
    report.table("methods", [row for name, entries in RACES.items() for row in method_rows(name, entries)])
    report.table("failed", failed_rows())
    free, friction = RACES["free"], RACES["friction"]
    Y = time_at(free, HEYOKA, 1e-6)
    report.figure("yardstick", "Y: heyoka, paper's free wheel, 10 s, error 1e-6", 1e6 * Y, "µs")
    ours = {name: entry_at(RACES[name], OURS) for name in ("free", "friction")}
    report.figure("free", "free wheel, 10 s, 100 reads", ours["free"].best / Y, "Y", 0.7)
    for error in TARGETS:
        for peer, key in ((HEYOKA, "heyoka"), (CPP, "dop853")):
            ratio = time_at(free, OURS, error) / time_at(free, peer, error)
            report.figure(f"free_{key}_{-log10(error)}", f"free wheel at error {error:.0e}: over {peer}", ratio, "×", 1)
    report.figure("friction", "friction wheel, 10 s", ours["friction"].best / Y, "Y", 2.5)
    theirs = time_at(friction, CPP, ours["friction"].error or 1e-8)
    ratio = ours["friction"].best / theirs
    report.figure("friction_dop853", f"friction wheel at the same error: over {CPP}", ratio, "×", 1.25)
    for name, entry in ours.items():
        report.figure(f"{name}_time", f"{name} wheel, 10 s", 1e6 * entry.best, "µs")
        report.figure(f"{name}_error", f"{name} wheel, 10 s: error / range", entry.error or np.inf)
    draw(report)


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
        row[f"fastest at {error:.0e} (FMU over {CPP}, heyoka)"] = f"{best} ({', '.join(ratios) or 'no peer'})"
    return row


def method_rows(name: str, entries: list[Entry]) -> list[dict[str, object]]:
    """At the default tolerance: what automatic costs beside each fixed method."""
    at = {method: entry_at(entries, f"FMU {method}") for method in METHODS}
    row: dict[str, object] = {"scene": TITLES[name]}
    for method, e in at.items():
        row[method] = f"{1e6 * e.best:.0f} µs ({e.error:.0e})" if e.error is not None else f"failed: {e.note}"
    fixed = {m: e.best for m, e in at.items() if m != "automatic" and e.error is not None}
    if fixed and at["automatic"].error is not None:
        row["automatic over the fastest fixed one"] = at["automatic"].best / min(fixed.values())
        row["fastest fixed one"] = min(fixed, key=lambda m: fixed[m])
    return [row]


def failed_rows() -> list[dict[str, object]]:
    """One row per set-up, scene and reason, with the tolerances."""
    reasons: dict[tuple[str, str, str], list[float]] = {}
    for entries in RACES.values():
        for e in entries:
            if e.error is None:
                reasons.setdefault((e.setup, TITLES[e.scene], e.note), []).append(e.tolerance)
    return [
        {"set-up": setup, "scene": scene, "why": note, "tolerances": f"{max(t):.0e} to {min(t):.0e}"}
        for (setup, scene, note), t in reasons.items()
    ]


LOOKS = {
    **{CPP: (plots.style.VERMILLION, "-", "s"), HEYOKA: (plots.style.GREEN, "-", "^")},
    **{"numbalsoda lsoda": (plots.style.PURPLE, "-", "D"), "numbalsoda dop853": (plots.style.PURPLE, "--", "D")},
    **{OURS: (plots.style.BLUE, "-", "o"), "FMU adams": (plots.style.SKY, "-", "v")},
    **{"FMU bdf": (plots.style.SKY, "--", "<"), "FMU runge_kutta": (plots.style.SKY, ":", ">")},
    **{"SciPy DOP853": (plots.style.GREY, "-", "."), "SciPy LSODA": (plots.style.GREY, "--", ".")},
    **{"SciPy Radau": (plots.style.GREY, ":", "."), "SciPy LSODA, tanh()": (plots.style.ORANGE, "--", ".")},
    **{"SciPy DOP853, tanh()": (plots.style.ORANGE, "-", ".")},
}


def draw(report: Report) -> None:
    """Six sheets, one legend; automatic lies on top, thick and half transparent, so that what it equals shows."""
    figure, axes = plots.sheet(2, (len(RACES) + 1) // 2, 68)
    shown: dict[str, object] = {}
    for ax, (name, entries) in zip(axes, RACES.items(), strict=False):
        for setup in dict.fromkeys(e.setup for e in entries):
            points = [(1e6 * e.best, max(e.error, 1e-14)) for e in entries if e.setup == setup and e.error is not None]
            if not points:
                continue
            colour, line, marker = LOOKS.get(setup, (plots.style.INK, "-", "x"))
            ours = setup == OURS
            look = {"lw": 3.5 if ours else 1, "alpha": 0.55 if ours else 1, "ms": 5 if ours else 3}
            (curve,) = ax.plot(*zip(*points, strict=True), color=colour, ls=line, marker=marker, label=setup, **look)
            shown.setdefault(setup, curve)
        plots.label(ax, "best time [µs]", "error / range", TITLES[name], "xy")
        ax.set_ylim(1e-14, 3)
    figure.legend(list(shown.values()), list(shown), loc="outside lower center", ncols=4)
    report.picture("races", figure)


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
    general = {**SCENES["general inertia"].start, "keep_contact": True}
    seconds = best_of(master, Task(general, 0.1, 100))
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
            values = {"theta_start": 1.4, "phi_dot_start": -spin, "keep_contact": True}
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
    **{compare: 3, long_and_general: 4, small_steps: 14, instances: 4, older_release: 5},
}
