"""What inputs cost and how exact they are: the free wheel pushed by six sines, or by constants, in steps of 1 ms."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pandas as pd
from reference import Inputs
from support.scenes import SCENES, SINES, sines

from .native import Array, Task
from .page import Report, part
from .speed import master_of, sine_table
from .truth import kept_headline, range_error

STEP, EVERY = 1e-3, 100  # s; steps between compared instants
CONSTANT = sines(1.0)


def forces(values: Callable[[float], tuple[float, ...]]) -> Inputs:
    return Inputs(lambda t: values(t)[:3], lambda t: values(t)[3:])


TRUTHS = {"none": Inputs(), "constant": forces(lambda _t: CONSTANT), "sines": forces(sines)}


def cases(steps: int) -> dict[str, tuple[str, Array | None]]:
    """How the inputs are given: what judges it, and the table of the master."""
    return {
        "never set": ("none", None),
        "constant, set at every step": ("constant", np.tile(CONSTANT, (steps, 1, 1))),
        "sines, held over the step": ("sines", sine_table(steps, 0)),
        "sines, held at their value in mid-step": ("sines", sine_table(steps, 0, STEP / 2)),
        "sines, first derivative given": ("sines", sine_table(steps, 1)),
        "sines, derivatives up to order 2": ("sines", sine_table(steps, 2)),
        "sines, derivatives up to order 3": ("sines", sine_table(steps, 3)),
    }


@part(20)
def cost(report: Report) -> None:
    """what inputs cost, and their error"""
    scene = replace(SCENES["free"], duration=2.0 if report.quick else 10.0)
    steps, master, rows = round(scene.duration / STEP), master_of(report), []
    for name, (judge, table) in cases(steps).items():
        want = kept_headline(scene, steps // EVERY + 1, judge, TRUTHS[judge])
        for method in ("automatic", "adams", "bdf"):
            names = () if table is None else tuple(SINES)
            task = Task({**scene.start, "method": method}, STEP, steps, inputs=names, table=table)
            done = master.run(task, 0.05)
            row = {"inputs": name, "method": method}
            row |= {what: done.counters[f"n_{what}"] for what in ("steps", "rhs", "restarts")}
            row["µs per step"] = 1e6 * done.best / steps if done.reached else np.nan
            rows.append(row | {"error / range": range_error(done.rows[::EVERY], want) if done.reached else np.inf})
    report.table("cost", rows)
    at = pd.DataFrame(rows).query("method == 'automatic'").set_index("inputs")
    error = at["error / range"]
    report.figures(held=error["sines, held over the step"], linear=error["sines, first derivative given"])
    report.figures(never=1e3 * at["µs per step"]["never set"], again=at["restarts"]["constant, set at every step"])
