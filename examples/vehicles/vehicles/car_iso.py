"""What tests of road vehicles report of a run, as figures: steady circle, step of the steering, double lane change.

In the manner of ISO 4138 (constant steer angle, rising speed), ISO 7401 (step input), ISO 3888 (two changes of lane);
steer angles are those of the bicycle's wheel, not of a steering wheel. A table has time, v, omega, psi, roll, delta,
a_y and beta, and mu_required of each wheel; `complete` adds a_y and beta to one of the coupled car.
"""

from __future__ import annotations

import numpy as np

from .car import MASS, NAMES, WHEELBASE, WHEELS, X_REAR, G, worst
from .car_judges import INERTIA, LEANING, Finding

Table = dict[str, np.ndarray]


def complete(table: Table) -> Table:
    """With a_y, the acceleration of the whole car's centre of mass to the left of the heading [m/s2], from the ground's
    forces, and beta, the sideslip angle of the chassis' centre of mass [rad], from differences of its place."""
    c, s = np.cos(table["psi"]), np.sin(table["psi"])
    forces = [sum(table[f"{w}.lambda_{k}"] for w in WHEELS) / MASS for k in (1, 2)]
    moved = [np.gradient(table[n], table["time"], edge_order=2) for n in ("X", "Y")]
    beta = np.arctan2(c * moved[1] - s * moved[0], np.abs(c * moved[0] + s * moved[1]))
    return {**table, "a_y": c * forces[1] - s * forces[0], "beta": beta}


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
    wheel, at = worst(table)
    return [
        Finding("largest lateral acceleration", "m/s2", float(np.abs(table["a_y"]).max())),
        Finding("largest yaw rate", "rad/s", float(np.abs(table["omega"]).max())),
        Finding("largest roll angle", "rad", float(np.abs(table["roll"]).max())),
        Finding(f"largest mu_required, at the {NAMES[wheel]} wheel", "1", float(table[f"{wheel}.mu_required"][at])),
        Finding("where: rear point, X", "m", float(table["X_R"][at])),
        Finding("when", "s", float(table["time"][at])),
    ]


FIGURES = {"circle": circle, "step": step, "lane": lane}
