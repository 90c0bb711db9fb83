"""How exact the FMU is: the paper's scenes, tolerances, fast spin, long runs, other scenes, closed forms, equations.

Judged by the independent reference of tests/reference and by closed forms; the tests under tests/physics bound what is
shown here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd
from equations import pointwise
from physics.cases import CASES, error, expected, transitions_gap
from physics.exact_motions import UPRIGHT, circle_error, fall_error, lift_off_error, straight_error
from physics.leaning import TORUS, measured_critical_spin
from physics.measure import (
    FRICTION,
    constraint_drift,
    energy_error,
    instants,
    instants_error,
    table_errors,
    unstabilised_drift,
)
from reference import Wheel
from support import equations as eq
from support.closed_forms import critical_spin, upright_deceleration
from support.driver import HEADLINE
from support.scenes import Scene

from . import plots
from .page import Report, Row, Tables, number, part
from .plots import Sheet, style
from .speed import long_error
from .truth import kept_headline, range_error

TOLERANCES = tuple(10.0**-k for k in range(4, 14))
SPINS = (2.0, 10.0, 100.0, 300.0, 1000.0)  # rad/s
TABLE_UNIT = 1e-9  # s, last digit of the table of transitions


@part(2)
def paper(report: Report) -> None:
    """the paper's scenes at the default tolerance"""
    errors = pd.DataFrame({scene: table_errors(report.library, scene) for scene in FRICTION})
    report.table("paper", errors.rename_axis("output").reset_index())
    report.figures(**errors.max().add_prefix("error_"))


@part(12)
def tolerances(report: Report) -> None:
    """what each tolerance gives"""
    rows = pd.DataFrame([tolerance_row(report, tolerance) for tolerance in (0.1, 1e-3, *TOLERANCES, 1e-15)])
    report.table("tolerances", rows)
    energy, instants = (rows.set_index("tolerance")[column] for column in ("energy, free", "instants, s"))
    report.figures(energy=energy[1e-8], energy_tight=energy[1e-12], instants=instants[1e-8])
    report.figures(wrong_counts=(rows["transitions"] != 37).sum())


def tolerance_row(report: Report, tolerance: float) -> Row:
    found = instants(report.library, tolerance)
    with report.library.wheel() as wheel:
        wheel.initialise(tolerance)
        said = " ".join(wheel.sentences)
    return {
        "tolerance": tolerance,
        **{scene: max(table_errors(report.library, scene, tolerance).values()) for scene in FRICTION},
        "energy, free": energy_error(report.library, tolerance),
        "instants, s": instants_error(found),
        "transitions": len(found),
        "said": said,
    }


def draw_tolerances(tables: Tables) -> Sheet:
    rows = tables["tolerances"].query(f"{TOLERANCES[-1]} <= tolerance <= {TOLERANCES[0]}")
    figure, (left, right) = plots.sheet(2)
    t = rows["tolerance"]
    for ax, columns in ((left, ("free", "friction")), (right, ("energy, free", "instants, s"))):
        for name, colour, marker in zip(columns, (style.BLUE, style.VERMILLION), "os", strict=True):
            least = TABLE_UNIT / 2 if name == "instants, s" else 1e-17
            ax.plot(t, rows[name].clip(lower=least), marker + "-", color=colour, ms=3, label=name)
        ax.plot(t, t, "--", color=style.GREY, lw=0.7, label="error = tolerance")
        ax.axvline(1e-8, color=style.INK, lw=0.5, label="the default")
        ax.legend()
    plots.label(left, "tolerance", "largest headline error / range", "the paper's two scenes", "xy")
    plots.label(right, "tolerance", "error", "energy (relative), instants of the transitions (s)", "xy")
    return figure


@part(20)
def spins(report: Report) -> None:
    """fast spin"""
    rows = []
    for spin in SPINS:
        start = {"theta_start": 1.4, "phi_dot_start": -spin, "keep_contact": True}
        want, row = kept_headline(Scene(start, 1.0), 101), {"spin, rad/s": spin}
        for tolerance in (1e-6, 1e-8, 1e-10):
            run = report.library.simulate(np.linspace(0, 1, 101), tolerance, **start)
            error = range_error(np.column_stack([run[name] for name in HEADLINE]), want)
            row[f"at {number(tolerance)}"] = error / tolerance
        rows.append(row)
    report.table("spins", rows)
    report.figures(spin=max(row["at 1e-8"] for row in rows))


