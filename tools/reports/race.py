"""The races of the speed report: every set-up at every tolerance, FMU and peers in turns in one process.

What fails stays in the list with its reason. Time of the FMU: the C master's run of a hundred steps, four outputs read
at each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from math import exp, log

import numpy as np
import pandas as pd
from support.scenes import SCENES, Scene

from . import plots
from .native import Array, Master, Task
from .page import Row, Tables
from .peers import Peer, peers
from .plots import Sheet
from .truth import kept_headline, range_error

POINTS = 101
METHODS = ("automatic", "adams", "bdf", "runge_kutta")
OURS, CPP, HEYOKA = "FMU automatic", "DOP853 C++", "heyoka"
TITLES = {
    "free": "Free wheel, the paper's scene, 10 s",
    "friction": "Rolling friction, exact law, s = 0.03 m, 10 s",
    "general inertia": "J_x = 0.7, J_y = 1.2 kg m², 5 s",
    "stiff law": "Regularized friction, ω_s = 1e-6 rad/s, 10 s",
    "fast rolling": "Fast spin, φ̇ = −60 rad/s, 1 s",
    "near flat": "Near flat, θ from 30° down to 1°, 2 s",
}
SLOW = 0.05  # s: what takes longer is measured once
Attempt = Callable[[float, float], tuple[list[float], Array, dict[str, int]]]  # tolerance, seconds


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

    def row(self) -> Row:
        micro = 1e6 * np.array(self.seconds or [np.nan])
        counts = {key: self.counts.get(key) for key in ("steps", "rhs", "events")}
        head = {"scene": self.scene, "setup": self.setup, "tolerance": self.tolerance, "error": self.error}
        return {**head, "best_us": micro.min(), "median_us": np.median(micro), **counts, "note": self.note}


def by_fmu(master: Master, scene: Scene, method: str) -> Attempt:
    def attempt(tolerance: float, seconds: float) -> tuple[list[float], Array, dict[str, int]]:
        values = {**scene.start, "method": method}
        done = master.run(Task(values, scene.duration / (POINTS - 1), POINTS - 1, tolerance), seconds)
        if not done.reached:
            raise RuntimeError(f"stopped with status {done.status} after {done.steps} of {POINTS - 1} steps")
        return done.costs[:, 1].tolist(), done.rows, {k[2:]: v for k, v in done.counters.items()}

    return attempt


def by_peer(scene: Scene, make: Callable) -> Attempt:
    @cache
    def made(tolerance: float) -> Peer:
        solve, outputs = make(scene, tolerance, POINTS)
        solve()  # compiles, warms up
        return solve, outputs

    def attempt(tolerance: float, seconds: float) -> tuple[list[float], Array, dict[str, int]]:
        solve, outputs = made(tolerance)
        times: list[float] = []
        while not times or sum(times) < seconds:
            spent, states, counts = solve()
            times.append(spent)
        return times, outputs(states), counts

    return attempt


def try_once(entry: Entry, attempt: Attempt, seconds: float, want: Array) -> None:
    try:
        times, rows, entry.counts = attempt(entry.tolerance, seconds)
    except (RuntimeError, ImportError, ValueError, ArithmeticError) as trouble:
        entry.note = str(trouble).split("\n")[0]
        return
    error = range_error(rows, want)
    entry.error, entry.note = (error, "") if np.isfinite(error) else (None, "no finite result")
    entry.seconds += times


def race(master: Master, name: str, quick: bool) -> list[Row]:
    """Every set-up at every tolerance, in rounds, so that noise of the machine meets all alike.

    A peer that failed at a looser tolerance is not asked again: it is missing, or takes too long.
    """
    scene, rounds, seconds = SCENES[name], 1 if quick else 5, 0.004 if quick else 0.01
    want = kept_headline(scene, POINTS)
    attempts = {f"FMU {method}": by_fmu(master, scene, method) for method in METHODS}
    attempts |= {peer: by_peer(scene, make) for peer, make in peers(scene).items()}
    entries: list[Entry] = []
    for setup in attempts:
        slow = setup.startswith("SciPy") or (name == "stiff law" and setup in ("FMU adams", "FMU runge_kutta"))
        decades = (4, 6, 8, 10) if quick or slow else range(3, 14)
        entries += [Entry(name, setup, 10.0**-k) for k in decades]
    for turn in range(rounds):
        reasons: dict[str, str] = {}
        for entry in entries:
            entry.note = entry.note or reasons.get(entry.setup, "")
            if not entry.note and not (turn and min(entry.seconds) > SLOW):
                try_once(entry, attempts[entry.setup], seconds, want)
            if entry.note and not entry.setup.startswith("FMU"):
                reasons[entry.setup] = entry.note
    return [entry.row() for entry in entries]


def time_at(runs: pd.DataFrame, setup: str, error: float) -> float:
    """Seconds to this error or a smaller one, by lines through log(time) over log(error); nan out of reach.

    A run that another one beats in both is left out.
    """
    points = runs[(runs["setup"] == setup) & runs["error"].notna()].sort_values(["error", "best_us"])
    points = points[points["best_us"] < points["best_us"].cummin().shift(fill_value=np.inf)]
    if points.empty:
        return np.nan
    line = np.log(points[["error", "best_us"]].to_numpy(float)).T
    return 1e-6 * exp(np.interp(log(error), *line, left=np.nan))


def at_default(runs: pd.DataFrame, setup: str) -> pd.Series:
    """The run at the FMU's default tolerance."""
    return runs[(runs["setup"] == setup) & np.isclose(runs["tolerance"], 1e-8, rtol=1e-6, atol=0)].iloc[0]


