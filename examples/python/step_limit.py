"""The largest stable communication step of wheels and bodies that exchange held link forces. SI units, numpy alone.

A link of stiffness k and damping c acts on one relative displacement, for example of a wheel's O and a body. Links add
up on one wheel and on one body, so with all of them in K and C, and the inertias in M, a step h is stable if the motion
over one step with held forces decays: h < 2 / lambda_max(M^-1 C), and below what the stiffness allows.

python step_limit.py prints two wheels on one body, rolling and sliding.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Wheel:
    """An upright wheel that heads along X. `slides`: locked or spinning, so friction does not follow the motion."""

    slides: bool = False
    m: float = 20.0
    J_x: float = 0.9
    J_z: float = 1.8
    R: float = 0.35  # r_0 + r

    def inertias(self):
        """By degree of freedom. A rolling wheel has three: along X (with its spin), lean (with Y), turn."""
        if self.slides:
            return {"X": self.m, "Y": self.m, "spin": self.J_z, "lean": self.J_x, "turn": self.J_x}
        return {"X": self.m + self.J_z / self.R**2, "lean": self.J_x + self.m * self.R**2, "turn": self.J_x}

    def moves(self, direction):
        """The degree of freedom that a direction (X, Y, spin, lean or turn) is, and its ratio."""
        rolls = {"spin": ("X", -1 / self.R), "Y": ("lean", -self.R)}
        return (direction, 1.0) if self.slides else rolls.get(direction, (direction, 1.0))


def step_limit(wheels, bodies, links):
    """Largest stable step, s; 0 if none is. `wheels`: Wheel by name. `bodies`: mass or moment of inertia by name, one
    degree of freedom each. `links`: (k, c, first end, second end). An end is (wheel, direction), a body, None for the
    ground, or {body: ratio, ...} where it moves with several, as on a body that moves and yaws."""
    inertia = {(name, dof): J for name, wheel in wheels.items() for dof, J in wheel.inertias().items()} | bodies
    place = {name: i for i, name in enumerate(inertia)}
    K, C = np.zeros((2, len(place), len(place)))
    for k, c, *ends in links:
        row = np.zeros(len(place))
        for sign, end in zip((1, -1), ends, strict=True):
            if isinstance(end, tuple):
                dof, ratio = wheels[end[0]].moves(end[1])
                end = {(end[0], dof): ratio}
            for name, ratio in (end if isinstance(end, dict) else {end: 1.0} if end else {}).items():
                row[place[name]] += sign * ratio
        K, C = K + k * np.outer(row, row), C + c * np.outer(row, row)
    M = np.diag([*inertia.values()])
    K, C = np.linalg.solve(M, K), np.linalg.solve(M, C)
    zero, identity = np.zeros_like(K), np.eye(len(place))
    rates = np.linalg.eigvals(np.block([[zero, identity], [-K, -C]]))  # of the motion itself, 1/s
    size = np.abs(rates)
    if np.any((size > 1e-6 * size.max()) & (rates.real > -1e-9 * size)):
        return 0.0  # something swings undamped

    def grows(h):
        """Over one step of h: x + h v + h^2 a / 2, v + h a, with a = -K x - C v held."""
        step = np.block([[identity - h**2 / 2 * K, h * identity - h**2 / 2 * C], [-h * K, identity - h * C]])
        return np.abs(np.linalg.eigvals(step)).max() > 1 + 1e-7  # a double 1, free motion, is rounded by 1e-8

    stable, unstable = 0.0, 2 / np.linalg.eigvals(C).real.max()
    for _ in range(50):
        h = (stable + unstable) / 2
        stable, unstable = (stable, h) if grows(h) else (h, unstable)
    return stable


if __name__ == "__main__":
    for slides in (False, True):
        wheels = {"left": Wheel(slides), "right": Wheel(slides)}
        links = [(2e5, 4e3, (wheel, "X"), "body") for wheel in wheels]
        h = step_limit(wheels, {"body": 300.0}, links)
        print(f"Two wheels on bushings that {'slide' if slides else 'roll'}: h < {1e3 * h:.2f} ms.")
