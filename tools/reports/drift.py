"""How far the multibody formulation, (24), drifts off its constraints: (19) in velocity, (32) in height; fixed axes.

Residuals from the outputs alone: |v_O - omega x arm| over the largest speed of a point of the wheel, and
|Z_O - (r_0 sin theta + r)| over r_0 + r.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from reference import Wheel
from robustness.case import brushing, tilted
from support.driver import Values
from support.motion import Library, Run, run
from support.scenes import wheel_of

HOUR = 3600.0
TOLERANCE = 1e-8  # a residual is an error of the solution like any other, so it may be as large as the tolerance
CASES: dict[str, tuple[Values, float]] = {
    "free wheel, 10 s": ({}, 10.0),
    "friction, 10 s": ({"s": 0.03}, 10.0),
    "J_x = 2 J_y, friction, 10 s": ({"J_x": 1.8, "J_y": 0.9, "s": 0.03}, 10.0),
    "brushing theta = 0.1 deg, 10 s": (brushing(0.1), 10.0),
    "spin 1000 rad/s, 1 s": (tilted(84.0, phi_dot_start=-1e3), 1.0),
    "past upright, 170 deg, 10 s": (tilted(170.0), 10.0),
    "free wheel, 1 h": ({}, HOUR),
    "friction, 1 h": ({"s": 0.03}, HOUR),
    "J_x = 2 J_y, friction, 1 h": ({"J_x": 1.8, "J_y": 0.9, "s": 0.03}, HOUR),
}


@dataclass
class Drift:
    """Residuals over time."""

    name: str
    t: np.ndarray
    velocity: np.ndarray
    height: np.ndarray

    @property
    def worst(self) -> float:
        return float(max(self.velocity.max(), self.height.max()))


def residuals(wheel: Wheel, found: Run) -> tuple[np.ndarray, np.ndarray]:
    s, c = np.sin(found["theta"]), np.cos(found["theta"])
    along = wheel.r * c * found["psi_dot"] * s - (wheel.r_0 + wheel.r * s) * found["omega_z"]
    across = (wheel.r_0 * s + wheel.r) * found["theta_dot"]
    X = found["X_O_dot"] - along * np.cos(found["psi"]) - across * np.sin(found["psi"])
    Y = found["Y_O_dot"] - along * np.sin(found["psi"]) + across * np.cos(found["psi"])
    Z = found["Z_O_dot"] - wheel.r_0 * c * found["theta_dot"]
    height = found["Z_O"] - wheel.r_0 * s - wheel.r
    rates = (found["theta_dot"], found["psi_dot"] * s, found["omega_z"])
    size = wheel.r_0 + wheel.r
    speed = size * max(np.abs(rate).max() for rate in rates)
    return np.sqrt(X**2 + Y**2 + Z**2) / (speed or 1.0), np.abs(height) / size


def study(library: Library, tolerance: float = TOLERANCE) -> list[Drift]:
    found = []
    for name, (values, duration) in CASES.items():
        times = np.linspace(0.0, duration, 361)
        done = run(library, {**values, "formulation": "multibody"}, times, tolerance)
        found.append(Drift(name, done["t"], *residuals(wheel_of(values), done)))
    return found
