"""What the reports judge by: the independent reference of truth/reference, whose solutions are kept."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.truth.kept import kept
from wheelfmu.truth.motion import Run
from wheelfmu.truth.orbit import headline_of, reduced
from wheelfmu.truth.reference import Inputs, Solution, solve
from wheelfmu.truth.reference.modes import rolling
from wheelfmu.truth.reference.motion import initial_state
from wheelfmu.truth.scenes import Scene

Array = NDArray[np.float64]


def headline(scene: Scene, points: int, label: str = "", inputs: Inputs | None = None) -> Array:
    """The headline outputs at `points` instants of equal spacing. label: names inputs that are given as functions."""
    times, given = np.linspace(0, scene.duration, points), inputs or scene.inputs.for_reference()

    def solution() -> Array:
        if scene.start.get("friction_law") == "regularized":
            return stiff(scene, times)
        return columns(solve(scene.wheel, scene.motion, times.tolist(), given, rtol=1e-13))

    return kept(("headline", scene, points, label), solution)


def stiff(scene: Scene, times: Array) -> Array:
    """The regularized law by SciPy's Radau, without inputs."""
    rate, y_0 = rolling(scene.wheel, float(scene.start.get("omega_s", 1e-3))), initial_state(scene.wheel, scene.motion)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of Radau's difference quotients
        found = solve_ivp(rate, (0, scene.duration), y_0, "Radau", times, rtol=1e-11, atol=1e-12)
    return headline_of(np.array([reduced(state) for state in found.y.T]))


def columns(run: Run | Solution) -> Array:
    return np.column_stack([run[name] for name in HEADLINE])
