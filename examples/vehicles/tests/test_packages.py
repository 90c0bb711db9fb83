"""SSP packages: valid, parameters bound at the component, and run by fmpy to the right end."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssd, read_ssv
from support.bounds import beyond, within
from vehicles import axle_study, ssp, suspended
from vehicles.axle import AXLE
from vehicles.car import CAR
from vehicles.layout import LANE
from vehicles.suspended import LAUNCH, SUSPENDED


@pytest.fixture(scope="module")
def package(fmus: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return SUSPENDED.package(fmus, LAUNCH, 0.001, tmp_path_factory.mktemp("ssp"))


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
    within(abs(np.log2(coarse / fine) - 1), 0.1, "order off 1")
    within(fine, 0.06, "error / range")


def test_a_package_without_its_parameters_is_another_system(package: Path, truth: dict[str, np.ndarray]) -> None:
    """Partner: the start values come from the SSV."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ssp, "parameter_set", lambda _package: None)
        beyond(suspended.package_distance(package, 0.005, truth, stop=0.3), 100, "error / range")


def at_the_end(package: Path, names: tuple[str, ...], step: float, stop: float) -> np.ndarray:
    read_ssd(str(package), validate=True)
    return np.array([ssp.run(package, step, stop, 0.05)[name][-1] for name in names])


def test_the_package_of_the_car_runs_in_fmpy_and_converges_with_order_one(
    fmus: dict[str, Path], tmp_path: Path
) -> None:
    manoeuvre = LANE.changed(stop=1.5)
    truth = CAR.drive(fmus, manoeuvre, 0.001, "rollback", 0.05).table["X_R"][-1]
    errors = [
        abs(at_the_end(CAR.package(fmus, manoeuvre, h, tmp_path), ("chassis.X_R",), h, 1.5)[0] - truth)
        for h in (0.001, 0.0005)
    ]
    within(abs(np.log2(errors[0] / errors[1]) - 1), 0.005, "order off 1")
    within(errors[1], 0.01, "off the end, m")  # of 22 m


def test_the_package_of_the_axle_runs_in_fmpy(fmus: dict[str, Path], tmp_path: Path) -> None:
    scene, names = axle_study.TRAILING.changed(stop=1.0), ("X", "Y", "psi")
    table = AXLE.drive(fmus, scene, 0.0005, "rollback", 0.05).table
    package = AXLE.package(fmus, scene, 0.0005, tmp_path)
    ends = at_the_end(package, tuple(f"axle.{n}" for n in names), 0.0005, 1.0)
    within(np.abs(ends - [table[n][-1] for n in names]).max(), 0.01, "off the end, m, rad")
