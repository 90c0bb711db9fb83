"""SSP packages: valid, parameters bound at the component, and run by fmpy to the right end."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssd, read_ssv
from vehicles import axle, axle_study, car, ssp, suspended


@pytest.fixture(scope="module")
def package(fmus: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return ssp.build(suspended.system(fmus), tmp_path_factory.mktemp("ssp"))


def test_the_package_is_valid_ssp_and_its_parameters_are_bound_at_the_component(package: Path) -> None:
    structure = read_ssd(str(package), validate=True)
    assert structure.version == "1.0"
    assert len(structure.system.connections) == len(suspended.CONNECTIONS)
    assert structure.system.parameterBindings == []
    bound = {c.name: [b.source for b in c.parameterBindings] for c in structure.system.elements}
    assert bound == {"wheel": ["resources/wheel.ssv"], "quarter_car": []}
    written = read_ssv(str(package), "resources/wheel.ssv", validate=True).parameters
    assert {p.name: float(p.value) for p in written} == suspended.START


def test_fmpy_runs_the_package_and_converges_with_order_one(package: Path, truth: dict[str, np.ndarray]) -> None:
    coarse, fine = (suspended.package_distance(package, h, truth) for h in (0.00125, 0.000625))
    assert np.log2(coarse / fine) == pytest.approx(1, abs=0.1)  # measured 1.06
    assert fine < 0.06  # measured 0.051


def test_a_package_without_its_parameters_is_another_system(package: Path, truth: dict[str, np.ndarray]) -> None:
    """Partner: the start values come from the SSV."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ssp, "parameter_set", lambda _package: None)
        assert suspended.package_distance(package, 0.005, truth, stop=0.3) > 0.5


@pytest.mark.parametrize("h", [0.001])
def test_the_packages_of_axle_and_car_run_in_fmpy_and_converge_with_order_one(
    fmus: dict[str, Path], tmp_path: Path, h: float
) -> None:
    scene, manoeuvre = replace(axle_study.TRAILING, stop=1.0), replace(car.LANE, stop=2.0)
    along = axle.coupled(fmus, scene, h, "rollback", 0.05), car.drive(fmus, manoeuvre, h, "rollback", 0.05).table
    makers = (
        (lambda step: axle.system(fmus, scene, step), scene.stop, "axle.psi", along[0]["psi"]),
        (lambda step: car.system(fmus, manoeuvre, step), manoeuvre.stop, "chassis.X_R", along[1]["X_R"]),
    )
    for make, stop, name, truth in makers:
        errors = []
        for step in (h, h / 2):
            package = ssp.build(make(step), tmp_path)
            read_ssd(str(package), validate=True)
            errors.append(np.abs(ssp.run(package, step, stop, 0.05)[name] - truth[1:]).max())
        assert np.log2(errors[0] / errors[1]) == pytest.approx(1, abs=0.25)
        assert errors[1] < 0.02
