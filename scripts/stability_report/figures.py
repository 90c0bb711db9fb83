"""The figures of the stability report. Drawn from the results alone; small PNG files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from plotting import style
from robustness.drift import Drift
from robustness.long_runs import LongRun
from robustness.regularized import Crossing, Point
from robustness.verdicts import TOLERANCES, Verdict

DPI = 110
COLOURS = (style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY)
LEAST = 1e-17  # drawn in place of zero


def sheet(columns: int, height: float = 70.0) -> tuple[Figure, list[Axes]]:
    fig = style.figure_mm(88.0 * columns, height)
    fig.set_layout_engine("constrained")
    axes = fig.subplots(1, columns, squeeze=False)[0]
    return fig, list(axes)


def save(fig: Figure, path: Path) -> None:
    fig.savefig(path, dpi=DPI, metadata={"Software": None})


def loglog(ax: Axes, x: str, y: str, title: str) -> None:
    ax.set(xscale="log", yscale="log", xlabel=x, ylabel=y)
    ax.set_title(title, fontsize=9, loc="left")
    ax.grid(alpha=0.25, linewidth=0.4)


def seen_error(verdict: Verdict, judge: str) -> float:
    """nan where the judge itself sees no further, or nothing is claimed."""
    found = next((f for f in verdict.errors if f.judge == judge and verdict.claimed), None)
    return found.error if found and found.error > 2 * found.floor else float("nan")


def draw_sweep(results: dict[str, list[Verdict]], path: Path) -> None:
    """Every judge's error over the tolerance, one line per case; the dashed line is error = tolerance."""
    fig, axes = sheet(2)
    titles = {"energy": "energy balance", "reference": "outputs against the independent reference"}
    for ax, (judge, title) in zip(axes, titles.items(), strict=True):
        for name, verdicts in results.items():
            errors = [seen_error(v, judge) for v in verdicts]
            hard = name.startswith(("brushing", "friction: s = 1", "past upright: theta = 170"))
            look = {"color": style.VERMILLION if hard else style.BLUE, "alpha": 0.6, "linewidth": 0.8}
            ax.plot(TOLERANCES, np.maximum(errors, LEAST), marker=".", markersize=3, **look)
        ax.plot(TOLERANCES, TOLERANCES, "--", color=style.INK, linewidth=0.8)
        loglog(ax, "tolerance asked for", "relative error", title)
        ax.invert_xaxis()
    style.note(axes[1], "dashed: error = tolerance", (1e-4, 1e-11), (4, 0))
    style.note(axes[1], "red: grazing the ground, s of 1 m and more", (1e-4, 1e-12), (4, 0), color=style.VERMILLION)
    save(fig, path)


def draw_regularized(points: list[Point], path: Path) -> None:
    """Left: error over omega_s; right: error over run time, with the exact law for comparison."""
    fig, axes = sheet(2)
    for colour, tolerance in zip(COLOURS, sorted({p.tolerance for p in points}, reverse=True), strict=False):
        for method, marker in (("bdf", "o"), ("adams", "x")):
            chain = [p for p in points if p.tolerance == tolerance and p.method == method and p.law == "regularized"]
            label = f"{method.upper() if method == 'bdf' else 'Adams'}, tolerance {tolerance:g}"
            look = {"color": colour, "marker": marker, "markersize": 4, "linewidth": 0.8, "label": label}
            axes[0].plot([p.omega_s for p in chain], [p.error for p in chain], **look)
            axes[1].plot([p.milliseconds for p in chain], [p.error for p in chain], **look)
        exact = next(p for p in points if p.tolerance == tolerance and p.law == "exact")
        axes[1].plot(exact.milliseconds, exact.error, "*", color=colour, markersize=10)
    widths = np.array([1e-8, 1e-1])
    axes[0].plot(widths, 3 * widths, "--", color=style.GREY, linewidth=0.8)
    style.note(axes[0], "first order", (1e-7, 3e-7), (8, -8), color=style.GREY)
    loglog(axes[0], r"$\omega_s$ [rad/s]", "error against the exact law", "convergence")
    loglog(axes[1], "run time for 10 s [ms]", "error against the exact law", "cost; stars: the exact law itself")
    axes[0].legend(fontsize=6.5)
    save(fig, path)


def draw_crossings(found: list[Crossing], threshold: float, path: Path) -> None:
    """Time of Adams over time of BDF; above 1 BDF pays. Filled: what method = automatic takes is BDF."""
    fig, (ax,) = sheet(1)
    for colour, scene in zip(COLOURS, dict.fromkeys(c.scene for c in found), strict=False):
        chain = [c for c in found if c.scene == scene]
        ax.plot([c.decay for c in chain], [c.ratio for c in chain], color=colour, linewidth=0.8, label=scene)
        for c in chain:
            ax.plot(c.decay, c.ratio, "o", color=colour, markersize=4, mfc=colour if c.chosen == "bdf" else "white")
    ax.axhline(1, color=style.INK, linewidth=0.8, linestyle="--")
    ax.axvline(threshold, color=style.GREY, linewidth=0.8, linestyle=":")
    loglog(
        ax,
        "decay rate of the spin times the wheel's time",
        "time of Adams / time of BDF",
        "filled: automatic takes BDF",
    )
    ax.legend(fontsize=6.5)
    save(fig, path)


def draw_long(runs: list[LongRun], path: Path) -> None:
    """Cost per simulated second, energy change over energy, transitions per second; over time."""
    fig, axes = sheet(3, 60.0)
    for colour, r in zip(COLOURS, runs, strict=False):
        hours = r.times[1:] / 3600
        axes[0].plot(hours, r.cost[1:], color=colour, label=r.name, linewidth=0.8)
        if "friction" not in r.name:
            axes[1].plot(hours, np.abs(r.energy[1:] / r.energy[0] - 1), color=colour, linewidth=0.8)
        else:
            axes[2].plot(hours, np.diff(r.events) / np.diff(r.times), color=colour, linewidth=0.8, label=r.name)
    labels = ("cost [us per simulated second]", "change of energy / energy, no friction", "transitions per second")
    for ax, label in zip(axes, labels, strict=True):
        ax.set(xlabel="t [h]", ylabel=label, xscale="log")
        ax.grid(alpha=0.25, linewidth=0.4)
    axes[0].set_ylim(0, None)
    axes[2].set_ylim(0, 8)
    axes[1].set_yscale("log")
    axes[0].legend(fontsize=6.5)
    axes[2].legend(fontsize=6.5)
    save(fig, path)


def draw_drift(drifts: list[Drift], path: Path) -> None:
    """Residual of the rolling condition over time as a share of the run."""
    fig, (ax,) = sheet(1, 80.0)
    for i, d in enumerate(drifts):
        share = d.t / d.t[-1]
        style_of = "-" if "1 h" in d.name else "--"
        residual = np.maximum(np.maximum(d.velocity, d.height), LEAST)
        ax.plot(share, residual, style_of, color=COLOURS[i % len(COLOURS)], linewidth=0.7, label=d.name)
    ax.axhline(1e-9, color=style.INK, linewidth=0.8, linestyle=":")
    ax.set(yscale="log", xlabel="share of the run", ylabel="relative constraint residual")
    fig.legend(loc="outside lower center", fontsize=6, ncols=2)
    save(fig, path)
