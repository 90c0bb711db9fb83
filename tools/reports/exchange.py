"""Model exchange beside co-simulation: the same archive, through other people's solvers.

FMPy drives both kinds with the same loop in Python; its CVODE moves the wheel in model exchange. SciPy's DOP853 does so
with the event search of tests/support/exchange.py. Errors as in speed.py; times are whole runs, instances included.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import numpy as np
from fmpy import simulate_fmu
from reference.tables import read_table
from support.driver import HEADLINE
from support.exchange import Run, exchange, no_inputs
from support.motion import Library

from .page import Report, Row, part
from .truth import range_error

TIMES = np.linspace(0, 10, 101)
REPEATED = 3  # the best counts
SCENES = {"free": {"s": 0.0}, "friction": {"s": 0.03}}


def by_fmpy(kind: str) -> Callable[[Library, dict[str, float], float], tuple[np.ndarray, float]]:
    def run(library: Library, start: dict[str, float], tolerance: float) -> tuple[np.ndarray, float]:
        done = simulate_fmu(
            library.folder,
            fmi_type=kind,
            start_values=start,
            stop_time=10,
            output_interval=0.1,
            relative_tolerance=tolerance,
            output=[*HEADLINE, "n_events"],
            record_events=False,
        )
        return np.column_stack([done[name] for name in HEADLINE]), done["n_events"][-1]

    return run


def by_scipy(library: Library, start: dict[str, float], tolerance: float) -> tuple[np.ndarray, float]:
    with exchange(library, **start) as wheel:
        run, read, rows = Run(wheel, tolerance, no_inputs), wheel.reader(HEADLINE), []
        for t in TIMES:
            run.to(t)
            rows.append(read())
    return np.array(rows), len(run.events)


SOLVERS = {
    "co-simulation": by_fmpy("CoSimulation"),
    "model exchange, FMPy's CVODE": by_fmpy("ModelExchange"),
    "model exchange, SciPy's DOP853": by_scipy,
}


@part(3)
def model_exchange(report: Report) -> None:
    """model exchange beside co-simulation"""
    rows: list[Row] = []
    for scene, start in SCENES.items():
        want = true_headline(scene)
        for solver, solve in SOLVERS.items():
            for tolerance in (1e-6, 1e-8, 1e-10):
                spent = []
                for _ in range(REPEATED):
                    before = perf_counter()
                    got, events = solve(report.library, start, tolerance)
                    spent.append(perf_counter() - before)
                row = {
                    "scene": scene,
                    "solver": solver,
                    "tolerance": tolerance,
                    "error / range": range_error(got, want),
                }
                rows.append({**row, "transitions": int(events), "ms": 1e3 * min(spent)})
    report.table("exchange", rows)


def true_headline(scene: str) -> np.ndarray:
    table = read_table(f"paper_{scene}")
    return np.column_stack([table[name] for name in HEADLINE])
