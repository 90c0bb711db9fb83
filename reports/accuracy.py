"""How exact the FMU is: the paper's scenes, tolerances, fast spin, long runs, other scenes, closed forms, equations.

Judged by the independent reference of tests/reference and by closed forms; the tests under tests/physics bound what is
shown here.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from equations import test_equations as pointwise
from physics.cases import CASES, error, expected, transitions_gap
from physics.exact_motions import UPRIGHT, circle_error, fall_error, lift_off_error, straight_error
from physics.leaning import TORUS, lean_of, measured_critical_spin, stiffness
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
from support.closed_forms import critical_spin, upright_deceleration, upright_stiffness
from support.driver import HEADLINE
from support.scenes import Scene

from . import plots
from .page import Report, number
from .plots import style
from .speed import long_error
from .truth import kept_headline, range_error

TOLERANCES = tuple(10.0**-k for k in range(4, 14))
SPINS = (2.0, 10.0, 100.0, 300.0, 1000.0)  # rad/s
TABLE_UNIT = 1e-9  # s, last digit of the table of transitions


def paper(report: Report) -> None:
    """the paper's scenes at the default tolerance"""
    errors = {scene: table_errors(report.library, scene) for scene in FRICTION}
    report.table("paper", [{"output": n, **{scene: e[n] for scene, e in errors.items()}} for n in HEADLINE])
    for scene, found in errors.items():
        what = f"{scene} scene: error of any headline output / its range"
        report.figure(f"error_{scene}", what, max(found.values()), "", 1e-6)


def tolerances(report: Report) -> None:
    """what each tolerance gives"""
    rows = [tolerance_row(report, tolerance) for tolerance in (0.1, 1e-3, *TOLERANCES, 1e-15)]
    report.table("tolerances", rows)
    proper = [row for row in rows if row["tolerance"] in TOLERANCES]
    at = {row["tolerance"]: row for row in proper}
    report.figure("energy", "free scene: energy over 10 s, relative", at[1e-8]["energy, free"], "", 1e-8)
    report.figure("energy_tight", "the same at tolerance 1e-12", at[1e-12]["energy, free"], "", 1e-12)
    report.figure("instants", "friction scene: error of the 37 instants", at[1e-8]["instants, s"], "s", 1e-6)
    wrong = sum(row["transitions"] != 37 for row in rows)
    report.figure("wrong_counts", "tolerances without all 37 transitions", wrong, "", 0, relation="exactly")
    figure, (left, right) = plots.sheet(2)
    t = [row["tolerance"] for row in proper]
    for ax, columns in ((left, ("free", "friction")), (right, ("energy, free", "instants, s"))):
        for name, colour, marker in zip(columns, (style.BLUE, style.VERMILLION), "os", strict=True):
            least = TABLE_UNIT / 2 if name == "instants, s" else 1e-17
            ax.plot(t, [max(row[name], least) for row in proper], marker + "-", color=colour, ms=3, label=name)
        ax.plot(t, t, "--", color=style.GREY, lw=0.7, label="error = tolerance")
        ax.axvline(1e-8, color=style.INK, lw=0.5, label="the default")
        ax.legend()
    plots.label(left, "tolerance", "largest headline error / range", "the paper's two scenes", "xy")
    plots.label(right, "tolerance", "error", "energy (relative), instants of the transitions (s)", "xy")
    report.picture("tolerances", figure)


def tolerance_row(report: Report, tolerance: float) -> dict[str, object]:
    errors = {scene: max(table_errors(report.library, scene, tolerance).values()) for scene in FRICTION}
    found = instants(report.library, tolerance)
    with report.library.wheel() as wheel:
        wheel.initialise(tolerance)
        said = " ".join(wheel.sentences)
    return {
        "tolerance": tolerance,
        **errors,
        "energy, free": energy_error(report.library, tolerance),
        "instants, s": instants_error(found),
        "transitions": len(found),
        "said": said,
    }


