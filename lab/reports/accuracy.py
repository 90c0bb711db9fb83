"""How exact the FMU is: the paper's scenes, tolerances, fast spin, long runs, other scenes, closed forms.

Judged by the independent reference of truth/reference and by closed forms; the tests under tests/physics bound what is
shown here.
"""

from __future__ import annotations

import numpy as np

from wheelfmu.fmu.driver import Values
from wheelfmu.truth import cases, measure
from wheelfmu.truth import exact_motions as exact
from wheelfmu.truth.closed_forms import upright_deceleration
from wheelfmu.truth.errors import over_range
from wheelfmu.truth.orbit import Halves
from wheelfmu.truth.reference import Start, Wheel
from wheelfmu.truth.scenes import PAPER as TORUS
from wheelfmu.truth.scenes import Scene

from . import plots
from .page import Report, Row, Tables, part
from .plots import Sheet, style
from .truth import columns, headline, headline_of

TOLERANCES = tuple(10.0**-k for k in range(4, 14))
TABLE_UNIT = 1e-9  # s, last digit of the table of transitions
THIN, ROUGH = Wheel(r=0.0), Wheel(s=0.03)
STOP = 2 / upright_deceleration(ROUGH)
FORMS = {"reduced": 2, "multibody": 3}
MOTIONS = {
    "upright rolling slows down linearly: ω_z, rad/s": lambda fmu, form: exact.straight_error(fmu, form, 0.03, ROUGH),
    f"and stops at {STOP:.6f} s: instant, s": lambda fmu, form: stop_error(fmu, form),
    "released from rest it lies flat: instant, s": lambda fmu, form: exact.fall_error(fmu, form, TORUS),
    "a light rim lifts off while falling: s, rad": lambda fmu, form: exact.lift_off_error(fmu, form, 0.0),
    "steady circle, thin disc, 5 s": lambda fmu, form: exact.circle_error(fmu, THIN, THIN, form, 1.0, 1.1),
    "steady circle, torus, 5 s": lambda fmu, form: exact.circle_error(fmu, TORUS, TORUS, form, 1.0, 1.1),
}


@part(10, {"tolerance": TOLERANCES})
def tolerances(report: Report, tolerance: float) -> Row:
    """what each tolerance gives"""
    library, found = report.library, measure.instants(report.library, tolerance)
    row = {scene: max(measure.table_errors(library, scene, tolerance).values()) for scene in measure.FRICTION}
    row |= {"energy, free": measure.energy_error(library, tolerance), "instants, s": measure.instants_error(found)}
    return row | {"transitions": len(found), "not 37": len(found) != 37}


def draw_tolerances(tables: Tables) -> Sheet:
    figure, (left, right) = plots.sheet("ab")
    rows, t = tables["tolerances"], tables["tolerances"]["tolerance"]
    for ax, names in ((left, ("free", "friction")), (right, ("energy, free", "instants, s"))):
        for name, colour, marker in zip(names, (style.BLUE, style.VERMILLION), "os", strict=True):
            least = TABLE_UNIT / 2 if name == "instants, s" else 1e-17
            ax.plot(t, rows[name].clip(lower=least), marker + "-", color=colour, ms=3, label=name)
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


@part(8, {"tolerance": TOLERANCES[:-1]})
def long(report: Report, tolerance: float) -> Row:
    """1000 s of the unfolded wheel, against half a nutation of the reference laid end to end"""
    times = np.arange(0.05, 1000, 0.73)
    want = headline_of(Halves(Wheel(), Start()).read(times))
    return {"error / range": over_range(columns(report.library.simulate([0.0, *times], tolerance))[1:], want)}


@part(40, {"scene": cases.NAMES})
def scenes(report: Report, name: str) -> Row:
    """other scenes against the reference"""
    library, scene = report.library, cases.CASES[name]
    row = {"s": scene.duration} | {f"at {t}": cases.error(library, scene, float(t)) for t in ("1e-8", "1e-10", "1e-12")}
    number, gap = 0, 0.0
    if (s := scene.wheel.s) > 0:
        number, gap = len(scene.solved().events) - 1, cases.transitions_gap(library, scene, s)
    return row | {"transitions": number, "their error, s": gap}


def stop_error(library, form: int) -> float:
    return abs(library.simulate([0.0, 6.0], s=0.03, formulation=form, **exact.UPRIGHT).events[0][0] - STOP)


@part(6, {"motion: error": MOTIONS})
def closed_forms(report: Report, measure) -> Row:
    """closed forms"""
    return {name: measure(report.library, form) for name, form in FORMS.items()}


PICTURES = {"tolerances": draw_tolerances}
