"""The reference of each scene, and its own error: tests/reference (Newton-Euler with a quaternion, all reactions
unknown; shares nothing with the product) at two tolerances. Solved once and kept beside the build."""

from __future__ import annotations

import hashlib
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .builds import ROOT
from .scenes import HEADLINE, POINTS, Scene

sys.path.insert(0, str(ROOT / "tests"))
from reference import Start, Wheel, solve  # noqa: E402


@dataclass(frozen=True)
class Reference:
    rows: np.ndarray  # POINTS x 4, the headline outputs
    error: float  # largest difference between the two tolerances, relative to each output's range


def solve_at(scene: Scene, rtol: float) -> np.ndarray:
    v = scene.values
    wheel = Wheel(**{name: v[name] for name in ("m", "r_0", "r", "J_x", "J_y", "J_z", "g", "s")})
    angles = ("psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "X_O", "Y_O")
    start = Start(**{name: v[f"{name}_start"] for name in angles})
    law = {"friction": ("regularized", v["omega_s"]), "method": "Radau"} if scene.regularized else {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of Radau's difference quotients
        solution = solve(wheel, start, np.linspace(0, scene.stop, POINTS), rtol=rtol, **law)
    return np.column_stack([solution[name] for name in HEADLINE])


def reference_of(scene: Scene, folder: Path) -> Reference:
    text = repr((sorted(scene.values.items()), scene.stop, POINTS))
    sources = sorted((ROOT / "tests" / "reference").glob("*.py"))
    digest = hashlib.sha256(text.encode() + b"".join(p.read_bytes() for p in sources)).hexdigest()[:16]
    path = folder / f"reference_{scene.name}_{digest}.npz"
    if not path.exists():
        loose, tight = (1e-10, 1e-11) if scene.regularized else (1e-12, 1e-13)
        np.savez(path, rough=solve_at(scene, loose), fine=solve_at(scene, tight))
    with np.load(path) as table:
        rough, fine = table["rough"], table["fine"]
    error = float((np.abs(rough - fine).max(axis=0) / np.ptp(fine, axis=0)).max())
    return Reference(fine, max(error, 1e-15))
