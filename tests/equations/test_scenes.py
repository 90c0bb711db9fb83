"""A scene that is not meant cannot be used in silence: `wheel_scene` refuses it, and every answer is NaN."""

from math import nan

import numpy as np
import pytest

from wheelfmu.fmu import equations as eq

MEANT = [{"kind": eq.FRICTIONLESS}, {"kind": eq.ROLLING, "sigma": -1}, {"kind": eq.ROLLING, "sigma": 1, "brake": 5.0}]
MEANT += [{"kind": eq.HELD, "sigma": 0, "omega_s": 0}, {"kind": eq.REGULARIZED, "omega_s": 1e-6}]
NOT_MEANT = [{"kind": kind} for kind in (eq.NO_LAW, 17)]
NOT_MEANT += [{"kind": eq.ROLLING, "sigma": sigma} for sigma in (0, 0.5, nan)]
NOT_MEANT += [{"kind": eq.REGULARIZED, "omega_s": omega_s} for omega_s in (0, -1e-3, nan)]
NOT_MEANT += [{"kind": eq.ROLLING, "sigma": 1, **below} for below in ({"brake": -1.0}, {"s": -1e-3})]
NOT_MEANT += [{"kind": eq.HELD, "brake": nan}]


FORMS = {"reduced": eq.REDUCED, "multibody": eq.MULTIBODY}
FORMS |= {"sliding": eq.SLIDING, "multibody, sliding": eq.MULTIBODY_SLIDING}
each_form = pytest.mark.parametrize("form", FORMS)
carriers = pytest.mark.parametrize("guided", [0, 1], ids=["free", "guided"])


def answers(form: str, scene: eq.Scene, guided: int) -> np.ndarray:
    """Accelerations and forces, as they are read and as a solver gets them."""
    scene.guided = guided
    scene.contact, scene.mu_slide = ("sliding" in form), 0.3
    slip = (0.4, -0.2) if "sliding" in form else (0, 0)
    y = eq.start(FORMS[form], scene.wheel, eq.Motion(1, 1.2, 0.3, 0.5, -0.2, -2, 0, 0, *slip))
    rates = eq.derivative(FORMS[form], scene, y)
    return np.array([*eq.values(eq.dynamics(FORMS[form], scene, y)), *rates[1:4], *rates[8:]])


@carriers
@each_form
@pytest.mark.parametrize("choice", MEANT, ids=str)
def test_a_scene_that_is_meant_has_finite_answers(form: str, guided: int, choice: dict) -> None:
    scene = eq.scene(eq.paper_wheel(s=0.03), **choice)
    assert scene.friction.kind == choice["kind"]
    assert np.isfinite(answers(form, scene, guided)).all()


@carriers
@each_form
@pytest.mark.parametrize("choice", NOT_MEANT, ids=str)
def test_a_scene_that_is_not_meant_answers_nan(form: str, guided: int, choice: dict) -> None:
    law = {name: value for name, value in choice.items() if name != "s"}
    scene = eq.scene(eq.paper_wheel(s=choice.get("s", 0.03)), **law)
    assert scene.friction.kind == eq.NO_LAW
    assert np.isnan(answers(form, scene, guided)).all()


def test_a_scene_without_a_load_has_none() -> None:
    scene = eq.LIBRARY.wheel_scene(eq.paper_wheel(s=0.01), None, eq.Friction(eq.HELD, 0, 0))
    assert list(scene.load.F) == list(scene.load.M) == [0, 0, 0]
    assert scene.load.brake == 0
    assert scene.wheel.s == 0.01
    assert scene.friction.kind == eq.HELD
