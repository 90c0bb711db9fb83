"""Characteristic values that tests of road vehicles report: steady circle, step of the steering, double lane change.

In the manner of ISO 4138 (constant steer angle, rising speed), ISO 7401 (step input), ISO 3888 (two changes of lane);
steer angles are those of the bicycle's wheel, not of a steering wheel. A table has time, v, omega, psi, roll, delta,
a_y and beta, and the ground's forces on each wheel.
"""

from __future__ import annotations

import numpy as np

from .car import WHEELBASE, WHEELS, X_REAR, G, axle_friction, worst
from .car_judges import INERTIA, LEANING, Finding

Table = dict[str, np.ndarray]


def roll_stiffness() -> float:
    """N m/rad, of struts and anti-roll bars, per angle of the chassis on wheels that stand on the ground."""
    struts = sum(w["k"] * w["y"] ** 2 for w in WHEELS.values())
    return struts + sum(w["k_bar"] * (w["y"] - WHEELS[w["bar_to"]]["y"]) ** 2 for w in WHEELS.values() if "bar_to" in w)


def roll_gradient() -> float:
    """Roll angle per lateral acceleration, rad s2/m: the chassis leans outwards by its height, the contact inwards."""
    return INERTIA / (roll_stiffness() - G * LEANING)


def circle(table: Table) -> list[Finding]:
    """Gradients over lateral acceleration while the speed rises at a constant steer angle."""
    steady = (table["time"] > 5.0) & (table["time"] < 22.0)
    a, kappa = table["a_y"][steady], (table["omega"] / table["v"])[steady]

    def gradient(y: np.ndarray) -> float:
        return float(np.polyfit(a, y, 1)[0])

    delta, beta = table["delta"][steady], table["beta"][steady]
    return [
        Finding("largest lateral acceleration", "m/s2", float(a.max())),
        Finding("understeer gradient", "rad s2/m", gradient(delta - np.arctan(WHEELBASE * kappa)), 0.0),
        Finding("gradient of the curvature", "s2/m2", gradient(kappa), 0.0),
        Finding("sideslip angle where the speed is least", "rad", *_drift(beta[0], delta[0])),
        Finding("gradient of the sideslip angle", "rad s2/m", gradient(beta), 0.0),
        Finding("gradient of the roll angle", "rad s2/m", gradient(table["roll"][steady]), roll_gradient()),
    ]


def _drift(beta: float, delta: float) -> tuple[float, float]:
    """Measured sideslip angle at the centre of mass, and that of a rear axle without any."""
    return float(beta), float(np.arctan(-X_REAR * np.tan(delta) / WHEELBASE))


def _first(t: np.ndarray, x: np.ndarray, level: float) -> float:
    """When a rising signal first reaches a level, between samples by a straight line."""
    i = int(np.argmax(x >= level))
    return float(t[i - 1] + (level - x[i - 1]) / (x[i] - x[i - 1]) * (t[i] - t[i - 1]))


def step(table: Table) -> list[Finding]:
    """Response times from the instant at which the steering has gone half its way, overshoot and gains."""
    t, last = table["time"], table["time"] > table["time"][-1] - 0.5
    end = {name: float(np.mean(table[name][last])) for name in ("delta", "v", "omega", "a_y", "roll")}
    angle = end["delta"]
    half, tenth, most = (_first(t, table["delta"], share * angle) for share in (0.5, 0.1, 0.9))
    yaw = end["v"] * np.tan(angle) / WHEELBASE
    theory = {"omega": yaw, "a_y": end["v"] * yaw, "roll": roll_gradient() * end["v"] * yaw}
    found = [Finding("time of the steer angle from 10 to 90 %", "s", most - tenth)]
    for name, what in (("omega", "yaw rate"), ("a_y", "lateral acceleration"), ("roll", "roll angle")):
        x, level, unit = table[name], end[name], {"omega": "1/s", "a_y": "m/s2/rad", "roll": "1"}[name]
        peak = int(np.argmax(x))
        found += [
            Finding(f"gain of the {what}", unit, level / angle, float(theory[name] / angle)),
            Finding(f"response time of the {what} (90 %)", "s", _first(t, x, 0.9 * level) - half),
            Finding(f"time to the peak of the {what}", "s", float(t[peak]) - half),
            Finding(f"overshoot of the {what}", "1", float(x[peak]) / level - 1),
        ]
    return found


def lane(table: Table) -> list[Finding]:
    """How hard the change of lanes is, and where it asks most of the road."""
    axle, at = worst(table)
    return [
        Finding("largest lateral acceleration", "m/s2", float(np.abs(table["a_y"]).max())),
        Finding("largest yaw rate", "rad/s", float(np.abs(table["omega"]).max())),
        Finding("largest roll angle", "rad", float(np.abs(table["roll"]).max())),
        Finding(f"largest friction required, at the {axle} axle", "1", float(axle_friction(table, axle)[at])),
        Finding("where: rear point, X", "m", float(table["X_R"][at])),
        Finding("when", "s", float(table["time"][at])),
    ]


FIGURES = {"circle": circle, "step": step, "lane": lane}
