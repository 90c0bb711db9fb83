"""A scene that is not meant cannot be used in silence: `wheel_scene` refuses it, and every answer is NaN."""

from collections.abc import Callable
from ctypes import POINTER, Array, byref, c_double, cast
from math import nan
from typing import Any

import numpy as np
import pytest

from wheelfmu.fmu import equations as eq

MOTION = eq.Motion(1, 1.2, 0.3, 0.5, -0.2, -2, 0, 0)
MEANT = [{"kind": eq.FRICTIONLESS}, {"kind": eq.ROLLING, "sigma": -1}, {"kind": eq.ROLLING, "sigma": 1, "brake": 5.0}]
MEANT += [{"kind": eq.HELD, "sigma": 0, "omega_s": 0}, {"kind": eq.REGULARIZED, "omega_s": 1e-6}]
NOT_MEANT = [{"kind": kind} for kind in (eq.NO_LAW, 17)]
NOT_MEANT += [{"kind": eq.ROLLING, "sigma": sigma} for sigma in (0, 0.5, nan)]
NOT_MEANT += [{"kind": eq.REGULARIZED, "omega_s": omega_s} for omega_s in (0, -1e-3, nan)]
NOT_MEANT += [{"kind": eq.ROLLING, "sigma": 1, **below} for below in ({"brake": -1.0}, {"s": -1e-3})]
NOT_MEANT += [{"kind": eq.HELD, "brake": nan}]


def answers(formulation: eq.Formulation, scene: eq.Scene) -> np.ndarray:
    return eq.values(eq.dynamics(formulation, scene, eq.start(formulation, scene.wheel, MOTION)))


@pytest.mark.parametrize("choice", MEANT, ids=str)
def test_a_scene_that_is_meant_has_finite_answers(formulation: eq.Formulation, choice: dict) -> None:
    scene = eq.scene(eq.paper_wheel(s=0.03), **choice)
    assert scene.friction.kind == choice["kind"]
    assert np.isfinite(answers(formulation, scene)).all()


@pytest.mark.parametrize("choice", NOT_MEANT, ids=str)
def test_a_scene_that_is_not_meant_answers_nan(formulation: eq.Formulation, choice: dict) -> None:
    law = {name: value for name, value in choice.items() if name != "s"}
    scene = eq.scene(eq.paper_wheel(s=choice.get("s", 0.03)), **law)
    assert scene.friction.kind == eq.NO_LAW
    assert np.isnan(answers(formulation, scene)).all()


def test_a_scene_without_a_load_has_none() -> None:
    scene = eq.LIBRARY.wheel_scene(eq.paper_wheel(s=0.01), None, eq.Friction(eq.HELD, 0, 0))
    assert list(scene.load.F) == list(scene.load.M) == [0, 0, 0]
    assert scene.load.brake == 0
    assert scene.wheel.s == 0.01
    assert scene.friction.kind == eq.HELD


def address(numbers: Any) -> Any:
    return cast(byref(numbers), POINTER(c_double)) if isinstance(numbers, Array) else byref(numbers)


def answered(fill: float) -> dict[str, bytes]:
    """What each function that writes into an array or a struct leaves in one that was full of a number."""

    def written(kind: type, function: Callable, *arguments: Any) -> bytes:
        out = kind()
        np.frombuffer(out)[:] = fill
        function(*map(address, arguments), address(out))
        return bytes(out)

    found, library = {}, eq.LIBRARY
    wheel = eq.paper_wheel(J_x=0.7, J_y=1.2, s=0.03)
    scene = eq.scene(wheel, eq.ROLLING, sigma=-1, force=(3, 4, 5), moment=(0.1, 0.2, 0.3), brake=2.0)
    scene.mu_slide, x = 0.3, (c_double * 8)(0.1, 0.2, 0.3, 1.2, 0.4, -0.2, 0.5, -2.0)
    motion = eq.Motion(1, 1.2, 0.3, 0.5, -0.2, -2, 0.1, 0.2, 0.3, 0.4)
    for name, form in zip(eq.FORMULATIONS, (eq.REDUCED, eq.MULTIBODY, eq.SLIDING, eq.MULTIBODY_SLIDING), strict=True):
        scene.contact = "sliding" in name
        for scene.guided in (0, 1):
            state = c_double * form.states
            y = state.from_buffer_copy(written(state, form.start, wheel, motion))
            k = eq.Kinematics.from_buffer_copy(written(eq.Kinematics, form.kinematics, wheel, y))
            d = eq.Dynamics.from_buffer_copy(written(eq.Dynamics, form.dynamics, scene, y))
            found |= {f"{name} {scene.guided} {what}": bytes(of) for what, of in (("y", y), ("k", k), ("d", d))}
            found[f"{name} {scene.guided} rates"] = written(state, form.derivative, scene, y)
            found[f"{name} {scene.guided} guide"] = written(c_double * 2, library.wheel_guide_moment, scene, k, d)
            found[f"{name} {scene.guided} force"] = written(c_double * 2, library.wheel_horizontal_force, k, d.lambda_)
    y = (c_double * 8)(*eq.start(eq.REDUCED, wheel, motion))
    found["x"] = written(c_double * 8, lambda y, x: library.wheel_euler_states(y, c_double(0.5), x), y)
    found["y"] = written(c_double * 8, library.wheel_reduced_state, x)
    found["rates of x"] = written(c_double * 8, library.wheel_euler_rates, x, y)
    found["kinematics of x"] = written(eq.Kinematics, library.wheel_euler_kinematics, wheel, x)
    return found


def test_each_function_writes_the_whole_of_its_result_whatever_was_there() -> None:
    zero, seven, nothing = map(answered, (0.0, 7.0, nan))
    assert zero == seven == nothing and len(zero) == 52
    assert len(set(zero.values())) > 30 and np.isfinite(np.frombuffer(b"".join(zero.values()))).all()
