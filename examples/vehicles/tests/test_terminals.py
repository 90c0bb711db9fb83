"""terminalsAndIcons.xml of the bodies: valid, true to the model, wiring what the masters wire."""

from __future__ import annotations

import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest
from fmpy import read_model_description
from lxml import etree
from vehicles import axle, car

NAME = "terminalsAndIcons/terminalsAndIcons.xml"
Signal = tuple[str, str]


@pytest.fixture(scope="module")
def schema() -> etree.XMLSchema:
    folder = Path(find_spec("fmpy").origin).parent / "schema" / "fmi3"
    return etree.XMLSchema(etree.parse(folder / "fmi3TerminalsAndIcons.xsd"))


def terminals(fmu: Path) -> dict[str, dict[str, str]]:
    """Variable by member name, by terminal."""
    with zipfile.ZipFile(fmu) as archive:
        root = etree.fromstring(archive.read(NAME))
    return {
        t.get("name"): {m.get("memberName"): m.get("variableName") for m in t.iter("TerminalMemberVariable")}
        for t in root.iter("Terminal")
    }


def wired(body: str, fmu: Path, wheel_fmu: Path) -> set[tuple[Signal, Signal]]:
    """What a tool wires that joins each terminal of the body to the hub of the wheel of that name."""
    kinds = {v.name: v.causality for v in read_model_description(str(wheel_fmu)).modelVariables}
    hub, connections = terminals(wheel_fmu)["hub"], set()
    for wheel, members in terminals(fmu).items():
        for member, variable in members.items():
            ends = (wheel, hub[member]), (body, variable)
            connections.add(ends if kinds[hub[member]] == "output" else ends[::-1])
    return connections


@pytest.mark.parametrize("name", ["axle", "chassis"])
def test_the_file_is_valid_and_its_variables_exist(fmus: dict[str, Path], schema: etree.XMLSchema, name: str) -> None:
    with zipfile.ZipFile(fmus[name]) as archive:
        root = etree.fromstring(archive.read(NAME))
    schema.assertValid(root)
    known = {v.name for v in read_model_description(str(fmus[name])).modelVariables}
    for members in terminals(fmus[name]).values():
        assert set(members.values()) <= known
    root[0][0].attrib.pop("matchingRule")
    assert not schema.validate(root)  # partner


def test_joining_the_terminals_wires_the_axle(fmus: dict[str, Path]) -> None:
    assert wired("axle", fmus["axle"], fmus["wheel"]) == set(axle.CONNECTIONS)


def test_joining_the_terminals_wires_the_wheels_of_the_car(fmus: dict[str, Path]) -> None:
    of_wheels = {c for c in car.CONNECTIONS if "driver" not in (c[0][0], c[1][0])}
    assert wired("chassis", fmus["chassis"], fmus["wheel"]) == of_wheels
