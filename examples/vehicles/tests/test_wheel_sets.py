"""Two wheels on axle.fmu become Modelica's wheel sets as the links are made stiffer."""

from pathlib import Path

import numpy as np
import pytest
from others import wheel_sets as sets
from others.numbers import read
from support.bounds import beyond, relative_error, within


@pytest.mark.parametrize("scene", sets.SCENES)
def test_the_rigid_wheel_set_has_modelicas_numbers(scene: str) -> None:
    within(sets.distance(sets.table(scene), sets.rigid(scene)), 1e-5, "Modelica's table, m, rad")
    at = read("multibody_jl_driving")
    exact = sets.rigid_at("driving", at["time"])
    within(np.hypot(at["x"] - exact["x"], at["y"] - exact["y"]).max(), 1e-3, "Multibody.jl's test, m")


@pytest.mark.parametrize("scene", sets.SCENES)
def test_the_error_falls_as_one_over_the_stiffness_to_modelicas_numbers(fmus: dict[str, Path], scene: str) -> None:
    stop, factors = 1.5, (5, 10, 20)
    runs = [sets.coupled(fmus, scene, factor, 0.002 / factor, stop) for factor in factors]
    errors = [sets.distance(run, sets.rigid(scene)) for run in runs]
    within(relative_error(np.array(errors[:-1]) / errors[1:], [2, 2]), 0.05, "ratio of errors off 2, relative")
    limit = sets.distance(sets.limit(runs), sets.rigid(scene))
    within(limit / errors[-1], 0.02, "error of the limit over that of the stiffest links")
    beyond(errors[0] / errors[-1], 3.5, "error of the softest links over that of the stiffest")
