"""The races of the speed report: every set-up at every tolerance, FMU and peers in turns in one process.

What fails stays in the list with its reason. Time of the FMU: the C master's run of a hundred steps, four outputs read
at each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import exp, log

import numpy as np
from matplotlib.figure import Figure
from support.scenes import SCENES, Scene

from . import plots
from .native import Master, Task
from .peers import peers
from .truth import kept_headline, range_error

POINTS = 101
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


def race(master: Master, name: str, quick: bool) -> list[Entry]:
    """Every set-up at every tolerance, in rounds, so that noise of the machine meets all alike."""
    scene, rounds, seconds = SCENES[name], 1 if quick else 5, 0.004 if quick else 0.01
    want, attempts = kept_headline(scene, POINTS), setups(master, scene)
    entries = []
    for setup in attempts:
        slow = setup.startswith("SciPy") or (name == "stiff law" and setup in ("FMU adams", "FMU runge_kutta"))
        decades = (4, 6, 8, 10) if quick or slow else range(3, 14)
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


LOOKS = {
    **{CPP: (plots.style.VERMILLION, "-", "s"), HEYOKA: (plots.style.GREEN, "-", "^")},
    **{"numbalsoda lsoda": (plots.style.PURPLE, "-", "D"), "numbalsoda dop853": (plots.style.PURPLE, "--", "D")},
    **{OURS: (plots.style.BLUE, "-", "o"), "FMU adams": (plots.style.SKY, "-", "v")},
    **{"FMU bdf": (plots.style.SKY, "--", "<"), "FMU runge_kutta": (plots.style.SKY, ":", ">")},
    **{"SciPy DOP853": (plots.style.GREY, "-", "."), "SciPy LSODA": (plots.style.GREY, "--", ".")},
    **{"SciPy Radau": (plots.style.GREY, ":", "."), "SciPy LSODA, tanh()": (plots.style.ORANGE, "--", ".")},
    **{"SciPy DOP853, tanh()": (plots.style.ORANGE, "-", ".")},
}


def draw(races: dict[str, list[Entry]]) -> Figure:
    """Six sheets, one legend; automatic lies on top, thick and half transparent, so that what it equals shows."""
    figure, axes = plots.sheet(2, (len(races) + 1) // 2, 68)
    shown: dict[str, object] = {}
    for ax, (name, entries) in zip(axes, races.items(), strict=False):
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
    return figure
