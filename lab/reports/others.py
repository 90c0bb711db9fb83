"""Results of other programs, compared with wheel.fmu: derivations, reference results, closed forms (programs/).

Each comparison is a row: source, scene, both values, their difference, and its cause.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from wheelfmu.truth.exact_motions import measured_critical_spin
from wheelfmu.truth.motion import Library, Run

from .page import Report, number, part
from .programs import wheels
from .programs.wheels import read

HEAD = ["source", "scene", "reference", "wheel.fmu", "difference", "cause of the difference"]
SICONOS = {
    "rolls": "the paper's free wheel rolls",
    "slides": "the same slides, mu_max = mu_slide = 0.3",
    "backspin": "thrown with backspin, 10° of lean, 0.3",
    "resists": "upright, s = 0.01 m",
}
Compared = tuple[object, ...]  # a row of HEAD


def digits(*values: float, places: int = 12) -> str:
    return ", ".join(f"{round(value, places) + 0.0:.{places}f}" for value in values)  # no -0


def ends(table: Mapping[str, np.ndarray] | Run, *names: str, places: int = 8) -> str:
    return digits(*(table[name][-1] for name in names), places=places)


def kane(library: Library) -> Compared:
    from .programs.kane import distance

    scene = "200 random states, loads, inertias and laws of resistance: ψ̈, θ̈, φ̈, N"
    return "symbrim 0.1.0 (TU Delft; SymPy, Kane)", scene, "derived", "same", distance(), "rounding"


def modelica(library: Library) -> Compared:
    theirs, ours = read("modelica_wheel"), wheels.modelica(library)
    drift, own = wheels.modelica_drift(), wheels.modelica_own(library)
    whose = f"the table: its energy drifts by {number(drift)}; wheel.fmu is within {number(own)} m of truth/reference"
    who, scene = "Modelica Standard Library 4.0, reference result", "RollingWheel, 4 s: X_O, Y_O"
    apart = wheels.apart(theirs, wheels.modelica_reference())
    return who, scene, ends(theirs, "x", "y"), ends(ours, "X_O", "Y_O"), apart, whose


def coin(library: Library) -> Compared:
    ours, table = wheels.coin(library, 1e-12), read("exudyn_coin")
    limit, off = wheels.coin_limit(table), float(abs(table["x"][0] - ours[0]))
    whose = f"rounding; at its step of 0.5 ms Exudyn deviates by {number(off)} m"
    who, scene = "Exudyn 1.13.6, extrapolated to h = 0", "rollingCoinTest, 0.5 s: X_C, Y_C"
    return who, scene, digits(*limit, places=15), digits(*ours, places=15), float(np.abs(limit - ours).max()), whose


def thrown(library: Library) -> Compared:
    ours, table = wheels.thrown(library, 1e-12), read("exudyn_slide")
    limit, off = wheels.thrown_limit(table), np.abs(wheels.thrown_in_steps(table)[-1] - ours).max()
    whose = f"Exudyn's: at a slip of {table['zone'][-1] * 1e6:.3g} µm/s it deviates by {number(float(off))} m"
    who, scene = "Exudyn 1.13.6, extrapolated to no regularization", "thrown disc slides, rolls; 0.5 s: X_O, Y_O"
    apart = float(np.abs(limit - ours).max())
    return who, scene, digits(*limit[2:]), digits(*ours[2:]), apart, whose


def critical(library: Library) -> Compared:
    ours, theirs = measured_critical_spin(library, wheels.SYMPY_DISC), wheels.SYMPY_CRITICAL_SPIN
    who, scene = "SymPy 1.14, test_linearize", "spin at which all eigenvalues vanish"
    return who, scene, f"1/√3 = {theirs:.12f}", digits(ours), float(abs(ours - theirs)), "wheel.fmu: measured"


def legendre(library: Library) -> Compared:
    from .programs.legendre import DISCS, legendre_error

    worst = max(legendre_error(library, disc) for disc in DISCS)
    who, scene = "Chaplygin, Appell, Korteweg, 1897–1900", "four discs, 10 s: ω_2 and ω_3 as functions of θ"
    return who, scene, "Legendre functions", "same", worst, "wheel.fmu: its solver at tolerance 1e-13"


@part(30)
def siconos(report: Report) -> dict[str, object]:
    """Siconos' steps"""
    table, rows = read("siconos"), []
    for scene, words in SICONOS.items():
        steps, ours = wheels.siconos(table, scene), wheels.siconos_ours(report.library, scene, 1e-11)
        limit = steps.limit if steps.errors[0] > 1e-6 else steps.places[-1]  # rounding is not extrapolated
        apart = float(np.abs(limit - ours).max())
        ordered = steps.errors[0] > 1e-6
        row = (words, digits(*limit, places=8), digits(*ours, places=8), apart)
        rows.append((*row, f"{steps.order:.3f}" if ordered else "exact", f"{steps.time:.2g}" if ordered else "–"))
    head = ["scene", "Siconos", "wheel.fmu", "difference, m", "order in h", "time for 1e-4 m, s"]
    return {"siconos": pd.DataFrame(rows, columns=head)}


@part(100)
def numbers(report: Report) -> dict[str, object]:
    """results of other programs"""
    rows = [of(report.library) for of in (kane, modelica, coin, thrown, critical, legendre)]
    return {"numbers": pd.DataFrame(rows, columns=HEAD), "modelica_own": wheels.modelica_own(report.library)}
