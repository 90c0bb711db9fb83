"""The wheel's terminalsAndIcons.xml: FMI 2.0.4 (section 2.3) refers to FMI 3.0 (section 2.4.9) for what it holds.

FMI 2 has no schema of its own for it: that of FMI 3.0 comes with FMPy.
"""

from importlib.util import find_spec
from pathlib import Path

import pytest
from fmpy import read_model_description
from lxml import etree


@pytest.fixture
def terminals(fmu: str) -> etree._Element:
    return etree.parse(Path(fmu) / "terminalsAndIcons" / "terminalsAndIcons.xml").getroot()


@pytest.fixture
def hub(terminals: etree._Element) -> etree._Element:
    (terminal,) = terminals.iter("Terminal")
    assert terminal.get("name") == "hub"
    return terminal


def test_the_file_follows_the_schema_of_fmi_3(terminals, hub):
    folder = Path(find_spec("fmpy").origin).parent / "schema" / "fmi3"
    schema = etree.XMLSchema(etree.parse(folder / "fmi3TerminalsAndIcons.xsd"))
    schema.assertValid(terminals)
    terminals.set("fmiVersion", "2.0")  # partner: that of the model description is not what the schema allows
    assert not schema.validate(terminals)
    terminals.set("fmiVersion", "3.0")
    hub.attrib.pop("matchingRule")
    assert not schema.validate(terminals)


def test_the_hub_takes_every_input_and_gives_pose_velocity_and_reaction(fmu, hub):
    causality = {v.name: v.causality for v in read_model_description(fmu).modelVariables}
    named = [member.get("variableName") for member in hub]
    inputs = [name for name, kind in causality.items() if kind == "input"]
    assert [name for name in named if causality[name] == "input"] == inputs
    pose = {"X_O", "Y_O", "Z_O", "psi", "theta"}
    velocity = {f"{name}_dot" for name in pose}
    outputs = [name for name in named if causality[name] == "output"]
    assert set(outputs) == pose | velocity | {"tau", "lambda_3"}
    assert len(inputs) + len(outputs) == len(named) == len(set(named))


def test_members_are_signals_under_the_names_of_their_variables(hub):
    """Kind `signal` is for inputs, outputs and parameters; rule `bus` needs a member name, unique in its terminal."""
    assert hub.get("matchingRule") == "bus"
    assert {member.tag for member in hub} == {"TerminalMemberVariable"}
    assert {member.get("variableKind") for member in hub} == {"signal"}
    assert [member.get("memberName") for member in hub] == [member.get("variableName") for member in hub]
