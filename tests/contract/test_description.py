"""The model description and its neighbours: valid, complete, numbered, and the same as what the library does."""

import csv
import re
from pathlib import Path
from xml.etree import ElementTree

import attrs
import numpy as np
import pytest
from fmpy import validation
from lxml import etree
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.description.measuring import event_indicators, measured
from wheelfmu.fmu.description.numbering import numbered
from wheelfmu.fmu.driver import CHOICES, DERIVATIVES, DISCARD, INDICATORS, OK, STATES
from wheelfmu.fmu.paths import ROOT

FULL_TURN = 2 * np.pi
SCHEMAS = Path(validation.__file__).parent / "schema"
TEXT = (ROOT / "modelDescription.xml").read_text(encoding="utf-8")
# What users rely on, in this order. Outputs that are added later follow after these and need no entry here; nor do
# parameters.
with Path(__file__).with_name("variables.csv").open(newline="", encoding="utf-8") as file:
    ROWS = list(csv.DictReader(file))
UNITS = {row["name"]: row["unit"] or None for row in ROWS}
STARTS = {row["name"]: float(row["start"]) for row in ROWS if row["start"]}
PARAMETERS, INPUTS, OUTPUTS, LOCALS = (
    [row["name"] for row in ROWS if row["role"] == role] for role in ("parameter", "input", "output", "local")
)


def names_of(description, causality: str) -> list[str]:
    return [v.name for v in description.modelVariables if v.causality == causality]


def unit_of(variable) -> str | None:
    return variable.unit or (variable.declaredType and variable.declaredType.unit) or None


@pytest.fixture(scope="module")
def xml(fmu: str) -> ElementTree.Element:
    return ElementTree.parse(Path(fmu) / "modelDescription.xml").getroot()


def test_description_and_archive_pass_fmpys_validation(fmu_path, tmp_path):
    """Schema, names, start values, combinations of kinds, units, ModelStructure."""
    assert validation.validate_fmu(str(fmu_path)) == []
    for before, after in (('fmiVersion="2.0"', 'fmiVersion="2.1"'), ('unit="kg"', 'unit="lb"')):  # the partners
        (tmp_path / "modelDescription.xml").write_text(TEXT.replace(before, after), encoding="utf-8")
        assert validation.validate_fmu(str(tmp_path)) != []


def test_variables_are_those_of_the_contract_in_its_order_with_its_units_and_kinds(description):
    parameters, outputs = names_of(description, "parameter"), names_of(description, "output")
    assert [name for name in parameters if name in PARAMETERS] == PARAMETERS and outputs[: len(OUTPUTS)] == OUTPUTS
    assert [v.name for v in description.modelVariables] == [*parameters, *INPUTS, *outputs, *LOCALS]
    road = ("s", "mu_max", "mu_slide", "slope", "slope_direction")
    kinds = dict.fromkeys(parameters, ("fixed", "exact")) | dict.fromkeys(road, ("tunable", "exact"))
    kinds |= dict.fromkeys(INPUTS, ("continuous", "exact"))
    assert len({v.valueReference for v in description.modelVariables}) == len(description.modelVariables)
    for v in description.modelVariables:
        if v.name in outputs or v.name in LOCALS:
            kinds[v.name] = ("continuous" if v.type == "Real" else "discrete", "calculated")
        assert (v.variability, v.initial) == kinds[v.name], v.name
        assert unit_of(v) == UNITS.get(v.name, unit_of(v)), v.name
        assert v.type != "Real" or unit_of(v), v.name
        assert (v.displayUnit or (v.declaredType and v.declaredType.displayUnit)) in (None, "deg")
        assert (v.displayUnit == "deg") == (unit_of(v) == "rad"), v.name
        assert v.description and not v.description.endswith("."), v.name
    assert {v.type for v in description.modelVariables if v.causality == "output"} == {"Real"}  # importers assume it


def test_every_start_value_of_the_description_is_what_the_library_starts_with(wheel, description):
    w = wheel().initializing()
    stored = {v.name: v for v in description.modelVariables if v.start is not None}
    assert list(stored) == [*names_of(description, "parameter"), *INPUTS]
    off = {}
    for name, v in stored.items():
        start = {"true": 1, "false": 0}.get(v.start) if v.type == "Boolean" else float(v.start)
        assert w.get_one(name) == (OK, start), name
        off[name] = abs(start - STARTS.get(name, start))
    within(off, 8 * EPSILON, "start value")
    assert w.put(m=20.000000000000004).get("m") != [20.0]  # the partner: one unit in the last place