@part(8)
def long(report: Report) -> None:
    """1000 s of the unfolded wheel"""
    errors = {tolerance: long_error(report.library, tolerance) for tolerance in TOLERANCES[:-1]}
    report.table("long", [{"tolerance": t, "error / range": error} for t, error in errors.items()])
    report.figures(long=errors[1e-8])


@part(40)
def scenes(report: Report) -> None:
    """other scenes against the reference"""
    rows = []
    for name, case in CASES.items():
        rubs = case.wheel.s > 0
        row = {"scene": name, "s": case.duration}
        row |= {f"at {number(t)}": error(report.library, name, t) for t in (1e-8, 1e-10, 1e-12)}
        row["transitions"] = len(expected(name).events) - 1 if rubs else 0
        rows.append(row | {"their error, s": transitions_gap(report.library, name, case.wheel.s) if rubs else 0.0})
    report.table("scenes", rows)
    largest = pd.DataFrame(rows).max()
    report.figures(scenes=largest["at 1e-8"], scenes_tight=largest["at 1e-12"])


@part(6)
def closed_forms(report: Report) -> None:
    """closed forms"""
    library, thin, rough = report.library, Wheel(r=0.0), Wheel(s=0.03)
    stop = 2 / upright_deceleration(rough)

    def stop_error(form: int) -> float:
        return abs(library.simulate([0.0, 6.0], s=0.03, formulation=form, **UPRIGHT).events[0][0] - stop)

    measures: dict[str, Callable[[int], float]] = {
        "upright rolling slows down linearly: ω_z, rad/s": lambda f: straight_error(library, f, 0.03, rough),
        f"and stops at {stop:.6f} s: instant, s": stop_error,
        "released from rest it falls flat: instant, s": lambda f: fall_error(library, f, TORUS),
        "a light rim lifts off while falling: s, rad": lambda f: lift_off_error(library, f, 0.0),
        "steady circle, thin disc, 5 s": lambda f: circle_error(library, thin, thin, f, 1.0, 1.1),
        "steady circle, torus, 5 s": lambda f: circle_error(library, TORUS, TORUS, f, 1.0, 1.1),
    }
    rows = [{"motion: error": name, "reduced": m(2), "multibody": m(3)} for name, m in measures.items()]
    report.table("closed_forms", rows)
    report.figures(closed_forms=max(max(row["reduced"], row["multibody"]) for row in rows))


@part(4)
def stability_limit(report: Report) -> None:
    """the stability limit of upright rolling"""
    found, formula = measured_critical_spin(report.library), critical_spin(TORUS)
    report.figures(critical_spin=found, critical=abs(found / formula - 1))


@part(20)
def equations(report: Report) -> None:
    """the equations, pointwise"""
    rows = {}
    for name, kind in eq.LAWS.items():
        for words, symmetric in (("J_x = J_y", True), ("any J", False)):
            drawn, motions = pointwise.draw(6, kind, symmetric=symmetric)
            pair = [pointwise.dynamics(f, drawn, motions) for f in (eq.REDUCED, eq.MULTIBODY)]
            rows[f"reduced − multibody, {words}", name] = pointwise.distance(*pair, drawn)
        apart = pointwise.distance(pair[1], pointwise.referenced(drawn, motions), drawn)
        rows["multibody − reference, any J", name] = apart
    table = pd.Series(rows).unstack(0, sort=False)
    report.table("equations", table.rename_axis("friction").reset_index())
    report.figures(equations=table.to_numpy().max())


@part(15)
def drift(report: Report) -> None:
    """drift of the multibody form off its constraints"""
    times, rows = np.linspace(0, 10, 501), []
    names = ("(24) alone: m/s", "(24) alone: m", "FMU: m/s", "FMU: m")
    for tolerance in (1e-6, 1e-8, 1e-10, 1e-12):
        *held, _ = constraint_drift(report.library, times, tolerance, formulation=3)
        worst = [off.max() for off in (*unstabilised_drift(times, tolerance), *held)]
        rows.append({"tolerance": tolerance, **dict(zip(names, worst, strict=True))})
    report.table("drift", rows)


PICTURES = {"tolerances": draw_tolerances}
