"""Cost and accuracy of inputs, for `speed`: the free wheel pushed by six sines, or by constants, in steps of 1 ms."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from reference import Inputs
from support.scenes import SCENES, sines

from .native import repeated
from .page import Report, Row, part
from .speed import sine_table
from .truth import headline, range_error

STEP, EVERY = 1e-3, 100  # s; steps between compared instants
CONSTANT = sines(1.0)


def halves(inputs: Any) -> Inputs:
    """Forces and moments out of all six."""
    return Inputs(lambda t: inputs(t)[:3], lambda t: inputs(t)[3:])


TRUTHS = {"none": Inputs(), "constant": halves(lambda _t: CONSTANT), "sines": halves(sines)}
# How the inputs are given: what judges it, and the table of the master, of so many steps.
CASES = {
    "never set": ("none", lambda steps: None),
    "constant, set at every step": ("constant", lambda steps: np.tile(CONSTANT, (steps, 1, 1))),
    "sines, held over the step": ("sines", lambda steps: sine_table(steps, 0)),
    "sines, held at their value in mid-step": ("sines", lambda steps: sine_table(steps, 0, STEP / 2)),
    "sines, first derivative given": ("sines", lambda steps: sine_table(steps, 1)),
    "sines, derivatives up to order 2": ("sines", lambda steps: sine_table(steps, 2)),
    "sines, derivatives up to order 3": ("sines", lambda steps: sine_table(steps, 3)),
}


@part(20, {"inputs": CASES, "method": ("automatic", "adams", "bdf")})
def inputs(report: Report, case: tuple, method: str) -> Row:
    """cost of inputs, and their error"""
    scene, (judge, table_of) = replace(SCENES["free"], duration=2.0 if report.quick else 10.0), case
    steps = round(scene.duration / STEP)
    want = headline(scene, steps // EVERY + 1, judge, TRUTHS[judge])
    solve = report.master.made({"method": method}, STEP, steps, None, table_of(steps))
    try:
        costs, rows, counts = repeated(solve, 0.05)
    except RuntimeError:
        return {"µs per step": np.nan, "error / range": np.inf}
    found = {name: counts[name] for name in ("steps", "rhs", "restarts")}
    return found | {"µs per step": 1e6 * min(costs) / steps, "error / range": range_error(rows[::EVERY], want)}