LOOKS = {
    **{CPP: (plots.style.VERMILLION, "-", "s"), HEYOKA: (plots.style.GREEN, "-", "^")},
    **{"numbalsoda lsoda": (plots.style.PURPLE, "-", "D"), "numbalsoda dop853": (plots.style.PURPLE, "--", "D")},
    **{OURS: (plots.style.BLUE, "-", "o"), "FMU adams": (plots.style.SKY, "-", "v")},
    **{"FMU bdf": (plots.style.SKY, "--", "<"), "FMU runge_kutta": (plots.style.SKY, ":", ">")},
    **{"SciPy DOP853": (plots.style.GREY, "-", "."), "SciPy LSODA": (plots.style.GREY, "--", ".")},
    **{"SciPy Radau": (plots.style.GREY, ":", "."), "SciPy LSODA, tanh()": (plots.style.ORANGE, "--", ".")},
    **{"SciPy DOP853, tanh()": (plots.style.ORANGE, "-", ".")},
}


def draw_races(tables: Tables) -> Sheet:
    """A sheet for each scene, one legend; automatic lies on top, half transparent, so that what it equals shows."""
    figure, axes = plots.sheet(2, -(-len(TITLES) // 2), 68)
    shown: dict[str, object] = {}
    for ax, (scene, title) in zip(axes, TITLES.items(), strict=False):
        runs = tables["runs"]
        solved = runs[(runs["scene"] == scene) & runs["error"].notna()]
        for setup, points in solved.groupby("setup", sort=False):
            colour, line, marker = LOOKS.get(setup, (plots.style.INK, "-", "x"))
            look = {"lw": 3.5, "alpha": 0.55, "ms": 5} if setup == OURS else {"lw": 1, "ms": 3}
            x, y = points["best_us"], points["error"].clip(lower=1e-14)
            (curve,) = ax.plot(x, y, color=colour, ls=line, marker=marker, label=setup, **look)
            shown.setdefault(setup, curve)
        plots.label(ax, "best time [µs]", "error / range", title, "xy")
        ax.set_ylim(1e-14, 3)
    figure.legend(list(shown.values()), list(shown), loc="outside lower center", ncols=4)
    return figure
