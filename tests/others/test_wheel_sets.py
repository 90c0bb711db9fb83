"""Two wheels on axle.fmu become Modelica's wheel sets as the links are made stiffer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from examples.conftest import fmus

from . import wheel_sets as sets
from .numbers import read

__all__ = ["fmus"]


@pytest.mark.parametrize("scene", sets.SCENES)
def test_the_rigid_wheel_set_has_modelicas_numbers(scene: str) -> None:
    assert sets.distance(sets.table(scene), sets.rigid(scene)) < 1e-5  # m, rad; measured 2.0e-6, 4.5e-6
    at = read("multibody_jl_driving")
    exact = sets.rigid_at("driving", at["time"])
    assert np.hypot(at["x"] - exact["x"], at["y"] - exact["y"]).max() < 1e-3  # m: the bound of their test


@pytest.mark.parametrize("scene", sets.SCENES)
def test_the_error_falls_as_one_over_the_stiffness_to_modelicas_numbers(fmus: dict[str, Path], scene: str) -> None:
    stop, factors = 1.5, (5, 10, 20)
    runs = [sets.coupled(fmus, scene, factor, 0.002 / factor, stop) for factor in factors]
    errors = [sets.distance(run, sets.rigid(scene)) for run in runs]
    assert np.array(errors[:-1]) / errors[1:] == pytest.approx(2, rel=0.05)
    limit = sets.distance(sets.limit(runs), sets.rigid(scene))
    assert limit < 1e-4
    assert errors[-1] > 10 * limit  # partner: no single stiffness comes as near
