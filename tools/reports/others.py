"""Numbers of other people, beside those of wheel.fmu: derivations, reference results, closed forms (tests/others).

Each row says whose number it is, which scene, and whose error the difference is. Exudyn runs where it is installed;
else its rows are those kept in tests/others.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from others import kane_states, wheels
from others.numbers import read
from physics.leaning import measured_critical_spin
from reference import Start, Wheel
from support.schedule import Schedule

from .page import Report, number, part
from .partners import fmus


def row(report: Report, who: str, scene: str, values: tuple[str, str], apart: float, whose: str) -> None:
    rows = report.kept.setdefault("rows", [])
    theirs, ours = values
    rows.append({"who": who, "scene": scene, "theirs": theirs, "ours": ours, "apart": apart, "whose error": whose})
    report.table("numbers", rows)


def digits(*values: float, places: int = 12) -> str:
    return ", ".join(f"{value:.{places}f}" for value in values)


@part(5)
def kane(report: Report) -> None:
    """the torus wheel by Kane's method"""
    worst = kane_states.distance()
    scene = "200 random states, loads, inertias and laws of friction: ψ̈, θ̈, φ̈, N"
    row(report, "symbrim 0.1.0 (TU Delft; SymPy, Kane)", scene, ("derived", "same"), worst, "rounding")
    report.figures(kane=worst)


@part(3)
def modelica(report: Report) -> None:
    """Modelica's RollingWheel"""
    theirs, ours, true = read("modelica_wheel"), wheels.modelica(report.library), wheels.modelica_reference()
    off, energy = wheels.apart(theirs, true), wheels.modelica_energy()
    drift = float(np.abs(energy / energy[0] - 1).max())
    own = wheels.apart({"x": true["X_O"], "y": true["Y_O"]}, ours)
    printed = digits(theirs["x"][-1], theirs["y"][-1], places=8), digits(ours["X_O"][-1], ours["Y_O"][-1], places=8)
    whose = f"the table's: its energy drifts by {number(drift)}; tests/reference is {number(own)} m from ours"
    row(report, "Modelica Standard Library 4.0, reference result", "RollingWheel, 4 s: X_O, Y_O", printed, off, whose)
    printed = "0.162547, -2.23778", printed[1]
    whose = "theirs: Modelica's values, compared to 1e-3"
    row(report, "Multibody.jl, test_wheels.jl", "the same wheel", printed, float(ours["X_O"][-1] - 0.162547), whose)
    report.figures(modelica=off, modelica_energy=drift, modelica_own=own)


@part(20)
def coin(report: Report) -> None:
    """Exudyn's rolling coin"""
    ours, table, made = wheels.coin(report.library, 1e-12), read("exudyn_coin"), "kept"
    try:
        from .exudyn_coin import steps
    except ImportError:
        pass
    else:
        table, made = steps(table["h"]), "run"
    limit = wheels.coin_limit(table)
    apart = float(np.abs(limit - ours).max())
    values = digits(*limit, places=15), digits(*ours, places=15)
    whose = f"neither's; at its step of 0.5 ms it is {number(float(abs(table['x'][0] - ours[0])))} m off ({made})"
    row(report, "Exudyn 1.13.6, extrapolated to h = 0", "rollingCoinTest, 0.5 s: X_C, Y_C", values, apart, whose)
    report.figures(coin=apart)


@part(1)
def critical(report: Report) -> None:
    """SymPy's critical spin"""
    ours = measured_critical_spin(report.library, wheels.SYMPY_DISC)
    apart = float(abs(ours - wheels.SYMPY_CRITICAL_SPIN))
    values = f"1/√3 = {wheels.SYMPY_CRITICAL_SPIN:.12f}", digits(ours)
    row(report, "SymPy 1.14, test_linearize", "spin at which all eigenvalues vanish", values, apart, "ours: measured")
    report.figures(critical=apart)


@part(5)
def legendre(report: Report) -> None:
    """the rolling disc by Legendre functions"""
    worst = max(wheels.legendre_error(report.library, disc) for disc in wheels.DISCS)
    who, scene = "Chaplygin, Appell, Korteweg, 1897–1900", "four discs, 10 s: ω_2 and ω_3 as functions of θ"
    row(report, who, scene, ("Legendre functions", "same"), worst, "ours: the solver's, at tolerance 1e-13")
    report.figures(legendre=worst)


@part(1)
def ramp(report: Report) -> None:
    """Multibody.jl's wheel on a ramp"""
    start = Start(psi=0.0, theta=np.pi / 2, phi_dot=0.0, X_O=0.0)
    wheel = Wheel(m=2.0, r_0=0.3, r=0.0, J_x=0.12, J_y=0.12, J_z=0.06)
    inputs = Schedule(((0.0, {"F_X": [wheel.m * wheel.g * np.sin(np.pi / 4)]}),))  # the ramp's axes: the weight tilts
    tilted = replace(wheel, g=wheel.g * np.cos(np.pi / 4))
    run = wheels.motion(report.library, tilted, start, np.linspace(0, 4, 9), inputs=inputs)
    gained = np.diff(run["omega_z"])
    closed = wheel.g * np.sin(np.pi / 4) / wheel.r_0 / (1 + wheel.J_z / (wheel.m * wheel.r_0**2)) / 2
    values = "between 5 and 9.81", digits(abs(gained[0]), places=6)
    scene, whose = "wheel on a ramp of 45°: spin gained in each 0.5 s, rad/s", "neither's; ours beside g sin α / R (…)"
    row(report, "Multibody.jl, test_wheels.jl", scene, values, float(np.abs(np.abs(gained) - closed).max()), whose)


@part(60)
def wheel_sets(report: Report) -> None:
    """Modelica's wheel sets: axle.fmu with ever stiffer links"""
    from others import wheel_sets as sets

    rows = []
    for scene, factors in {"driving": (40, 80, 160), "pulling": (10, 20, 40)}.items():
        table, rigid = sets.table(scene), sets.rigid(scene)
        runs = [sets.coupled(fmus(report), scene, factor, 0.002 / factor) for factor in factors]
        limit = sets.limit(runs)
        errors = [sets.distance(run, rigid) for run in runs]
        own, theirs = sets.distance(limit, rigid), sets.distance(table, rigid)
        shown = dict(zip(("at k", "at 2 k", "at 4 k"), errors, strict=True))
        rows.append({"scene": scene, "k, N/m": sets.SOFT * factors[0], **shown, "limit": own, "Modelica": theirs})
        values = tuple(digits(*(source[name][-1] for name in sets.COMPARED), places=7) for source in (table, limit))
        name = f"RollingWheelSet{scene.capitalize()}, 3 s: x, y, φ; links → ∞"
        whose = f"the table's; ours is {number(own)} from the rigid wheel set"
        row(report, "Modelica Standard Library 4.0", name, values, sets.distance(limit, table), whose)
        report.figures(**{scene: own})
    report.table("stiffness", rows)
    printed, exact = read("multibody_jl_driving"), sets.rigid_at("driving", read("multibody_jl_driving")["time"])
    apart = float(np.hypot(printed["x"] - exact["x"], printed["y"] - exact["y"]).max())
    last = tuple(digits(source["x"][-1], source["y"][-1], places=6) for source in (printed, exact))
    row(report, "Multibody.jl, test_wheels.jl", "DrivingWheelSet, 11 instants, 1 s: x, y", last, apart, "theirs: 1e-3")
