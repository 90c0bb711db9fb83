"""What the axle teaches: error against the communication step and against the stiffness, limits, energy per bond."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from . import axle, bonds, errors, options
from .axle import CONNECTIONS, WHEELS, Scene, components, coupled, rigid
from .master import Master

STRAIGHT = Scene(M_left=30.0, M_right=30.0)
CLOTHOID = Scene(M_left=24.0, M_right=30.0, v=1.0)
TRAILING = Scene(a=0.2, v=-0.5, omega=2.0)
ROLLING_OUT = Scene(s=0.03, v=2.0, omega=1.0)
SCENES = dict(zip(options.SCENES, (STRAIGHT, CLOTHOID, TRAILING, ROLLING_OUT), strict=True))
STIFFNESSES = (1.0, 2.0, 4.0, 8.0)
LIMIT_STEPS = (0.00025, 0.0005, 0.00075, 0.001, 0.0015, 0.002, 0.003, 0.004, 0.006, 0.008, 0.012, 0.016)  # s
GRID = 0.048  # s, which all of them divide


distance = partial(errors.distance, names=axle.COMPARED)


def step_errors(
    fmus: dict[str, Path], scene: Scene, exchange: str, steps: tuple[float, ...] = errors.STEPS, grid: float = 0.02
) -> list[float]:
    """Error against h at this stiffness: the truth is the run with rollback at a quarter of the smallest step."""
    truth = coupled(fmus, scene, min(steps) / 4, "rollback", grid)
    return [distance(coupled(fmus, scene, h, exchange, grid), truth) for h in steps]


def stiffness_errors(
    fmus: dict[str, Path], scene: Scene, factors: tuple[float, ...] = STIFFNESSES, step: float = 0.0005
) -> list[float]:
    """Error against the closed form of the rigid axle, with a step small enough for it not to matter."""
    found = []
    for factor in factors:
        table = coupled(fmus, replace(scene, stiffness=factor), step, "rollback", 0.02)
        found.append(distance(table, rigid(scene, table["time"])))
    return found


@dataclass(frozen=True)
class Energy:
    """Energy added over a run, J: by wheel and bond; and what the sum of all energies says."""

    bonds: dict[str, np.ndarray]
    drift: float


def energy(fmus: dict[str, Path], scene: Scene, step: float, exchange: str) -> Energy:
    """Of a scene without drive and rolling friction, in which all energy is in the wheels, the beam and its dampers."""
    with Master(components(fmus, scene), CONNECTIONS) as master:
        counted = master.run(scene.stop, step, bonds.record("axle", WHEELS), exchange)
    table = coupled(fmus, scene, step, exchange, step)
    total = sum(table[f"{wheel}.E"] for wheel in WHEELS) + table["E"] + table["W_loss"]
    return Energy(bonds.added(counted, "axle", WHEELS, step, exchange == "derivatives"), float(total[-1] - total[0]))


def longest_step(fmus: dict[str, Path], scene: Scene, exchange: str) -> float:
    """Of LIMIT_STEPS, s."""
    truth = rigid(scene, np.arange(int(scene.stop / GRID) + 1) * GRID)
    scene = replace(scene, stop=float(truth["time"][-1]))
    return errors.longest(LIMIT_STEPS, lambda h: distance(coupled(fmus, scene, h, exchange, GRID), truth))