def spins(report: Report) -> None:
    """fast spin"""
    rows, worst = [], 0.0
    for spin in SPINS:
        start = {"theta_start": 1.4, "phi_dot_start": -spin, "keep_contact": True}
        scene = Scene(start, 1.0)
        want, row = kept_headline(scene, 101), {"spin, rad/s": spin}
        for tolerance in (1e-6, 1e-8, 1e-10):
            run = report.library.simulate(np.linspace(0, 1, 101), tolerance, **start)
            ratio = range_error(np.column_stack([run[name] for name in HEADLINE]), want) / tolerance
            row[f"at {number(tolerance)}"] = ratio
            worst = max(worst, ratio) if tolerance == 1e-8 else worst
        rows.append(row)
    report.table("spins", rows)
    report.figure("spin", "error / range / tolerance in 1 s, up to 1000 rad/s", worst, "", 100)


def long(report: Report) -> None:
    """1000 s of the unfolded wheel"""
    rows = [{"tolerance": t, "error / range": long_error(report.library, t)} for t in TOLERANCES[:-1]]
    report.table("long", rows)
    at_default = next(row["error / range"] for row in rows if row["tolerance"] == 1e-8)
    report.figure("long", "free wheel, 1000 s: error / range", at_default, "", 1e-6)


def scenes(report: Report) -> None:
    """other scenes against the reference"""
    rows = []
    for name, case in CASES.items():
        errors = {f"at {number(t)}": error(report.library, name, t) for t in (1e-8, 1e-10, 1e-12)}
        rubs = case.wheel.s > 0
        rows.append(
            {
                "scene": name,
                "s": case.duration,
                **errors,
                "transitions": len(expected(name).events) - 1 if rubs else 0,
                "their error, s": transitions_gap(report.library, name, case.wheel.s) if rubs else 0.0,
            }
        )
    report.table("scenes", rows)
    report.figure("scenes", "other scenes, default tolerance: error", max(r["at 1e-8"] for r in rows))
    report.figure("scenes_tight", "other scenes at 1e-12: error", max(r["at 1e-12"] for r in rows), "", 1e-8)


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
    worst = max(max(row["reduced"], row["multibody"]) for row in rows)
    report.figure("closed_forms", "closed forms: any error", worst, "", 1e-7)


def stability_limit(report: Report) -> None:
    """the stability limit of upright rolling"""
    critical, found = critical_spin(TORUS), measured_critical_spin(report.library)
    report.figure("critical_spin", "upright rolling is stable above", found, "rad/s")
    report.figure("critical", "stability limit: relative error", abs(found / critical - 1), "", 1e-6)
    factors = np.array((0.5, 0.8, 0.9, 0.95, 0.99, 1.01, 1.05, 1.1, 1.2, 1.5))
    measured = np.array([stiffness(report.library, factor * critical, 0.5) for factor in factors])
    times = np.linspace(0, 10, 501)
    figure, (left, right) = plots.sheet(2)
    for colour, factor in ((style.VERMILLION, 0.99), (style.BLUE, 1.01)):
        lean = np.abs(lean_of(report.library, factor * critical, times))
        left.plot(times, lean, color=colour, label=rf"{factor} $\omega_c$")
    line = np.linspace(0.5, 1.5, 100)
    right.plot(line, [upright_stiffness(TORUS, f * critical) for f in line], color=style.GREY, label="linear theory")
    right.plot(factors, measured, "o", color=style.BLUE, ms=4, mfc="none", label="measured")
    right.axhline(0, color=style.INK, lw=0.5)
    plots.label(
        left, "t [s]", "amount of the lean / that at the start", "a lean of 1e-6 rad below and above the limit", "y"
    )
    plots.label(right, r"$\omega_z / \omega_c$", r"$\kappa^2$ [1/s²]", "stiffness of the upright wheel")
    left.legend()
    right.legend()
    report.picture("stability_limit", figure)


