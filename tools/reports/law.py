"""The regularized law -s N tanh(omega_z / omega_s) against the exact one, and where its layer pays, for `stability`."""

from __future__ import annotations

from time import perf_counter

import pandas as pd
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
from support.motion import Library, Run, run

from . import plots
from .page import Report, Row, Tables, number, part
from .plots import Sheet, style

WIDTHS = tuple(10.0**-k for k in range(1, 9))
TOLERANCES = (1e-4, 1e-6, 1e-8)
REPEATS = 5


def best_time(library: Library, values: Values, tolerance: float, duration: float, repeats: int = REPEATS) -> float:
    """Least time of one large doStep, ms."""
    best = float("inf")
    for _ in range(repeats):
        with library.wheel() as wheel:
            wheel.set(**values)
            wheel.initialise(tolerance)
            before = perf_counter()
            wheel.step_to(duration)
            best = min(best, perf_counter() - before)
    return 1e3 * best


def point(library: Library, truth: Run, tolerance: float, omega_s: float, **law: str) -> Row:
    """One solution of the paper's friction scene; its error is nan where the run did not get to the end."""
    values = {**FRICTION, **law} | ({"omega_s": omega_s} if omega_s else {})
    found = run(library, values, TIMES, tolerance)
    row = {"law": law.get("friction_law", "exact"), "method": law.get("method", "automatic"), "tolerance": tolerance}
    row |= {"omega_s, rad/s": omega_s, "error": error_against(truth, found)}
    return row | {"ms": best_time(library, values, tolerance, TIMES[-1]), "steps": found.counters["n_steps"]}


@part(15)
def law(report: Report) -> None:
    """the regularized law"""
    library, points = report.library, []
    truth = run(library, FRICTION, TIMES, 1e-12)
    for tolerance in TOLERANCES:
        points.append(point(library, truth, tolerance, 0.0))
        for omega_s in WIDTHS:
            for method in ("automatic", "bdf"):
                how = {"friction_law": "regularized", "method": method}
                points.append(point(library, truth, tolerance, omega_s, **how))
    report.table("law", points)
    found = pd.DataFrame(points).query("law != 'exact'")
    bound = WIDTH_FACTOR * found["omega_s, rad/s"] + TOLERANCE_FACTOR * found["tolerance"]
    report.figures(law=(found["error"] / bound).max())


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


@part(15)
def crossings(report: Report) -> None:
    """where the layer pays: times of DOP853 and of BDF over that of automatic, for each scene and width"""
    scenes = {
        "the paper's, 10 s": (FRICTION, 10.0),
        "the paper's, 60 s": (FRICTION, 60.0),
        "a tenth of the size": ({**similar(0.1), "s": 0.003}, 10.0 * 0.1**0.5),
        "multibody": ({**FRICTION, "formulation": "multibody"}, 10.0),
        "light friction": ({"s": 0.003}, 10.0),
    }
    library, rows = report.library, []
    for name, (scene, duration) in scenes.items():
        for omega_s in (1e-2, 3e-3, 1e-3, 3e-4, 1e-4):
            law = {**scene, "friction_law": "regularized", "omega_s": omega_s}
            automatic, dop853, bdf = (
                best_time(library, {**law, "method": m}, 1e-6, duration, 3) for m in ("automatic", "runge_kutta", "bdf")
            )
            ratios = {"DOP853 over automatic": dop853 / automatic, "BDF over automatic": bdf / automatic}
            row = {"scene": name, "decay number": decay_number(law), **ratios}
            rows.append(row | {"in layers": is_layered(library, law)})
    report.table("crossings", rows)
    better = pd.DataFrame(rows)[[*ratios]].min(axis=1)
    report.figures(wrong_method=max((1 / better).max(), 1.0))


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
