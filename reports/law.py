"""The regularized law -s N tanh(omega_z / omega_s) against the exact one, and where its layer pays, for `stability`."""

from __future__ import annotations

import pandas as pd
from robustness import regularized
from robustness.regularized import THRESHOLD, TOLERANCE_FACTOR, WIDTH_FACTOR

from . import plots
from .page import Report, Sheet, Tables, number
from .plots import style


def law(report: Report) -> None:
    """the regularized law"""
    points = pd.DataFrame(regularized.study(report.library)).drop(columns="rhs")
    report.table("law", points.rename(columns={"omega_s": "omega_s, rad/s", "milliseconds": "ms"}))
    found = points[points["law"] != "exact"]
    bound = found["error"] / (WIDTH_FACTOR * found["omega_s"] + TOLERANCE_FACTOR * found["tolerance"])
    what = f"regularized law: error over {WIDTH_FACTOR:g} ω_s + {TOLERANCE_FACTOR:g} tolerance"
    report.figure("law", what, bound.max(), "", 1)


def draw_law(tables: Tables) -> Sheet:
    figure, axes = plots.sheet(2)
    for colour, (tolerance, points) in zip(plots.COLOURS, tables["law"].groupby("tolerance", sort=False), strict=False):
        for method, marker in (("automatic", "o-"), ("bdf", "x--")):
            chain = points.query("law != 'exact' and method == @method")
            words = f"{method}, tolerance {number(tolerance)}"
            for ax, x in zip(axes, ("omega_s, rad/s", "ms"), strict=True):
                ax.plot(chain[x], chain["error"], marker, color=colour, ms=4, lw=0.8, label=words)
        exact = points.query("law == 'exact'")
        axes[1].plot(exact["ms"], exact["error"], "*", color=colour, ms=10)
    plots.label(axes[0], r"$\omega_s$ [rad/s]", "error against the exact law", "convergence", "xy")
    plots.label(axes[1], "time for 10 s [ms]", "error", "cost; stars: the exact law itself", "xy")
    plots.legend_below(figure, axes[0], 3)
    return figure


def crossings(report: Report) -> None:
    """where the layer pays"""
    found = pd.DataFrame(regularized.crossings(report.library))
    lost = 1 / found[["runge_kutta", "bdf"]].min(axis=1)
    names = {"decay": "decay number", "runge_kutta": "DOP853 over automatic", "bdf": "BDF over automatic"}
    report.table("crossings", found.rename(columns=names | {"layered": "in layers"}))
    report.figure(
        "wrong_method", "automatic's time over the better fixed method's, at worst", max(lost.max(), 1.0), "×"
    )


def draw_methods(tables: Tables) -> Sheet:
    figure, (ax,) = plots.sheet(1)
    for colour, (scene, chain) in zip(plots.COLOURS, tables["crossings"].groupby("scene", sort=False), strict=False):
        x, ratio, layered = chain["decay number"], chain["DOP853 over automatic"], chain["in layers"]
        ax.plot(x, ratio, "o-", color=colour, lw=0.8, ms=5, mfc="white", label=scene)
        ax.plot(x[layered], ratio[layered], "o", color=colour, ms=5)
    ax.axhline(1, color=style.INK, lw=0.8, ls="--")
    ax.axvline(THRESHOLD, color=style.GREY, lw=0.9, ls=":", label=f"the rule's threshold, {THRESHOLD:g}")
    ax.legend()
    title = "above 1 automatic is faster; filled: it takes the law for stiff"
    plots.label(ax, "decay rate of the spin times the wheel's time", "time of DOP853 / time of automatic", title, "xy")
    return figure