def equations(report: Report) -> None:
    """the equations, pointwise"""
    rows = []
    for name, kind in eq.LAWS.items():
        row: dict[str, object] = {"friction": name}
        for words, symmetric in (("J_x = J_y", True), ("any J", False)):
            drawn, motions = pointwise.draw(6, kind, symmetric=symmetric)
            pair = [pointwise.answer(f, drawn, motions) for f in (eq.REDUCED, eq.MULTIBODY)]
            row[f"reduced − multibody, {words}"] = pointwise.distance(*pair, drawn)
        row["multibody − reference, any J"] = pointwise.distance(pair[1], pointwise.referenced(drawn, motions), drawn)
        rows.append(row)
    report.table("equations", rows)
    worst = max(value for row in rows for value in row.values() if isinstance(value, float))
    report.figure("equations", "accelerations and reactions: forms and reference apart", worst, "", 1e-11)


def drift(report: Report) -> None:
    """drift of the multibody form off its constraints"""
    times, rows = np.linspace(0, 10, 501), []
    figure, axes = plots.sheet(2)
    for colour, tolerance in zip(plots.COLOURS, (1e-6, 1e-8, 1e-10, 1e-12), strict=False):
        plain = unstabilised_drift(times, tolerance)
        *held, _ = constraint_drift(report.library, times, tolerance, formulation=3)
        for ax, (_, height) in zip(axes, (plain, held), strict=True):
            ax.plot(times, np.maximum(height, 1e-18), color=colour, lw=0.7, label=f"tolerance {number(tolerance)}")
        names = ("(24) alone: m/s", "(24) alone: m", "FMU: m/s", "FMU: m")
        worst = [float(off.max()) for off in (*plain, *held)]
        rows.append({"tolerance": tolerance, **dict(zip(names, worst, strict=True))})
    report.table("drift", rows)
    for ax, title in zip(axes, ("(24) as it stands, by SciPy's DOP853", "the FMU, stabilised"), strict=True):
        plots.label(ax, "t [s]", "height off the constraint [m]", title, "y")
        ax.set_ylim(1e-18, 1e-3)
    plots.legend_below(figure, axes[0])
    report.picture("drift", figure)


def dissipation(report: Report) -> None:
    """the energy that friction takes"""
    times = np.linspace(0, 10, 2001)
    free, rough = (report.library.simulate(times, s=s) for s in FRICTION.values())
    late = report.library.simulate([0.0, 10.0, 30.0, 80.0, 150.0], s=0.03)
    energies = zip(late.t, late["E"], strict=True)
    report.table("energy", [{"t, s": t, "E, J": f"{e:.5f}", "transitions": events_until(late, t)} for t, e in energies])
    held = rough["friction_mode"] == 0
    report.figure("held_share", "share of 10 s in which friction holds the wheel", 100 * float(held.mean()), "%")
    figure, (ax,) = plots.sheet(1)
    ax.fill_between(times, 54, 77, where=held, color=style.BAND, lw=0, label=r"held at $\omega_z = 0$")
    ax.plot(times, free["E"], color=style.BLUE, label="s = 0")
    ax.plot(times, rough["E"], color=style.VERMILLION, label="s = 0.03 m")
    ax.set(xlim=(0, 10), ylim=(54, 77))
    plots.label(ax, "t [s]", "E [J]", "energy of the paper's two scenes")
    plots.legend_below(figure, ax, 3)
    report.picture("energy", figure)


def events_until(run: object, t: float) -> int:
    return sum(instant <= t for instant, _ in run.events)  # type: ignore[attr-defined]


PARTS: dict[Callable[[Report], None], float] = {
    **{paper: 2, tolerances: 12, spins: 20, long: 8, scenes: 40, closed_forms: 6},
    **{stability_limit: 4, equations: 20, drift: 15, dissipation: 3},
}
