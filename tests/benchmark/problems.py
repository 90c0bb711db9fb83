"""The three scenes of docs/benchmark.md, and how far a solution is from the reference values."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from reference import Solution, solve
from support.motion import Library, Run
from support.paths import ROOT
from support.scenes import Scene
from support.schedule import Schedule

OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
INSTANTS = tuple(range(1, 11))  # s
RESULTS = ROOT / "docs" / "results"


@dataclass(frozen=True)
class Problem(Scene):
    """decimals: what differs from the paper's free wheel, as decimal numbers; M_3 = linear t + square t^2."""

    decimals: dict[str, str] = field(default_factory=dict)


def problem(**decimals: str) -> Problem:
    numbers = {name: float(value) for name, value in decimals.items()}
    torque = [0.0, numbers.pop("linear", 0.0), numbers.pop("square", 0.0)]
    inputs = Schedule(((0.0, {"M_3": torque}),)) if any(torque) else Schedule()
    return Problem(numbers, 10.0, inputs, decimals)


PROBLEMS = {
    "free": problem(),
    "friction": problem(s="0.03"),
    "driven": problem(J_x="0.8", J_y="1.0", linear="-1", square="0.1"),
}


def by_fmu(library: Library, scene: Problem, tolerance: float) -> Run:
    return library.simulate([0.0, *INSTANTS], tolerance, scene.inputs, **scene.start)


def by_reference(scene: Problem, tolerance: float) -> Solution:
    return solve(scene.wheel, scene.motion, [0.0, *INSTANTS], scene.inputs.for_reference(), rtol=tolerance)


def table(name: str, folder: Path = RESULTS) -> NDArray[np.float64]:
    """The reference values, a row for each instant."""
    return pd.read_csv(folder / "data" / f"benchmark_{name}.csv")[list(OUTPUTS)].to_numpy()


def transitions(name: str, folder: Path = RESULTS) -> list[tuple[float, int]]:
    """Instant, and sign of omega_z after it."""
    path = folder / "data" / f"benchmark_{name}_transitions.csv"
    return [tuple(row) for row in pd.read_csv(path).itertuples(index=False)] if path.exists() else []


def errors(name: str, found: Run | Solution, folder: Path = RESULTS) -> tuple[float, float | None]:
    """Largest error of an output relative to its range, and of a transition, s (infinite if one is missing)."""
    want, known = table(name, folder), transitions(name, folder)
    rows = np.column_stack([found[output][1:] for output in OUTPUTS])
    error = float((np.abs(rows - want).max(axis=0) / np.ptp(want, axis=0)).max())
    if not known:
        return error, None
    events = [event for event in found.events if event[0] > 0]
    if [mode for _, mode in events] != [mode for _, mode in known]:
        return error, np.inf
    return error, float(max(abs(a - b) for (a, _), (b, _) in zip(events, known, strict=True)))
