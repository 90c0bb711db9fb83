"""Motions known in closed form and the stability limit of upright rolling."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
from physics.exact_motions import UPRIGHT, circle_error, fall_error, lift_off_error, straight_error
from physics.leaning import TORUS, lean_of, measured_critical_spin, stiffness
from reference import Wheel
from support.closed_forms import critical_spin, upright_deceleration, upright_stiffness
from support.motion import Library

from . import accuracy_figures as figures
from .markdown import image, number, table
from .part import Check, Part

THIN, ROUGH = Wheel(r=0.0), Wheel(s=0.03)
FORMULATIONS = (2, 3)  # reduced, multibody


def closed_forms(product: Library) -> Part:
    stop = 2 / upright_deceleration(ROUGH)

    def stop_error(formulation: int) -> float:
        events = product.simulate([0.0, 6.0], s=0.03, formulation=formulation, **UPRIGHT).events
        return abs(events[0][0] - stop)

    measures = {
        "upright rolling with friction slows down linearly and stands: omega_z (rad/s), X_O (m)": lambda f: (
            straight_error(product, f, 0.03, ROUGH)
        ),
        f"it stops at (J_z + m (r_0 + r)^2) 2 rad/s / (s m g) = {stop:.9f} s: instant, s": stop_error,
        "released from rest it falls flat: instant, s": lambda f: fall_error(product, f, TORUS),
        "a light rim lifts off while falling: instant (s), angle (rad)": lambda f: lift_off_error(product, f, 0.0),
        "steady circle of the thin disc, 5 s: angles and rates": lambda f: circle_error(
            product, THIN, THIN, f, 1.0, 1.1
        ),
        "steady circle of the torus, 5 s: angles and rates": lambda f: circle_error(product, TORUS, TORUS, f, 1.0, 1.1),
    }
    rows = [(name, *(measure(f) for f in FORMULATIONS)) for name, measure in measures.items()]
    run = product.simulate(np.linspace(0, 14, 1401), s=0.03, **UPRIGHT)
    tipped = run.t[np.argmax(np.abs(run["theta"] - pi / 2) > 0.5)]
    text = f"""## Closed forms

Errors against motions known in closed form (derived in `tests/support/closed_forms.py`). The upright wheel that has
stopped stands on an unstable rest: rounding alone (cos(pi/2) is 6e-17) tips it, past half a radian at {tipped:.1f} s.

{table(["motion: error", "reduced", "multibody"], rows)}"""
    worst = max(max(row[1:]) for row in rows)
    return Part(text, [Check("closed forms: any error", "at most", 1e-7, worst)])


def stability(product: Library, folder: Path) -> Part:
    critical, found = critical_spin(TORUS), measured_critical_spin(product)
    factors = (0.5, 0.8, 0.9, 0.95, 0.99, 1.01, 1.05, 1.1, 1.2, 1.5)
    points = np.array([(spin, stiffness(product, spin, 0.5)) for spin in np.multiply(factors, critical)])
    times = np.linspace(0, 10, 501)
    leans = {factor: lean_of(product, factor * critical, times) for factor in (0.99, 1.01)}
    expected = np.array([upright_stiffness(TORUS, spin) for spin in points[:, 0]])
    figures.stability(times, leans, points, expected, folder / "accuracy_stability.png")
    rows = [(factor, float(np.abs(lean).max())) for factor, lean in leans.items()]
    text = f"""## The stability limit of upright rolling

Linearised, a small lean e of the torus obeys e'' = -kappa^2 e with
kappa^2 (J_x + m R^2) = (J_z + m R^2) J_z omega_z^2 / J_x - m g r_0, R = r_0 + r: the paper's wheel is stable above
{critical:.9f} rad/s (the paper's scenes start at 2 rad/s, so it falls over). Measured from both sides, as the zero of
kappa^2 between 0.99 and 1.01 of that speed: {found:.9f} rad/s, a relative difference of
{number(abs(found / critical - 1))}. At the other speeds of the right diagram kappa^2, taken from the lean after 0.5 s,
is within {number(float(np.abs(points[:, 1] - expected).max()))} 1/s^2 of the formula. With the thin disc's formula
(r = 0, the same r_0) the limit would be {critical_spin(THIN):.3f} rad/s.

{table(["omega_z / limit", "largest lean in 10 s / lean at the start"], rows)}

{image("accuracy_stability.png", "growth below and swing above the limit; stiffness over speed")}"""
    return Part(
        text, [Check("stability limit of upright rolling, relative", "at most", 1e-6, abs(found / critical - 1))]
    )


def parts(product: Library, folder: Path) -> list[Part]:
    return [closed_forms(product), stability(product, folder)]
