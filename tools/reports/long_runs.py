"""Hours of the paper's wheel, for `stability`: energy, memory, cost per simulated second; ever weaker releases; drift.

Times in s of the model unless said. Memory is the process's own, from /proc/self/statm. Drift: how far the multibody
form, (24), is off its constraints, (19) in velocity and (32) in height; fixed axes.
"""

from __future__ import annotations

import os
from pathlib import Path
from time import perf_counter

import numpy as np
import pandas as pd
from physics.measure import constraint_drift
from robustness.case import brushing, tilted
from support.driver import WARNING, Values
from support.scenes import wheel_of

from .page import Report, Row, part

HOUR = 3600.0
TOLERANCE = 1e-8  # a residual is an error of the solution like any other, so it may be as large as the tolerance
ROUNDING = 1e-13  # of the energy, relative
SCENES: dict[str, Values] = {"free": {}, "friction": {"s": 0.03}, "multibody": {"formulation": "multibody"}}
GENERAL = {"J_x": 1.8, "J_y": 0.9, "s": 0.03}
DRIFTING: dict[str, tuple[Values, float]] = {
    "free wheel, 10 s": ({}, 10.0),
    "friction, 10 s": ({"s": 0.03}, 10.0),
    "J_x = 2 J_y, friction, 10 s": (GENERAL, 10.0),
    "brushing theta = 0.1 deg, 10 s": (brushing(0.1), 10.0),
    "spin 1000 rad/s, 1 s": (tilted(84.0, phi_dot_start=-1e3), 1.0),
    "past upright, 170 deg, 10 s": (tilted(170.0), 10.0),
    "free wheel, 1 h": ({}, HOUR),
    "friction, 1 h": ({"s": 0.03}, HOUR),
    "J_x = 2 J_y, friction, 1 h": (GENERAL, HOUR),
}


def resident() -> int:
    """Bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def long_run(report: Report, scene: str, hours: int) -> Row:
    """One run, read at 600 instants; the cost in us per simulated second, the rise of the energy beyond rounding."""
    rows, step = [], hours * HOUR / 600
    with report.library.wheel() as wheel:
        wheel.start(tolerance=TOLERANCE, **SCENES[scene]).step_to(0.0)
        memory, read, status = resident(), wheel.reader(("E", "omega_z")), 0
        for t in step * np.arange(601):
            before = perf_counter()
            status = max(status, wheel.step_to(float(t)))
            spent = perf_counter() - before
            energy, omega_z = read()
            rows.append((1e6 * spent / step, energy, abs(omega_z) if wheel.get("friction_mode")[0] == 0 else 0.0))
            if status > WARNING:
                break
        transitions, memory = int(wheel.get("n_events")[0]), resident() - memory
    cost, E, held = np.array(rows).T
    costs = {"µs/s, first sixth": np.median(cost[1:101]), "µs/s, last sixth": np.median(cost[-100:])}
    rise = max((np.diff(E) - ROUNDING * E[0]).max(), 0.0)
    energy = {"energy change / E": (E[-1] - E[0]) / E[0], "largest rise, J": rise}
    sticking = {"transitions": transitions, "amount of ω_z while held, rad/s": held[1:].max()}
    at_end = {"memory growth, KiB": memory / 1024, "status": status, "E": E[0]}
    return {"run": f"{scene}, {hours} h"} | costs | energy | sticking | at_end


@part(40)
def hours(report: Report) -> dict[str, object]:
    """an hour and a day"""
    chosen = [(scene, 1) for scene in SCENES] + [("free", 24), ("friction", 24)] * (not report.quick)
    runs = pd.DataFrame([long_run(report, *run) for run in chosen])
    growth, rise = runs["µs/s, last sixth"] / runs["µs/s, first sixth"], runs["largest rise, J"] / runs["E"]
    worst = {"growth": growth.max(), "rise": rise.max() / TOLERANCE, "memory": runs["memory growth, KiB"].max() / 1024}
    return {"hours": runs.drop(columns="E")} | worst


@part(4, {"tolerance": (1e-6, 1e-8, 1e-10, 1e-12)})
def resolved(report: Report, tolerance: float) -> Row:
    """the friction scene after an hour: are weak releases resolved?"""
    with report.library.wheel() as wheel:
        wheel.start(tolerance=tolerance, **SCENES["friction"])
        wheel.step_to(600.0 if report.quick else HOUR)
        return {"transitions": int(wheel.get("n_events")[0]), "E, J": wheel.get("E")[0]}


@part(20, {"multibody, tolerance 1e-8": DRIFTING})
def constraints(report: Report, case: tuple[Values, float]) -> Row:
    """drift of the multibody form off its constraints"""
    values, duration = case
    times, wheel = np.linspace(0.0, duration, 361), wheel_of(values)
    velocity, height, run = constraint_drift(report.library, times, TOLERANCE, formulation="multibody", **values)
    rates = (run["theta_dot"], run["psi_dot"] * np.sin(run["theta"]), run["omega_z"])
    size = wheel.r_0 + wheel.r
    velocity /= size * max(np.abs(rate).max() for rate in rates)  # over the largest speed of a point of the wheel
    half = len(velocity) // 2
    halves = {"velocity, first half": velocity[1:half].max(), "velocity, second half": velocity[half:].max()}
    return halves | {"height": height.max() / size}