def test_limits_of_the_description_are_those_the_library_enforces(wheel, description):
    """A value one unit beyond a limit is refused at the end of initialization, the limit's inside is taken."""

    def accepted(name: str, value: float) -> bool:
        w = wheel().initializing(**{name: value})
        taken = w.exitInitializationMode() == OK
        assert taken or any(text.startswith(name) for text in w.texts()), (name, value)
        w.close()
        return taken

    limits = [(v, limit, way) for v in description.modelVariables for limit, way in ((v.min, -1), (v.max, 1)) if limit]
    assert {"m", "s", "mu_max", "slope", "theta_start", "formulation", "M_brake"} <= {v.name for v, *_ in limits}
    for v, limit, way in limits:
        if v.name in INPUTS[-2:]:
            continue  # of a guided wheel: tests/contract/test_steering.py
        number = float(limit)
        assert not accepted(v.name, int(limit) + way if v.type != "Real" else number + way * max(1e-3, 1e-3 * number))
        if limit == v.min:
            factor = 0.99 if v.name == "J_z" else 1.01  # J_z is at its limit, J_x + J_y
            assert accepted(v.name, int(v.min) if v.type != "Real" else float(v.start) * factor), v.name


def test_every_unit_is_defined_by_base_units_and_used(description):
    assert {unit_of(v) for v in description.modelVariables} - {None} == {u.name for u in description.unitDefinitions}
    of = {u.name: {k: n for k, n in attrs.asdict(u.baseUnit).items() if n} for u in description.unitDefinitions}
    newton = {"kg": 1, "m": 1, "s": -2, "factor": 1.0}
    assert all(of.values()) and of["N"] == newton and of["J"] == newton | {"m": 2} == of["N.m"]
    (degree,) = next(u.displayUnits for u in description.unitDefinitions if u.name == "rad")
    within(abs(degree.factor * FULL_TURN - 360), 2 * 360 * EPSILON, "full turn off 360, degrees")  # 16 digits of 180/pi
    beyond(abs(57.295779513 * FULL_TURN - 360), 4e-11, "full turn by a rounded factor off 360, degrees")


def test_choices_are_integers_with_limits_and_their_meanings(description, xml):
    """Not enumerations, which Maestro refuses and libcosim ignores."""
    assert not list(xml.iter("Enumeration")) and not list(xml.iter("SimpleType"))
    variables = {v.name: v for v in description.modelVariables}
    for name, items in CHOICES.items():
        v = variables[name]
        assert (v.type, int(v.min), int(v.max)) == ("Integer", 1, len(items))
        assert {item: int(k) for k, item in re.findall(r"\b(\d) (\w+)", v.description)} == items, name


def test_forces_and_moments_have_no_limits_in_the_description_and_the_library_refuses_what_no_wheel_bears(wheel, xml):
    limits = {v.get("name"): set(v[0].attrib) & {"min", "max"} for v in xml.find("ModelVariables")}
    loads, rates = INPUTS[:-2], INPUTS[-2:]
    assert {name for name in loads if limits[name]} == {"M_brake"} and all(len(limits[name]) == 2 for name in rates)
    w = wheel().start(guided=True)
    assert [w.set(**{name: 1e301}) for name in INPUTS] == [DISCARD] * len(INPUTS)
    assert [w.set(**{name: 1e299}) for name in loads] == [OK] * len(loads)
    assert (w.set(M_brake=-1e-9), w.set(M_3=-1e-9)) == (DISCARD, OK)


def test_the_header_and_the_capabilities_are_those_of_the_library(description, xml):
    slave, exchange = xml.find("CoSimulation").attrib, xml.find("ModelExchange").attrib
    both = {"canNotUseMemoryManagementFunctions", "canGetAndSetFMUstate", "canSerializeFMUstate"}
    both |= {"providesDirectionalDerivative"}
    assert {name for name, value in exchange.items() if value == "true"} == both
    of_slave = {"canHandleVariableCommunicationStepSize", "canInterpolateInputs"}
    assert {name for name, value in slave.items() if value == "true"} == both | of_slave
    assert slave["maxOutputDerivativeOrder"] == "1"
    assert slave["modelIdentifier"] == exchange["modelIdentifier"] == "wheel"
    assert xml.get("variableNamingConvention") == "flat"
    assert [u.variable.name for u in description.derivatives] == list(DERIVATIVES)
    assert [u.variable.derivative.name for u in description.derivatives] == list(STATES)
    d = description.defaultExperiment
    assert [float(x) for x in (d.startTime, d.stopTime, d.stepSize)] == [0.0, 10.0, 0.01]
    assert 1e-13 <= float(d.tolerance) <= 1e-6


def test_the_event_indicators_are_as_many_as_the_library_has(fmu_path, description):
    assert event_indicators(fmu_path) == description.numberOfEventIndicators >= len(INDICATORS)


def test_log_categories_are_those_the_library_knows(wheel, description):
    names = [category.name for category in description.logCategories]
    assert names == ["logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError", "logAll"]
    w = wheel()
    w.setDebugLogging(True, [*names])
    assert w.take_messages() == []
    assert w.ask("SetDebugLogging", 1, 1, [b"logNothing"]) == OK and "logNothing" in w.said()  # the partner


