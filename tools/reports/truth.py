"""What the reports judge by: the independent reference of tests/reference, solved once and kept in build/report."""

from __future__ import annotations

import hashlib
import warnings
from pathlib import Path

import numpy as np
from reference import Inputs, solve
from support.driver import HEADLINE
from support.paths import ROOT
from support.scenes import Scene

from .native import Array, work_folder


def headline(scene: Scene, points: int, rtol: float = 1e-13, inputs: Inputs | None = None) -> Array:
    """The headline outputs at `points` instants of equal spacing. inputs: those of the scene unless given."""
    law: dict[str, object] = {}
    if scene.start.get("friction_law") == "regularized":
        law = {"friction": ("regularized", scene.start.get("omega_s", 1e-3)), "method": "Radau"}
        rtol = max(rtol, 1e-11)
    times = np.linspace(0, scene.duration, points)
    given = inputs or scene.inputs.for_reference()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of Radau's difference quotients
        found = solve(scene.wheel, scene.motion, times, given, rtol=rtol, **law)
    return np.column_stack([found[name] for name in HEADLINE])


def kept_headline(scene: Scene, points: int, label: str = "", inputs: Inputs | None = None) -> Array:
    """The same from build/report if it was solved before. label: names inputs that are given as functions."""
    sources = sorted((ROOT / "tests" / "reference").glob("*.py"))
    text = repr((scene, points, label)).encode() + b"".join(Path(p).read_bytes() for p in sources)
    path = work_folder() / f"reference_{hashlib.sha256(text).hexdigest()[:16]}.npy"
    if not path.exists():
        np.save(path, headline(scene, points, inputs=inputs))
    return np.load(path)


def headline_of(states: Array) -> Array:
    """The headline outputs of rows of the reduced state: theta, omega_1, omega_2, omega_3, psi, phi, X_O, Y_O."""
    theta, _, omega_2, omega_3, _, _, X_O, _ = states.T
    psi_dot = omega_2 / np.sin(theta)
    return np.column_stack([X_O, theta, omega_3 - psi_dot * np.cos(theta), psi_dot])


def range_error(rows: Array, want: Array) -> float:
    """Largest difference of a column, relative to its range; infinite where the rows do not match."""
    if rows.shape != want.shape or not np.isfinite(rows).all():
        return np.inf
    return float((np.abs(rows - want).max(axis=0) / np.ptp(want, axis=0)).max())
