"""Hours of the paper's wheel, for `stability`: energy, memory, cost per simulated second.

Times in s of the model unless said. Memory is the process's own, from /proc/self/statm.
"""

from __future__ import annotations

import os
from pathlib import Path
from time import perf_counter

import numpy as np
import pandas as pd
from support.driver import WARNING, Values

from .page import Report, Row, part

HOUR = 3600.0
TOLERANCE = 1e-8
ROUNDING = 1e-13  # of the energy, relative
SCENES: dict[str, Values] = {"free": {}, "friction": {"s": 0.03}, "multibody": {"formulation": "multibody"}}


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
