"""What the reports judge by: the independent reference of truth/reference, whose solutions are kept."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.truth.kept import kept
from wheelfmu.truth.motion import Run
from wheelfmu.truth.reference import Inputs, Solution, solve
from wheelfmu.truth.scenes import Scene

Array = NDArray[np.float64]
Solve = Callable[..., tuple[float, Array, dict[str, int]]]  # seconds, headline outputs on a grid, counts


def headline(scene: Scene, points: int, label: str = "", inputs: Inputs | None = None) -> Array:
    """The headline outputs at `points` instants of equal spacing. label: names inputs that are given as functions."""
    times = np.linspace(0, scene.duration, points)
    if scene.start.get("friction_law") == "regularized":
        return columns(scene.solved_stiffly(times))
    given = inputs or scene.inputs.for_reference()

    def solution() -> Array:
        return columns(solve(scene.wheel, scene.motion, times.tolist(), given, rtol=1e-13))

    return kept(("headline", scene, points, label), solution)


def columns(run: Run | Solution) -> Array:
    return np.column_stack([run[name] for name in HEADLINE])
