"""The largest stable communication step of wheels and bodies that exchange held link forces. SI units, numpy and scipy.

A link of stiffness k and damping c acts on one relative displacement, for example of a wheel's O and a body. Links add
up on one wheel and on one body, so with all of them in K and C, and the inertias in M, a step h is stable if the motion
over one step with held forces decays: h < 2 / lambda_max(M^-1 C), and below what the stiffness allows.

A wheel that rolls goes where it heads: sideways at v psi, psi its own turn if it is free, or the yaw angle of the body
that a guided wheel's carrier follows. With weakly damped lateral links that can lower the limit; at a high speed v no
step is stable then, nor the vehicle itself. The spin of a free wheel couples lean and turn:

    (J_x + m R^2) lean'' = M_1 + (J_z + m R^2) v / R turn'        J_x turn'' = M_2 - J_z v / R lean'

python step_limit.py prints two wheels on one body, rolling and sliding, and a free wheel that rolls at speed.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm


@dataclass(frozen=True)
class Wheel:
    """An upright wheel that heads along X. `slides`: locked or spinning, so friction does not follow the motion."""

    slides: bool = False
    guided: bool = False
    v: float = 0.0  # m/s
    follows: str = ""  # the body, of yaw, whose heading the carrier gives to the wheel; else it keeps its own
    m: float = 20.0
    J_x: float = 0.9
    J_z: float = 1.8
    R: float = 0.35  # r_0 + r

    def inertias(self):
        """By degree of freedom. Rolling: along X (with its spin), lean (with Y), turn; guided, the first alone."""
        if self.slides:
            path, lean = {"X": self.m, "Y": self.m, "spin": self.J_z}, self.J_x
        else:
            path, lean = {"X": self.m + self.J_z / self.R**2}, self.J_x + self.m * self.R**2
        return path if self.guided else path | {"lean": lean, "turn": self.J_x}

    def moves(self, direction):
        """The degrees of freedom by which a direction (X, Y, spin, lean or turn) moves, with their ratios."""
        across = {"track": 1.0} if self.guided else {"track": 1.0, "lean": -self.R}
        rolls = {"spin": {"X": -1 / self.R}, "Y": across}
        return {direction: 1.0} if self.slides else rolls.get(direction, {direction: 1.0})

    def gyroscopic(self):
        """Factors of the rates in the accelerations: (of, by): of turn' in lean'', of lean' in turn''."""
        if self.slides or self.guided:
            return {}
        spin = self.v / self.R  # rad/s
        lean, J_z = self.J_x + self.m * self.R**2, self.J_z
        return {
            ("lean", "turn"): (J_z + self.m * self.R**2) * spin / lean,
            ("turn", "lean"): -J_z * spin / self.J_x,
        }


def step_limit(wheels, bodies, links):
    """Largest stable step, s; 0 if none is. `wheels`: Wheel by name. `bodies`: mass or moment of inertia by name, one
    degree of freedom each. `links`: (k, c, first end, second end). An end is (wheel, direction), a body, None for the
    ground, or {body: ratio, ...} where it moves with several, as on a body that moves and yaws."""
    inertia = {(name, dof): J for name, wheel in wheels.items() for dof, J in wheel.inertias().items()} | bodies
    tracks = [(name, "track") for name, wheel in wheels.items() if not wheel.slides]
    place = {name: i for i, name in enumerate([*inertia, *tracks])}
    K, C = np.zeros((2, len(place), len(place)))
    for k, c, *ends in links:
        row = np.zeros(len(place))
        for sign, end in zip((1, -1), ends, strict=True):
            if isinstance(end, tuple):
                end = {(end[0], dof): ratio for dof, ratio in wheels[end[0]].moves(end[1]).items()}
            for name, ratio in (end if isinstance(end, dict) else {end: 1.0} if end else {}).items():
                row[place[name]] += sign * ratio
        K, C = K + k * np.outer(row, row), C + c * np.outer(row, row)
    n, M = len(inertia), np.array([*inertia.values()])[:, None]
    K, C, E = K[:n] / M, C[:n] / M, np.eye(len(place), n)
    heads, G = np.zeros((len(place), len(place))), np.zeros((n, n))  # x' = E v + heads x: a track has no inertia
    for name, wheel in wheels.items():
        leads = wheel.follows if wheel.guided else (name, "turn")
        if (name, "track") in tracks and leads:
            heads[place[name, "track"], place[leads]] = wheel.v
        for (of, by), factor in wheel.gyroscopic().items():
            G[place[name, of], place[name, by]] = factor
    K, C = K + C @ heads, C @ E
    rates = np.linalg.eigvals(np.block([[heads, E], [-K, G - C]]))  # of the motion itself, 1/s
    size = np.abs(rates)
    if np.any((size > 1e-6 * size.max()) & (rates.real > -1e-9 * size)):
        return 0.0  # something swings undamped, or grows

    def grows(h):
        """Over one step of h, with the links' accelerations -K x - C v held."""
        nothing, held = np.zeros((n, len(place) + 2 * n)), np.vstack([np.zeros((len(place), n)), np.eye(n)])
        moves = expm(h * np.vstack([np.hstack([np.block([[heads, E], [np.zeros(K.shape), G]]), held]), nothing]))
        size = len(place) + n
        step = moves[:size, :size] - moves[:size, size:] @ np.hstack([K, C])
        return np.abs(np.linalg.eigvals(step)).max() > 1 + 1e-7  # a double 1, free motion, is rounded by 1e-8

    steps = np.linspace(0, 2 / np.linalg.eigvals(C).real.max() * (1 + 1e-9), 201)
    first = next((i for i, h in enumerate(steps[1:], 1) if grows(h)), 200)
    stable, unstable = steps[first - 1], steps[first]
    for _ in range(40):
        h = (stable + unstable) / 2
        stable, unstable = (stable, h) if grows(h) else (h, unstable)
    return stable


if __name__ == "__main__":
    for slides in (False, True):
        wheels = {"left": Wheel(slides), "right": Wheel(slides)}
        links = [(2e5, 4e3, (wheel, "X"), "body") for wheel in wheels]
        h = step_limit(wheels, {"body": 300.0}, links)
        print(f"Two wheels on bushings that {'slide' if slides else 'roll'}: h < {1e3 * h:.2f} ms.")
    free = [(2000.0, 60.0, ("wheel", "lean"), None), (2000.0, 60.0, ("wheel", "turn"), None)]
    for v in (0.0, 30.0):
        h = step_limit({"wheel": Wheel(v=v)}, {}, free)
        print(f"A free wheel at {v:g} m/s, held upright and straight: h < {1e3 * h:.2f} ms.")
