"""The regularized law -s N tanh(omega_z / omega_s) against the exact one, and where BDF pays; a part of `stability`."""

from __future__ import annotations

from robustness import regularized
from robustness.regularized import TOLERANCE_FACTOR, WIDTH_FACTOR

from . import plots
from .page import Report, number
from .plots import style

THRESHOLD = 200.0  # decay number from which the automatic rule takes BDF: `stiff` in fmu-src/wheel/scene.cpp


def law(report: Report) -> None:
    """the regularized law"""
    points = regularized.study(report.library)
    rows = [
        {
            "law": p.law,
            "method": p.method,
            "tolerance": p.tolerance,
            "omega_s, rad/s": p.omega_s or "",
            "error": p.error,
            "ms": p.milliseconds,
            "steps": p.steps,
        }
        for p in points
    ]
    report.table("law", rows)
    bound = max(
        p.error / (WIDTH_FACTOR * p.omega_s + TOLERANCE_FACTOR * p.tolerance) for p in points if p.law != "exact"
    )
    what = f"regularized law: error over {WIDTH_FACTOR:g} ω_s + {TOLERANCE_FACTOR:g} tolerance"
    report.figure("law", what, bound, "", 1)
    figure, axes = plots.sheet(2)
    for colour, tolerance in zip(plots.COLOURS, regularized.TOLERANCES, strict=False):
        for method, marker in (("bdf", "o-"), ("adams", "x--")):
            chain = [p for p in points if (p.tolerance, p.method) == (tolerance, method) and p.law != "exact"]
            for ax, x in zip(axes, ("omega_s", "milliseconds"), strict=True):
                values = [getattr(p, x) for p in chain]
                words = f"{method}, tolerance {number(tolerance)}"
                ax.plot(values, [p.error for p in chain], marker, color=colour, ms=4, lw=0.8, label=words)
        exact = next(p for p in points if p.tolerance == tolerance and p.law == "exact")
        axes[1].plot(exact.milliseconds, exact.error, "*", color=colour, ms=10)
    plots.label(axes[0], r"$\omega_s$ [rad/s]", "error against the exact law", "convergence", "xy")
    plots.label(axes[1], "time for 10 s [ms]", "error", "cost; stars: the exact law itself", "xy")
    plots.legend_below(figure, axes[0], 3)
    report.picture("law", figure)


def crossings(report: Report) -> None:
    """where BDF pays"""
    found = regularized.crossings(report.library)
    names = ("scene", "decay number", "Adams over BDF", "automatic takes")
    report.table("crossings", [dict(zip(names, (c.scene, c.decay, c.ratio, c.chosen), strict=True)) for c in found])
    lost = [max(c.ratio, 1 / c.ratio) for c in found if (c.chosen == "bdf") != (c.ratio > 1)]
    report.figure("wrong_method", "automatic's time over the better method's, at worst", max(lost, default=1.0), "×")
    figure, (ax,) = plots.sheet(1)
    for colour, scene in zip(plots.COLOURS, dict.fromkeys(c.scene for c in found), strict=False):
        chain = [c for c in found if c.scene == scene]
        ax.plot([c.decay for c in chain], [c.ratio for c in chain], color=colour, lw=0.8, label=scene)
        for c in chain:
            ax.plot(c.decay, c.ratio, "o", color=colour, ms=5, mfc=colour if c.chosen == "bdf" else "white")
    ax.axhline(1, color=style.INK, lw=0.8, ls="--")
    ax.axvline(THRESHOLD, color=style.GREY, lw=0.9, ls=":", label=f"the rule's threshold, {THRESHOLD:g}")
    ax.legend()
    title = "above 1 BDF is faster; filled: automatic takes BDF"
    plots.label(ax, "decay rate of the spin times the wheel's time", "time of Adams / time of BDF", title, "xy")
    report.picture("methods", figure)
