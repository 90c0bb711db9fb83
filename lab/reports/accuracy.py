"""How exact the FMU is: the paper's scenes over the tolerance, and fast spin.

Judged by the independent reference of truth/reference. Bounds, long runs, other scenes and closed forms are those of
tests/physics and tests/orbit.
"""

from __future__ import annotations

import numpy as np

from wheelfmu.fmu.driver import Values
from wheelfmu.truth import measure
from wheelfmu.truth.errors import over_range
from wheelfmu.truth.scenes import Scene

from . import plots
from .page import Report, Row, Tables, part
from .plots import Sheet, style
from .truth import columns, headline

TOLERANCES = tuple(10.0**-k for k in range(4, 14))


@part(10, {"tolerance": TOLERANCES})
def tolerances(report: Report, tolerance: float) -> Row:
    """what each tolerance gives"""
    library, found = report.library, measure.instants(report.library, tolerance)
    row = {scene: max(measure.paper_errors(library, scene, tolerance).values()) for scene in measure.FRICTION}
    row |= {"energy, free": measure.energy_error(library, tolerance), "instants, s": measure.instants_error(found)}
    return row | {"transitions": len(found)}


@tolerances.picture("tolerances")
def draw_tolerances(tables: Tables) -> Sheet:
    figure, (left, right) = plots.sheet("ab")
    rows, t = tables["tolerances"], tables["tolerances"]["tolerance"]
    for ax, names in ((left, ("free", "friction")), (right, ("energy, free", "instants, s"))):
        for name, colour, marker in zip(names, (style.BLUE, style.VERMILLION), "os", strict=True):
            ax.plot(t, rows[name].clip(lower=1e-17), marker + "-", color=colour, ms=3, label=name)
        ax.plot(t, t, "--", color=style.GREY, lw=0.7, label="error = tolerance")
        ax.axvline(1e-8, color=style.INK, lw=0.5, label="the default")
        ax.legend()
    plots.label(left, "tolerance", "largest headline error / range", "the paper's two scenes", "xy")
    plots.label(right, "tolerance", "error", "energy (relative), instants of the transitions (s)", "xy")
    return figure


@part(20, {"spin, rad/s": (2.0, 10.0, 100.0, 300.0, 1000.0)})
def spins(report: Report, spin: float) -> Row:
    """fast spin: error / range / tolerance"""
    start: Values = {"theta_start": 1.4, "phi_dot_start": -spin, "keep_contact": True}
    times = np.linspace(0, 1, 101)
    want = headline(Scene(start, 1.0), 101)
    runs = {t: report.library.simulate(times, float(t), **start) for t in ("1e-6", "1e-8", "1e-10")}
    return {f"at {t}": over_range(columns(run), want) / float(t) for t, run in runs.items()}