# The numbers: ModelStructure lists what was measured and nothing else.


@pytest.fixture(scope="module")
def depends(fmu_path):
    return measured(fmu_path)


def test_the_description_lists_exactly_the_dependencies_that_are_measured_which_are_those_of_the_equations(depends):
    start, now = depends["InitialUnknowns"], depends["Outputs"]
    assert start["theta"] == {"theta_start"} and start["Z_O"] == {"r_0", "r", "theta_start"}
    assert start["tau"] > {*INPUTS, "s", "friction_law", "omega_s", "J_x", "J_y", "g"}
    rates = {"psi_dot_guide", "theta_dot_guide"}
    assert now["lambda_3"] > {*INPUTS} - {"psi_dot_guide"} and "psi_dot_guide" not in now["lambda_3"]
    assert now["theta"] == {"theta"} and now["omega_z"] == {"omega_z", *rates}
    assert now["psi_dot"] == {"psi_dot", "psi_dot_guide"} and not now["psi"] & rates
    of_rates = {name for name in now if now[name] & rates}
    assert of_rates >= {"v_x", "v_y", "X_O_dot", "M_guide_1", "M_guide_2", "slip_x"}
    assert not any(names & rates for names in depends["Derivatives"].values())  # model exchange refuses them
    assert depends["Derivatives"]["phi_dot"] == {"theta", "psi_dot", "omega_z"}
    assert numbered(TEXT, depends) == TEXT, "run scripts/variables"
    without = {**depends, "Outputs": {**depends["Outputs"], "theta": {"M_1"}}}
    assert numbered(TEXT, without) != TEXT  # a false algebraic loop would be seen


HELD = {"phi_dot_start": 0.0, "s": 0.03, "M_brake": 300.0}
ROLLING = {"phi_dot_start": -3.0, "s": 0.03, "M_brake": 3.0}
SLIDING = {"mu_max": 9.0, "mu_slide": 0.3, "slip_x_start": 0.1, "slip_y_start": 0.1}
LIFTED = {"F_Z": 400.0, "keep_contact": True}
STARTS_OFF = {"theta_start": 1.1, "psi_start": 0.7, "phi_start": 0.4, "J_x": 0.7, "J_y": 1.2, "F_X": 2.0, "M_3": 1.0}


@pytest.mark.parametrize("guided", [False, True], ids=["free", "guided"])
@pytest.mark.parametrize("contact", [{}, SLIDING, LIFTED], ids=["grips", "slides", "pulled"])
@pytest.mark.parametrize("axle", [HELD, ROLLING, HELD | {"friction_law": 2}], ids=["held", "rolling", "regularized"])
def test_in_every_mode_outputs_follow_at_once_only_inputs_that_the_description_declares(
    wheel, description, guided, contact, axle
):
    """A master that orders its calls by them would else read an output before what it depends on is set."""
    declared = {u.variable.name: {v.name for v in u.dependencies} for u in description.outputs}
    w = wheel().start(**STARTS_OFF | axle | contact, guided=guided)
    moved = np.abs(w.jacobian([*declared], INPUTS)) > 1e-9
    follows = {name: {INPUTS[k] for k in np.flatnonzero(row)} for name, row in zip(declared, moved, strict=True)}
    assert {name: found - declared[name] for name, found in follows.items() if found - declared[name]} == {}
    if axle is HELD and contact is not LIFTED:
        assert follows["tau_brake"] > {"M_3", "M_brake"}  # those of a spinning wheel are M_brake alone


def test_the_terminal_of_the_hub_is_valid_and_a_bus_of_signals(fmu, description):
    """FMI 2.0.4 (section 2.3) refers to FMI 3.0 (section 2.4.9), whose schema comes with FMPy. Kind `signal` is for
    inputs, outputs and parameters; rule `bus` needs a member name, unique in its terminal. tests/repository compares
    the variables with docs/vehicle.md."""
    terminals = etree.parse(Path(fmu) / "terminalsAndIcons" / "terminalsAndIcons.xml").getroot()
    schema = etree.XMLSchema(etree.parse(SCHEMAS / "fmi3" / "fmi3TerminalsAndIcons.xsd"))
    schema.assertValid(terminals)
    (hub,) = terminals.iter("Terminal")
    assert (hub.get("name"), hub.get("matchingRule")) == ("hub", "bus")
    named = [member.get("variableName") for member in hub]
    assert len(named) == len({*named}) and {*INPUTS} < {*named} <= {*INPUTS, *names_of(description, "output")}
    for member in hub:
        assert (member.tag, member.get("variableKind")) == ("TerminalMemberVariable", "signal")
        assert member.get("memberName") == member.get("variableName")
    hub.attrib.pop("matchingRule")  # the partner
    assert not schema.validate(terminals)
