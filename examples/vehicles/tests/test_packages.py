"""What other tools read: SSP packages, valid, parameters bound at the component, run by fmpy to the right end; the
bodies' terminals, which wire the signals that the master wires."""

import zipfile
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.ssp.ssd import read_ssd, read_ssv
from lxml import etree
from support.bounds import beyond, within
from vehicles import axle, car, ssp, suspended
from vehicles.vehicle import Fmus, Table, Vehicle


@pytest.fixture(scope="module")
def package(fmus: Fmus, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return suspended.SUSPENDED.package(fmus, suspended.LAUNCH, 0.001, tmp_path_factory.mktemp("ssp"))


def test_the_package_is_valid_ssp_and_its_parameters_are_bound_at_the_component(package: Path) -> None:
    structure = read_ssd(str(package), validate=True)
    assert structure.version == "1.0"
    assert len(structure.system.connections) == len(suspended.SUSPENDED.connections)
    assert structure.system.parameterBindings == []
    bound = {c.name: [b.source for b in c.parameterBindings] for c in structure.system.elements}
    assert bound == {"wheel": ["resources/wheel.ssv"], "quarter_car": [], "brakes": ["resources/brakes.ssv"]}
    written = read_ssv(str(package), "resources/wheel.ssv", validate=True).parameters
    assert {p.name: float(p.value) for p in written} == suspended.START


def test_fmpy_runs_the_package_and_converges_with_order_one(package: Path, truth: Table) -> None:
    coarse, fine = (suspended.package_distance(package, h, truth) for h in (0.00125, 0.000625))
    within(abs(np.log2(coarse / fine) - 1), 0.1, "order off 1")
    within(fine, 0.06, "error / range")


def test_a_package_without_its_parameters_is_another_system(
    package: Path, truth: Table, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Partner: the start values come from the SSV."""
    monkeypatch.setattr(ssp, "parameter_set", lambda _package: None)
    beyond(suspended.package_distance(package, 0.005, truth, stop=0.3), 100, "error / range")


def terminals(fmu: Path) -> etree._Element:
    return etree.fromstring(zipfile.ZipFile(fmu).read("terminalsAndIcons/terminalsAndIcons.xml"))


def members(terminal: etree._Element) -> dict[str, str]:
    """Variable by member name."""
    return {m.get("memberName"): m.get("variableName") for m in terminal.iter("TerminalMemberVariable")}


@pytest.mark.parametrize(("name", "vehicle"), [("axle", axle.AXLE), ("chassis", car.CAR)])
def test_joining_the_terminals_of_a_valid_file_wires_the_wheels(fmus: Fmus, name: str, vehicle: Vehicle) -> None:
    """As a tool does that joins each terminal of the body to the terminal of the wheel of that name."""
    root, (hub,) = terminals(fmus[name]), terminals(fmus["wheel"]).iter("Terminal")
    kinds = {v.name: v.causality for v in read_model_description(str(fmus["wheel"])).modelVariables}
    connections = set()
    for terminal in root.iter("Terminal"):
        for member, variable in members(terminal).items():
            ends = (terminal.get("name"), members(hub)[member]), (name, variable)
            connections.add(ends if kinds[members(hub)[member]] == "output" else ends[::-1])
    assert connections == {c for c in vehicle.connections if "driver" not in (c[0][0], c[1][0])}
    folder = Path(find_spec("fmpy").origin).parent / "schema" / "fmi3"
    schema = etree.XMLSchema(etree.parse(folder / "fmi3TerminalsAndIcons.xsd"))
    schema.assertValid(root)
    root[0][0].attrib.pop("matchingRule")
    assert not schema.validate(root)  # partner
