"""Scenes that the shared tables do not cover, and their solution by the independent reference of tests/reference.

The inputs are smooth (cubic polynomials) or jump. The ground may pull in all of them (keep_contact).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from reference import Solution, Start, Wheel, solve
from reference.scenes import GENERAL, SCENES

from .product import Product, Result, start_values
from .schedule import Schedule

PUSH = Schedule(
    (
        (
            0.0,
            {
                "F_X": (0, 6, -2.5, 0.2),
                "F_Y": (2, -1, -0.5, 0.1),
                "F_Z": (0, -5, 2, -0.2),
                "M_1": (0.3, 0, -0.1),
                "M_2": (0, 0.4, -0.1),
                "M_3": (0, 1.5, -0.6, 0.05),
            },
        ),
    )
)
BRAKE = Schedule(((0.0, {"M_3": 4.0}), (0.3, {"M_3": -2.0}), (1.0, {"M_3": (0, 2), "F_Y": 3.0})))


@dataclass(frozen=True)
class Case:
    """A wheel, its start, its inputs, how long (s), and the bound on its error at the default tolerance."""

    wheel: Wheel
    start: Start
    duration: float
    bound: float
    inputs: Schedule = Schedule()


def shared(name: str, bound: float) -> Case:
    scene = SCENES[name]
    return Case(scene.wheel, scene.start, scene.duration, bound)


CASES = {
    "fast rolling": shared("fast rolling", 1e-6),
    "fast spin the other way": shared("fast spin the other way", 1e-6),
    "near flat": shared("near flat", 1e-5),
    "thin disc": shared("thin disc", 1e-6),
    "general inertia": shared("general inertia", 1e-6),
    "general inertia, friction": shared("general inertia, friction", 1e-6),
    "light friction": shared("light friction", 1e-6),
    "heavy friction": shared("heavy friction", 5e-6),
    "heavy friction, J_x = J_y": Case(Wheel(s=0.2), Start(), 5.0, 1e-6),
    "past upright": shared("past upright", 1e-6),
    "pushed": Case(Wheel(s=0.02), Start(), 5.0, 1e-6, PUSH),
    "pushed, general inertia": Case(Wheel(**GENERAL, s=0.01), Start(), 5.0, 1e-6, PUSH),
    "braked": Case(Wheel(s=0.01), Start(), 2.0, 1e-6, BRAKE),
}


@cache
def expected(name: str) -> Solution:
    case = CASES[name]
    times = np.linspace(0, case.duration, 51)
    return solve(case.wheel, case.start, times, case.inputs.for_reference(), rtol=1e-12)


def found(product: Product, name: str, tolerance: float | None = None, **changes: float) -> Result:
    case = CASES[name]
    start = {**start_values(case.wheel, case.start), "keep_contact": True, **changes}
    return product.simulate(np.linspace(0, case.duration, 51), tolerance, case.inputs, **start)


KINDS = (
    ("X_O", "Y_O", "Z_O"),
    ("psi", "theta", "phi"),
    ("X_O_dot", "Y_O_dot", "Z_O_dot"),
    ("psi_dot", "theta_dot", "phi_dot", "omega_z"),
    ("lambda_1", "lambda_2", "lambda_3"),
    ("E",),
)


def error(product: Product, name: str, tolerance: float | None = None, **changes: float) -> float:
    """Largest error of an output or the energy over 51 instants, relative to the largest value of its kind."""
    want, got = expected(name), found(product, name, tolerance, **changes)
    errors = []
    for kind in KINDS:
        size = max(float(np.abs(want[column]).max()) for column in kind)
        errors += [float(np.abs(got[column] - want[column]).max()) / size for column in kind]
    return max(errors)


def transitions_gap(product: Product, name: str, s: float) -> float:
    """Largest difference of the instants, s; infinite if the transitions differ."""
    want, got = expected(name).events[1:], found(product, name, s=s).events
    if [mode for _, mode in got] != [mode for _, mode in want]:
        return np.inf
    return max((abs(a - b) for (a, _), (b, _) in zip(got, want, strict=True)), default=0.0)
