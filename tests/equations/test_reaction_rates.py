"""d lambda/dt of both formulations against differences of lambda along the motion.

The difference moves the state along its derivative and the load along its rate, and is
extrapolated (Richardson, h and h/2 and h/4: order 6). Fixed axes, N/s.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from support import equations as eq

from equations import random_scenes

BOUND = 1e-9  # relative to the row's largest rate and force per second
FORMULATIONS = pytest.mark.parametrize("formulation", [eq.REDUCED, eq.MULTIBODY], ids=["reduced", "multibody"])
KINDS = pytest.mark.parametrize("kind", range(4), ids=["free", "rolling", "held", "regularized"])


class Rows:
    """Gentle random states: no corner of the friction law (N = 0) within a difference."""

    def __init__(self, formulation: eq.Formulation, kind: int, rows: int = 2000) -> None:
        random = np.random.default_rng(8)
        self.formulation = formulation
        scenes = random_scenes.scenes(random, kind, formulation is eq.REDUCED, rows)
        scenes["friction"]["omega_s"] = random.uniform(2, 10, rows)
        scenes["wheel"]["g"] = 9.81
        scenes["loaded"] = 1
        motions = random_scenes.motions(random, rows)
        motions["theta"] = random.uniform(0.6, np.pi - 0.6, rows)
        for rate in ("psi_dot", "theta_dot", "phi_dot"):
            motions[rate] *= 0.2
        y = eq.start_each(formulation, scenes, motions)
        force = eq.dynamics_each(formulation, scenes, y)["lambda_"]
        clear = np.abs(force[:, 2]) > 0.1 * np.abs(force).max(axis=1)
        self.scenes, self.y = scenes[clear], y[clear]
        self.load_dot = self.scenes["load"].copy()
        for part in ("F", "M"):
            self.load_dot[part] *= random.normal(size=self.load_dot[part].shape)
        self.size = np.abs(force[clear]).max(axis=1, keepdims=True)

    def rates(self) -> np.ndarray:
        return eq.reaction_rates_each(self.formulation, self.scenes, self.load_dot, self.y)

    def forces_after(self, time: float) -> np.ndarray:
        y_dot, _ = eq.derivative_each(self.formulation, self.scenes, self.y)
        scenes = self.scenes.copy()
        for part in ("F", "M"):
            scenes["load"][part] += time * self.load_dot[part]
        return eq.dynamics_each(self.formulation, scenes, self.y + time * y_dot)["lambda_"]

    def differences(self, h: float = 4e-4) -> np.ndarray:
        central = [(self.forces_after(step) - self.forces_after(-step)) / (2 * step) for step in (h, h / 2, h / 4)]
        finer = [(4 * b - a) / 3 for a, b in pairwise(central)]
        return (16 * finer[1] - finer[0]) / 15

    def error(self, rates: np.ndarray) -> float:
        found = self.differences()
        return float((np.abs(rates - found) / (self.size + np.abs(found))).max())


@FORMULATIONS
@KINDS
def test_reaction_rates_are_the_slope_of_the_reactions_along_the_motion(formulation: eq.Formulation, kind: int) -> None:
    rows = Rows(formulation, kind)
    assert len(rows.y) > 1500
    assert rows.error(rows.rates()) < BOUND  # measured 1.5e-11 to 2.6e-11
    still = rows.rates()
    rows.load_dot["F"] *= 1 + 1e-4
    assert rows.error(still) > 10 * BOUND  # the rate of the load counts: 2e-5


def both(scenes: np.ndarray, motions: np.ndarray, load_dots: np.ndarray) -> list[np.ndarray]:
    """Rates by the reduced and by the multibody formulation."""
    return [
        eq.reaction_rates_each(f, scenes, load_dots, eq.start_each(f, scenes, motions))
        for f in (eq.REDUCED, eq.MULTIBODY)
    ]


@KINDS
def test_both_formulations_give_the_same_reaction_rates(kind: int) -> None:
    random = np.random.default_rng(9)
    scenes, motions = random_scenes.scenes(random, kind), random_scenes.motions(random)
    load_dots = scenes["load"].copy()
    load_dots["F"] *= 10
    reduced, multibody = both(scenes, motions, load_dots)
    size = np.abs(multibody).max(axis=1, keepdims=True)
    assert (np.abs(reduced - multibody) / size).max() < 1e-11  # measured 1.4e-13
    scenes["wheel"]["J_x"] *= 1 + 1e-9
    disturbed, _ = both(scenes, motions, load_dots)
    assert (np.abs(disturbed - multibody) / size).max() > 1e-10  # 2.5e-8


STILL_OR_STRAIGHT = {
    "the paper's start": eq.Motion(np.pi / 2, 5 * np.pi / 12, 0, 0, 0, -2, -0.0776, 0),
    "upright straight rolling": eq.Motion(0, np.pi / 2, 0, 0, 0, -2, 0, 0),
    "tilted, at rest": eq.Motion(0, 1.2, 0, 0, 0, 0, 0, 0),
    "tilted, turning": eq.Motion(0, 1.2, 0, 1, 0, -2, 0, 0),
}


@pytest.mark.parametrize("motion", STILL_OR_STRAIGHT.values(), ids=STILL_OR_STRAIGHT.keys())
@pytest.mark.parametrize("kind", [eq.FRICTIONLESS, eq.ROLLING, eq.HELD])
def test_entries_that_are_zero_for_an_instant_keep_their_rates(motion: eq.Motion, kind: int) -> None:
    scene = eq.scene(eq.paper_wheel(s=0.03), kind, -1)
    load_dot = eq.Load((1, 2, 3), (0.1, 0.2, 0.3))
    reduced, multibody = (
        eq.reaction_rates(f, scene, eq.start(f, scene.wheel, motion), load_dot) for f in (eq.REDUCED, eq.MULTIBODY)
    )
    assert np.abs(reduced - multibody).max() < 1e-12  # measured 1.4e-14
    unloaded = eq.reaction_rates(eq.REDUCED, scene, eq.start(eq.REDUCED, scene.wheel, motion))
    assert np.abs(unloaded - multibody).max() > 0.1


def test_a_load_without_a_rate_is_a_constant_load() -> None:
    rows = Rows(eq.REDUCED, eq.FRICTIONLESS, 20)
    changing = rows.rates()
    rows.load_dot = np.zeros_like(rows.load_dot)
    wheel_rates = [
        eq.reaction_rates(eq.REDUCED, eq.Scene.from_buffer_copy(scene), y)
        for scene, y in zip(rows.scenes, rows.y, strict=True)
    ]
    assert (np.array(wheel_rates) == rows.rates()).all()
    assert (changing != rows.rates()).all()
