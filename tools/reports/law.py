"""The regularized law -s N tanh(omega_z / omega_s) against the exact one, for `stability`."""

from __future__ import annotations

from robustness.regularized import FRICTION, TIMES, TOLERANCE_FACTOR, WIDTH_FACTOR, error_against
from support.driver import Values
from support.motion import run

from . import plots
from .page import Report, Row, Tables, number, part
from .plots import Sheet

METHODS = ("automatic", "bdf")
TOLERANCES, WIDTHS = (1e-4, 1e-6, 1e-8), (0.0, *(10.0**-k for k in range(1, 9)))


def regularized(values: Values, omega_s: float, method: str) -> Values:
    return {**values, "friction_law": "regularized", "omega_s": omega_s, "method": method}


@part(15, {"tolerance": TOLERANCES, "omega_s, rad/s": WIDTHS, "method": METHODS})
def law(report: Report, tolerance: float, omega_s: float, method: str) -> Row:
    """the regularized law in the paper's friction scene; omega_s = 0: the exact law"""
    values = regularized(FRICTION, omega_s, method) if omega_s else FRICTION
    truth, found = (run(report.library, v, TIMES, t) for v, t in ((FRICTION, 1e-12), (values, tolerance)))
    in_one_step, error = report.master.made(values, TIMES[-1], 1, tolerance), error_against(truth, found)
    row = {"error": error, "ms": 1e3 * min(in_one_step()[0] for _ in range(5)), "steps": found.counters["n_steps"]}
    return row | ({"error / bound": error / (WIDTH_FACTOR * omega_s + TOLERANCE_FACTOR * tolerance)} if omega_s else {})


def draw_law(tables: Tables) -> Sheet:
    figure, axes = plots.sheet("ab")
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
