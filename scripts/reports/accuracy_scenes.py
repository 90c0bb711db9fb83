"""Scenes beyond the paper's, against the independent reference: pointwise and as motions; the multibody drift."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from equations import test_equations as pointwise
from physics.cases import CASES, error, expected, transitions_gap
from physics.measure import constraint_drift, unstabilised_drift
from support import equations as eq
from support.motion import Library

from . import accuracy_figures as figures
from .markdown import image, number, table
from .part import Check, Part


def equations() -> Part:
    """Accelerations and reactions at ten thousand random states."""
    rows = []
    for name, kind in pointwise.KINDS.items():
        scenes, motions = pointwise.draw(1, kind)
        pair = [pointwise.answer(f, scenes, motions) for f in (eq.REDUCED, eq.MULTIBODY)]
        any_J = pointwise.draw(6, kind, symmetric=False)
        found = pointwise.answer(eq.MULTIBODY, *any_J)
        against_reference = pointwise.distance(found, pointwise.referenced(*any_J), any_J[0])
        rows.append((name, pointwise.distance(*pair, scenes), against_reference))
    checks = [
        Check("reduced against multibody, accelerations and reactions", "at most", 1e-11, max(r[1] for r in rows)),
        Check("multibody against the reference, any J", "at most", 1e-11, max(r[2] for r in rows)),
    ]
    text = f"""## The equations, pointwise

Largest relative difference of accelerations and reactions at 10,000 random states, wheels, inertias and inputs for
each kind of moment about the axle.

{table(["friction", "reduced - multibody, J_x = J_y", "multibody - reference, any J"], rows)}"""
    return Part(text, checks)


def scenes(product: Library) -> Part:
    rows = []
    for name, case in CASES.items():
        errors = [error(product, name, tolerance) for tolerance in (None, 1e-10, 1e-12)]
        events = len(expected(name).events) - 1 if case.wheel.s > 0 else 0
        instants = transitions_gap(product, name, case.wheel.s) if case.wheel.s > 0 else 0.0
        rows.append((name, case.duration, *errors, events, instants))
    header = ["scene", "s", "default", "1e-10", "1e-12", "transitions", "their error, s"]
    text = f"""## Other scenes against the independent reference

Largest error of any output or the energy, relative to the largest value of its kind (place, angle, velocity, rate,
force, energy), at three tolerances; inf marks a scene in which the transitions are not those of the reference. At the
default tolerance the worst is {number(max(row[2] for row in rows))}, at 1e-12 {number(max(row[4] for row in rows))}.

{table(header, rows)}

The scenes are data in `tests/support/scenes.py`."""
    return Part(text, [Check("other scenes: error at tolerance 1e-12", "at most", 1e-8, max(row[4] for row in rows))])


def drift(product: Library, folder: Path) -> Part:
    times = np.linspace(0, 10, 501)
    rows, plain, held = [], {}, {}
    for tolerance in (1e-6, 1e-8, 1e-10, 1e-12):
        plain[tolerance] = unstabilised_drift(times, tolerance)
        *held[tolerance], run = constraint_drift(product, times, tolerance, formulation=3)
        worst = [float(off.max()) for off in (*plain[tolerance], *held[tolerance])]
        rows.append((tolerance, *worst, float(np.abs(run["E"] / run["E"][0] - 1).max())))
    figures.drift(times, plain, held, folder / "accuracy_drift.png")
    velocity, height, _ = constraint_drift(product, times, None)
    header = ["tolerance", "(24): m/s", "(24): m", "FMU: m/s", "FMU: m", "FMU: energy, relative"]
    text = f"""## Drift of the multibody formulation off its constraints

The paper's (24) holds the constraints of rolling as accelerations; their velocities [B]{{q'}} = 0 and the height
Z_O = r_0 sin(theta) + r are left to the integration. Free wheel, largest over 10 s: (24) as it stands, its
accelerations integrated by SciPy's DOP853 at the same tolerance, where the height drifts away; and the FMU
(`formulation` = multibody), where a term that vanishes on the constraints draws it back. The reduced formulation has
them built in: {number(float(velocity.max()))} m/s and {number(float(height.max()))} m.

{table(header, rows)}

{image("accuracy_drift.png", "height off the constraint over time, as it stands and stabilised")}"""
    return Part(text)


def parts(product: Library, folder: Path) -> list[Part]:
    return [equations(), scenes(product), drift(product, folder)]
