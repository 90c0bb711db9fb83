"""The exact Jacobians d y_dot / d y of both formulations, entry by entry, at random states.

Judges: differences of the product's own derivative (Richardson, order 6) for both formulations, and for the multibody
one a complex step through the numpy transcription of (24), which is exact to rounding and shares no code with it.
Errors of a column are relative to its largest entry and that of y_dot.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from support import equations as eq

from equations import random_scenes
from equations.multibody_transcription import stabilised_rate

ROWS = 1000
FORMULATIONS = pytest.mark.parametrize("formulation", [eq.REDUCED, eq.MULTIBODY], ids=["reduced", "multibody"])
KINDS = pytest.mark.parametrize("kind", range(4), ids=["free", "rolling", "held", "regularized"])
OFF_THE_CONSTRAINTS = np.array([0, 0, 0.1, 0, 0, 0, 0.1, 0.1, 0.1, 0, 0, 0])  # m in Z_O, m/s in the velocity of O
Table = np.ndarray


def draw(formulation: eq.Formulation, kind: int) -> tuple[Table, Table]:
    """Scenes and states, multibody ones off their constraints; no corner of the friction law (N = 0) close by."""
    random = np.random.default_rng(51)
    scenes = random_scenes.scenes(random, kind, formulation is eq.REDUCED, ROWS)
    scenes["friction"]["omega_s"] = random.uniform(2, 10, ROWS)
    motions = random_scenes.motions(random, ROWS)
    motions["theta"] = random.uniform(0.6, np.pi - 0.6, ROWS)
    y = eq.start_each(formulation, scenes, motions)
    if formulation is eq.MULTIBODY:
        y += random.normal(size=y.shape) * OFF_THE_CONSTRAINTS
    _, normal = eq.derivative_each(formulation, scenes, y)
    clear = np.abs(normal) > 0.1 * np.abs(eq.dynamics_each(formulation, scenes, y)["lambda_"]).max(axis=1)
    return scenes[clear], y[clear]


def differences(formulation: eq.Formulation, scenes: Table, y: Table, h: float = 1e-3) -> Table:
    def column(direction: Table) -> Table:
        def central(step: float) -> Table:
            ahead, behind = (eq.derivative_each(formulation, scenes, y + s * direction)[0] for s in (step, -step))
            return (ahead - behind) / (2 * step)

        finer = [(4 * b - a) / 3 for a, b in pairwise([central(h), central(h / 2), central(h / 4)])]
        return (16 * finer[1] - finer[0]) / 15

    return np.stack([column(direction) for direction in np.eye(y.shape[1])], axis=2)


def complex_steps(scenes: Table, y: Table) -> Table:
    step = 1e-40
    columns = [stabilised_rate(scenes, y + 1j * step * direction).imag / step for direction in np.eye(y.shape[1])]
    return np.stack(columns, axis=2)


def error(jacobian: Table, judge: Table, y_dot: Table) -> float:
    size = np.abs(judge).max(axis=1, keepdims=True) + np.abs(y_dot).max(axis=1)[:, None, None]
    return float((np.abs(jacobian - judge) / size).max())


@FORMULATIONS
@KINDS
def test_the_jacobian_is_the_slope_of_the_derivative_in_every_state(formulation: eq.Formulation, kind: int) -> None:
    scenes, y = draw(formulation, kind)
    assert len(y) > 0.9 * ROWS  # 951 to 969 of 1000
    y_dot, _ = eq.derivative_each(formulation, scenes, y)
    judge = differences(formulation, scenes, y)
    jacobian = eq.jacobian_each(formulation, scenes, y)
    assert error(jacobian, judge, y_dot) < 5e-10  # measured 2.9e-12 to 6.6e-12, multibody 2.0e-11 to 4.2e-11
    assert error(jacobian.swapaxes(1, 2), judge, y_dot) > 0.1  # stored row by row
    scenes["wheel"]["J_x"] *= 1 + 1e-5
    assert error(eq.jacobian_each(formulation, scenes, y), judge, y_dot) > 5e-6  # 1.1e-5, multibody 3.7e-5


@KINDS
def test_the_multibody_jacobian_is_that_of_the_stabilised_transcription(kind: int) -> None:
    scenes, y = draw(eq.MULTIBODY, kind)
    y_dot = stabilised_rate(scenes, y)
    judge = complex_steps(scenes, y)
    assert error(eq.jacobian_each(eq.MULTIBODY, scenes, y), judge, y_dot) < 2e-13  # 9.6e-15 to 1.2e-14
    scenes["wheel"]["J_x"] *= 1 + 1e-9
    assert error(eq.jacobian_each(eq.MULTIBODY, scenes, y), judge, y_dot) > 1e-9  # 3.7e-9
