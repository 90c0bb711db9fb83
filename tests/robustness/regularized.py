"""The regularized law -s N tanh(omega_z / omega_s) against the exact one: error and cost over omega_s, by two methods.

Scene: the paper's wheel with friction, 10 s. Error: largest of the headline outputs over 101 times, relative to the
output's range, against the exact law at tolerance 1e-12.
"""

from __future__ import annotations

from dataclasses import dataclass
from time import perf_counter

import numpy as np
from support.driver import HEADLINE, WARNING, Values
from support.motion import Library, Run, run
from support.scenes import wheel_of

from .case import similar

FRICTION: Values = {"s": 0.03}
TIMES = np.linspace(0.0, 10.0, 101)
WIDTHS = tuple(10.0**-k for k in range(1, 9))
TOLERANCES = (1e-4, 1e-6, 1e-8)
REPEATS = 5
THRESHOLD = 1000.0  # decay number from which automatic takes the law for stiff: `stiff` in fmu-src/wheel/law.cpp
WIDTH_FACTOR, TOLERANCE_FACTOR = 5.0, 100.0  # error of the law allowed: per rad/s of its width, per tolerance


@dataclass
class Point:
    """One solution. error is nan where the run did not get to the end."""

    law: str
    method: str
    tolerance: float
    omega_s: float
    error: float
    milliseconds: float
    steps: int
    rhs: int


def error_against(truth: Run, found: Run) -> float:
    if found.status > WARNING or len(found["t"]) != len(truth["t"]):
        return float("nan")
    return max(float(np.abs(found[n] - truth[n]).max() / np.ptp(truth[n])) for n in HEADLINE)


def best_time(library: Library, values: Values, tolerance: float, duration: float, repeats: int = REPEATS) -> float:
    """Least time of one large doStep, ms."""
    best = float("inf")
    for _ in range(repeats):
        with library.wheel() as wheel:
            wheel.set(**values)
            wheel.initialise(tolerance)
            before = perf_counter()
            wheel.step_to(duration)
            best = min(best, perf_counter() - before)
    return 1e3 * best


def point(library: Library, truth: Run, values: Values, tolerance: float) -> Point:
    found = run(library, values, TIMES, tolerance)
    spent = best_time(library, values, tolerance, TIMES[-1])
    names = (str(values.get("friction_law", "exact")), str(values.get("method", "automatic")))
    omega_s = float(values.get("omega_s", 0.0))
    counts = (found.counters["n_steps"], found.counters["n_rhs"])
    return Point(*names, tolerance, omega_s, error_against(truth, found), spent, *counts)


def study(library: Library) -> list[Point]:
    truth = run(library, FRICTION, TIMES, 1e-12)
    points = []
    for tolerance in TOLERANCES:
        points.append(point(library, truth, FRICTION, tolerance))
        for omega_s in WIDTHS:
            for method in ("automatic", "bdf"):
                law = {**FRICTION, "friction_law": "regularized", "omega_s": omega_s, "method": method}
                points.append(point(library, truth, law, tolerance))
    return points


def observed_order(points: list[Point], tolerance: float) -> list[tuple[float, float]]:
    """(omega_s, order) between neighbouring widths of the BDF solutions."""
    chain = [p for p in points if p.tolerance == tolerance and p.method == "bdf"]
    pairs = zip(chain, chain[1:], strict=False)
    return [(b.omega_s, float(np.log(a.error / b.error) / np.log(a.omega_s / b.omega_s))) for a, b in pairs]


@dataclass
class Crossing:
    """Times of DOP853 and of BDF over that of automatic for one scene at one width; decay: s m g / (omega_s (J_z +
    m rho^2)), times sqrt(rho / g), rho = r_0 + r: how often friction could stop the spin in one swing of the wheel."""

    scene: str
    decay: float
    runge_kutta: float
    bdf: float
    layered: bool


def decay_number(values: Values) -> float:
    w = wheel_of(values)
    rho = w.r_0 + w.r
    return w.s * w.m * w.g / (float(values["omega_s"]) * (w.J_z + w.m * rho**2)) * (rho / w.g) ** 0.5


def is_layered(library: Library, values: Values) -> bool:
    """Whether method = automatic takes the law for stiff: only BDF, where omega_z sticks in the layer, evaluates
    Jacobians."""
    return run(library, values, np.array([0.0, 3.0]), 1e-6).counters["n_jac"] > 0


def crossings(library: Library) -> list[Crossing]:
    scenes = {
        "the paper's, 10 s": (FRICTION, 10.0),
        "the paper's, 60 s": (FRICTION, 60.0),
        "a tenth of the size": ({**similar(0.1), "s": 0.003}, 10.0 * 0.1**0.5),
        "multibody": ({**FRICTION, "formulation": "multibody"}, 10.0),
        "light friction": ({"s": 0.003}, 10.0),
    }
    found = []
    for name, (scene, duration) in scenes.items():
        for omega_s in (1e-2, 3e-3, 1e-3, 3e-4, 1e-4):
            law = {**scene, "friction_law": "regularized", "omega_s": omega_s}
            times = [
                best_time(library, {**law, "method": m}, 1e-6, duration, 3) for m in ("automatic", "runge_kutta", "bdf")
            ]
            ratios = (times[1] / times[0], times[2] / times[0])
            found.append(Crossing(name, decay_number(law), *ratios, is_layered(library, law)))
    return found
