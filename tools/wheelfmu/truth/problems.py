"""The three scenes of docs/benchmark.md, and how far a solution is from the reference values."""

import csv

import numpy as np
from numpy.typing import NDArray

from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.errors import instants_error, over_range
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.reference import Solution, solve
from wheelfmu.truth.scenes import Scene
from wheelfmu.truth.schedule import Schedule

OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
INSTANTS = tuple(range(1, 11))  # s
DATA = ROOT / "docs" / "results" / "data"
PROBLEMS = {
    "free": Scene(),
    "friction": Scene({"s": 0.03}),
    "driven": Scene({"J_x": 0.8, "J_y": 1.0}, inputs=Schedule(((0.0, {"M_3": (0.0, -1.0, 0.1)}),))),
}


def by_fmu(library: Library, scene: Scene, tolerance: float) -> Run:
    return library.simulate([0.0, *INSTANTS], tolerance, scene.inputs, **scene.start)


def by_reference(scene: Scene, tolerance: float) -> Solution:
    return solve(scene.wheel, scene.motion, [0.0, *INSTANTS], scene.inputs.for_reference(), rtol=tolerance)


def rows(name: str) -> list[dict[str, str]]:
    with (DATA / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return [*csv.DictReader(file)]


def table(name: str) -> NDArray[np.float64]:
    """The reference values, a row for each instant."""
    return np.array([[float(row[output]) for output in OUTPUTS] for row in rows("benchmark") if row["scene"] == name])


def transitions(name: str) -> list[tuple[float, int]]:
    """Instant, and sign of omega_z after it."""
    if name != "friction":
        return []
    return [(float(t), int(mode)) for t, mode in (row.values() for row in rows("benchmark_transitions"))]


def errors(name: str, found: Run | Solution) -> tuple[float, float | None]:
    """Largest error of an output relative to its range, and of a transition, s (infinite if one is missing)."""
    want, known = table(name), transitions(name)
    error = over_range(np.column_stack([found[output][1:] for output in OUTPUTS]), want)
    if not known:
        return error, None
    return error, instants_error([event for event in found.events if event[0] > 0], known)
