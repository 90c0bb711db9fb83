"""What other tools read: SSP packages, valid, parameters bound at the component, run by fmpy to the right end."""

import json
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssd, read_ssv
from support.bounds import beyond, within

from lab.vehicles import ssp, suspended
from lab.vehicles.vehicle import Fmus, Table


@pytest.fixture(scope="module")
def package(fmus: Fmus, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return suspended.SUSPENDED.package(fmus, suspended.LAUNCH, 0.001, tmp_path_factory.mktemp("ssp"))


def test_the_package_is_valid_ssp_and_its_parameters_are_bound_at_the_component(package: Path) -> None:
    structure = read_ssd(str(package), validate=True)
    assert structure.version == "1.0"
    assert len(structure.system.connections) == len(suspended.SUSPENDED.connections)
    assert structure.system.parameterBindings == []
    bound = {c.name: [b.source for b in c.parameterBindings] for c in structure.system.elements}
    assert bound == {"wheel": ["resources/wheel.ssv"], "quarter_car": ["resources/quarter_car.ssv"]}
    written = read_ssv(str(package), "resources/wheel.ssv", validate=True).parameters
    assert {p.name: json.loads(p.value) for p in written} == suspended.start(suspended.LAUNCH)["wheel"]


def test_fmpy_runs_the_package_and_converges_with_order_one(package: Path, truth: Table) -> None:
    coarse, fine = (suspended.package_distance(package, h, truth) for h in (0.00125, 0.000625))
    within(abs(np.log2(coarse / fine) - 1), 0.1, "order off 1")
    within(fine, 0.06, "error / range")


def test_a_package_without_its_parameters_is_another_system(
    package: Path, truth: Table, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Partner: the start values come from the SSV."""
    monkeypatch.setattr(ssp, "parameter_set", lambda _package: None)
    beyond(suspended.package_distance(package, 0.005, truth, stop=0.3), 0.2, "error / range")
