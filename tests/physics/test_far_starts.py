"""A wheel that starts far away, or after many turns, moves as one that starts at home: heading, roll angle and place
are symmetries, and an angle of many turns is the same angle.

The angle at home is atan2(sin, cos) of the far one, which the C library reduces exactly.
"""

from math import atan2, cos, sin

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.driver import OK, FMU2Wheel

TIMES = np.arange(1, 26) * 0.1
SHAPES = ("theta", "psi_dot", "theta_dot", "phi_dot", "omega_z", "lambda_1", "lambda_2", "lambda_3", "tau", "n_steps")
SCENES = {
    "friction": {"s": 0.03, "psi_dot_start": 0.5},
    "slope": {"s": 0.03, "slope": 0.05, "psi_dot_start": 0.5, "phi_dot_start": -9.0},
    "unequal inertia": {"J_x": 0.7, "J_y": 1.2, "psi_dot_start": 0.5, "phi_dot_start": -9.0},
    "multibody": {"formulation": "multibody", "s": 0.03, "psi_dot_start": 0.5},
    "Adams": {"method": "adams", "psi_dot_start": 0.5},
    "unfolded": {"psi_dot_start": 0.5},
}


def home(angle: float) -> float:
    return atan2(sin(angle), cos(angle))


def run(wheel: FMU2Wheel, **values: object) -> np.ndarray:
    """Rows of SHAPES and the ways of O, psi and phi since the start; pushed along X in the second half."""
    rows, names = [], ("X_O", "Y_O", "psi", "phi")
    begin = np.array([float(values.get(f"{name}_start", 0)) for name in names])
    wheel.start(tolerance=1e-10, **{"X_O_start": 0.0, **values})
    for k, t in enumerate(TIMES):
        if k == 12:
            assert wheel.set(F_X=5.0) == OK
        wheel.to(t)
        rows.append([*wheel.get(*SHAPES), *(wheel.get(*names) - begin)])
    return np.array(rows)


@pytest.mark.parametrize("scene", SCENES)
def test_many_turns_at_the_start_change_neither_motion_nor_steps(wheel, scene: str) -> None:
    random = np.random.default_rng(45)
    for exponent in (2, 8, 10, 12):
        psi, phi = (random.uniform(0.3, 1) * 10.0**exponent * random.choice([-1, 1]) for _ in range(2))
        far = run(wheel(), psi_start=psi, phi_start=phi, **SCENES[scene])
        near = run(wheel(), psi_start=home(psi), phi_start=home(phi), **SCENES[scene])
        turned = run(wheel(), psi_start=home(psi) + 1e-7, phi_start=home(phi) + 1e-7, **SCENES[scene])
        scale = np.abs(near).max(axis=0) + 1
        bound = np.full(len(scale), 1e-10)
        bound[-2:] += 4 * EPSILON * 10.0**exponent  # the turns themselves have no more digits
        within((np.abs(far - near) / scale / bound).max(), 1, "distance from the start at home over its bound")
        beyond((np.abs(turned - near) / scale / 1e-10).max(), 1, "distance of another heading")
        assert (far[:, SHAPES.index("n_steps")] == near[:, SHAPES.index("n_steps")]).all()


@pytest.mark.parametrize("scene", SCENES)
def test_a_distant_place_changes_the_place_alone(wheel, scene: str) -> None:
    place = 3e9  # m
    far = run(wheel(), X_O_start=place, Y_O_start=-place, psi_start=1.0, **SCENES[scene])
    near = run(wheel(), X_O_start=0.0, Y_O_start=0.0, psi_start=1.0, **SCENES[scene])
    assert (far[:, : len(SHAPES)] == near[:, : len(SHAPES)]).all()
    within(np.abs(far - near).max(), 4 * EPSILON * place, "path, m")
    beyond(np.abs(near[:, len(SHAPES)]).max(), 0.1, "path at all, m")


def test_an_angle_of_many_turns_is_read_as_it_was_set(wheel) -> None:
    for angle in (-3.0, 7.0, 1234.5, 1e12):
        w = wheel().start(psi_start=angle, phi_start=-angle, s=0.03)
        assert w.get("psi", "phi") == [angle, -angle]
