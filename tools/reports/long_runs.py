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
from support.motion import Library
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


def long_run(library: Library, scene: str, hours: int) -> Row:
    """One run, read at 600 instants; the cost in us per simulated second, the rise of the energy beyond rounding."""
    seconds, held, status, step = [], 0.0, 0, hours * HOUR / 600
    with library.wheel() as wheel:
        wheel.set(**SCENES[scene])
        wheel.initialise(TOLERANCE)
        wheel.step_to(0.0)
        memory, read = resident(), wheel.reader(("E", "omega_z"))
        energy = [read()[0]]
        for t in step * np.arange(1, 601):
            before = perf_counter()
            status = max(status, wheel.step_to(float(t)))
            seconds.append(perf_counter() - before)
            now, omega_z = read()
            energy.append(now)
            if wheel.get("friction_mode")[0] == 0:
                held = max(held, abs(omega_z))
            if status > WARNING:
                break
        transitions, memory = int(wheel.get("n_events")[0]), resident() - memory
    cost, E = 1e6 * np.array(seconds) / step, np.array(energy)
    return {
        "run": f"{scene}, {hours} h",
        "µs/s, first sixth": np.median(cost[:100]),
        "µs/s, last sixth": np.median(cost[-100:]),
        "energy change / E": (E[-1] - E[0]) / E[0],
        "largest rise, J": max((np.diff(E) - ROUNDING * E[:-1]).max(), 0.0),
        "transitions": transitions,
        "amount of ω_z while held, rad/s": held,
        "memory growth, KiB": memory / 1024,
        "status": status,
        "E": E[0],
    }


def resolved(library: Library, tolerance: float, duration: float) -> Row:
    """The friction scene at its end: are weak releases resolved?"""
    with library.wheel() as wheel:
        wheel.set(**SCENES["friction"])
        wheel.initialise(tolerance)
        wheel.step_to(duration)
        return {
            "tolerance": tolerance,
            "transitions": int(wheel.get("n_events")[0]),
            "E, J": wheel.reader(("E",))()[0],
        }


@part(40)
def hours(report: Report) -> None:
    """an hour and a day"""
    chosen = [(scene, 1) for scene in SCENES]
    chosen += [] if report.quick else [("free", 24), ("friction", 24)]
    runs = pd.DataFrame([long_run(report.library, *run) for run in chosen])
    report.table("hours", runs.drop(columns="E"))
    report.figures(growth=(runs["µs/s, last sixth"] / runs["µs/s, first sixth"]).max())
    report.figures(rise=(runs["largest rise, J"] / runs["E"]).max() / TOLERANCE)
    report.figures(held=runs["amount of ω_z while held, rad/s"].max(), memory=runs["memory growth, KiB"].max() / 1024)
    duration = 600.0 if report.quick else HOUR
    report.table(
        "resolved", [resolved(report.library, tolerance, duration) for tolerance in (1e-6, 1e-8, 1e-10, 1e-12)]
    )


@part(20)
def constraints(report: Report) -> None:
    """drift of the multibody form off its constraints"""
    rows = []
    for name, (values, duration) in DRIFTING.items():
        times, wheel = np.linspace(0.0, duration, 361), wheel_of(values)
        velocity, height, run = constraint_drift(report.library, times, TOLERANCE, formulation="multibody", **values)
        rates = (run["theta_dot"], run["psi_dot"] * np.sin(run["theta"]), run["omega_z"])
        size = wheel.r_0 + wheel.r
        velocity /= size * max(np.abs(rate).max() for rate in rates)  # over the largest speed of a point of the wheel
        halves = velocity[1 : len(velocity) // 2].max(), velocity[len(velocity) // 2 :].max()
        names = ("velocity, first half", "velocity, second half", "height")
        rows.append({"multibody, tolerance 1e-8": name} | dict(zip(names, (*halves, height.max() / size), strict=True)))
    report.table("drift", rows)
    report.figures(drift=pd.DataFrame(rows)[[*names]].to_numpy().max())
