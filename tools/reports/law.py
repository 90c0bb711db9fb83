"""The regularized law -s N tanh(omega_z / omega_s) against the exact one, and where its layer pays, for `stability`."""

from __future__ import annotations

from robustness.case import similar
from robustness.regularized import (
    FRICTION,
    THRESHOLD,
    TIMES,
    TOLERANCE_FACTOR,
    WIDTH_FACTOR,
    decay_number,
    error_against,
    is_layered,
)
from support.driver import Values
from support.motion import run

from . import plots
from .page import Report, Row, Tables, number, part
from .plots import Sheet, style

METHODS = ("automatic", "bdf")
SCENES: dict[str, tuple[Values, float]] = {
    "the paper's, 10 s": (FRICTION, 10.0),
    "the paper's, 60 s": (FRICTION, 60.0),
    "a tenth of the size": ({**similar(0.1), "s": 0.003}, 10.0 * 0.1**0.5),
    "multibody": ({**FRICTION, "formulation": "multibody"}, 10.0),
    "light friction": ({"s": 0.003}, 10.0),
}


def best_time(report: Report, values: Values, tolerance: float, duration: float, repeats: int = 5) -> float:
    """Least time of one large doStep, ms."""
    solve = report.master.made(values, duration, 1, tolerance)
    return 1e3 * min(solve()[0] for _ in range(repeats))


def regularized(values: Values, omega_s: float, method: str) -> Values:
    return {**values, "friction_law": "regularized", "omega_s": omega_s, "method": method}


@part(
    15, {"tolerance": (1e-4, 1e-6, 1e-8), "omega_s, rad/s": (0.0, *(10.0**-k for k in range(1, 9))), "method": METHODS}
)
def law(report: Report, tolerance: float, omega_s: float, method: str) -> Row:
    """the regularized law in the paper's friction scene; omega_s = 0: the exact law"""
    values = regularized(FRICTION, omega_s, method) if omega_s else FRICTION
    truth, found = (run(report.library, v, TIMES, t) for v, t in ((FRICTION, 1e-12), (values, tolerance)))
    cost, error = best_time(report, values, tolerance, TIMES[-1]), error_against(truth, found)
    row = {"error": error, "ms": cost, "steps": found.counters["n_steps"]}
    return row | ({"error / bound": error / (WIDTH_FACTOR * omega_s + TOLERANCE_FACTOR * tolerance)} if omega_s else {})


def draw_law(tables: Tables) -> Sheet:
    figure, axes = plots.sheet(2)
    for colour, (tolerance, points) in zip(plots.COLOURS, tables["law"].groupby("tolerance", sort=False), strict=False):
        for method, marker in zip(METHODS, ("o-", "x--"), strict=True):
            chain = points[(points["omega_s, rad/s"] > 0) & (points["method"] == method)]
            words = f"{method}, tolerance {number(tolerance)}"
            for ax, x in zip(axes, ("omega_s, rad/s", "ms"), strict=True):
                ax.plot(chain[x], chain["error"], marker, color=colour, ms=4, lw=0.8, label=words)
        exact = points[points["omega_s, rad/s"] == 0]
        axes[1].plot(exact["ms"], exact["error"], "*", color=colour, ms=10)
    plots.label(axes[0], r"$\omega_s$ [rad/s]", "error against the exact law", "convergence", "xy")
    plots.label(axes[1], "time for 10 s [ms]", "error", "cost; stars: the exact law itself", "xy")
    plots.legend_below(figure, axes, 3)
    return figure


@part(15, {"scene": SCENES, "omega_s, rad/s": (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)})
def crossings(report: Report, scene: tuple[Values, float], omega_s: float) -> Row:
    """where the layer pays: times of DOP853 and of BDF over that of automatic, for each scene and width"""
    values, duration = scene
    laws = [regularized(values, omega_s, method) for method in ("automatic", "runge_kutta", "bdf")]
    automatic, dop853, bdf = (best_time(report, law, 1e-6, duration, 3) for law in laws)
    ratios = {"DOP853 over automatic": dop853 / automatic, "BDF over automatic": bdf / automatic}
    ratios["automatic over the better"] = max(automatic / min(dop853, bdf), 1.0)
    return {"decay number": decay_number(laws[0]), **ratios, "in layers": is_layered(report.library, laws[0])}


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
