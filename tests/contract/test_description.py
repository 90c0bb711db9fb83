"""The model description: valid, complete, and the same as what the library says when it is asked."""

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
from support.driver import CHOICES, DERIVATIVES, DISCARD, INDICATORS, OK, STATES

FULL_TURN = 2 * np.pi
# What users rely on, in this order. Outputs that are added later follow after these and need no entry here; nor do
# parameters.
with Path(__file__).with_name("variables.csv").open(newline="", encoding="utf-8") as file:
    ROWS = list(csv.DictReader(file))
UNITS = {row["name"]: row["unit"] or None for row in ROWS}
STARTS = {row["name"]: float(row["start"]) for row in ROWS if row["start"]}
PARAMETERS, INPUTS, OUTPUTS, LOCALS = (
    [row["name"] for row in ROWS if row["role"] == role] for role in ("parameter", "input", "output", "local")
)


def parameters_of(description) -> list[str]:
    """All parameters: those of the contract are among them in its order, with what is added later."""
    names = [v.name for v in description.modelVariables if v.causality == "parameter"]
    assert [name for name in names if name in PARAMETERS] == PARAMETERS
    return names


def outputs_of(description) -> list[str]:
    """All outputs: those of the contract come first."""
    names = [v.name for v in description.modelVariables if v.causality == "output"]
    assert names[: len(OUTPUTS)] == OUTPUTS
    return names


def unit_of(variable) -> str | None:
    return variable.unit or (variable.declaredType and variable.declaredType.unit) or None


@pytest.fixture(scope="module")
def xml(fmu: str) -> ElementTree.Element:
    return ElementTree.parse(Path(fmu) / "modelDescription.xml").getroot()


def test_description_and_archive_pass_fmpy_and_the_schema(fmu_path, fmu, tmp_path):
    assert validation.validate_fmu(str(fmu_path)) == []
    schema = Path(validation.__file__).parent / "schema" / "fmi2" / "fmi2ModelDescription.xsd"
    valid = etree.XMLSchema(etree.parse(schema))
    document = etree.parse(Path(fmu) / "modelDescription.xml")
    assert valid.validate(document), valid.error_log
    document.getroot().set("fmiVersion", "2.1")  # the partner
    assert not valid.validate(document)


def test_variables_are_those_of_the_contract_in_its_order_with_its_units_and_starts(description):
    names = [v.name for v in description.modelVariables]
    assert names == [*parameters_of(description), *INPUTS, *outputs_of(description), *LOCALS]
    assert [v.valueReference for v in description.modelVariables] == list(range(len(names)))
    for v in description.modelVariables:
        assert unit_of(v) == UNITS.get(v.name, unit_of(v)), v.name
        assert v.type != "Real" or unit_of(v), v.name
        assert (v.declaredType.displayUnit if v.declaredType else v.displayUnit) in (None, "deg")
        assert (v.displayUnit == "deg") == (unit_of(v) == "rad"), v.name
        assert v.description and not v.description.endswith("."), v.name


def test_causality_variability_and_initial_are_those_of_the_standard(description, xml):
    rows = [v.attrib for v in xml.find("ModelVariables")]
    kinds = {row["name"]: (row["causality"], row["variability"], row.get("initial")) for row in rows}
    for name in parameters_of(description):
        assert kinds.pop(name) == ("parameter", "tunable" if name == "s" else "fixed", "exact"), name
    for name in INPUTS:
        assert kinds.pop(name) == ("input", "continuous", None), name
    for name in outputs_of(description):
        assert kinds.pop(name) == ("output", "continuous", "calculated"), name
    for name, kind in kinds.items():
        assert kind == ("local", "discrete" if UNITS[name] is None else "continuous", "calculated"), name
    calculated = [v for v in description.modelVariables if v.initial == "calculated"]
    assert all(v.start is None for v in calculated)


def test_every_start_value_of_the_description_is_what_the_library_starts_with(wheel, description):
    w = wheel().initializing()
    stored = {v.name: v for v in description.modelVariables if v.start is not None}
    assert list(stored) == [*parameters_of(description), *INPUTS]
    for name, v in stored.items():
        start = {"true": 1, "false": 0}.get(v.start) if v.type == "Boolean" else float(v.start)
        status, value = w.get_one(name)
        assert (status, value) == (OK, start), name
        within(abs(value - STARTS.get(name, start)), 8 * EPSILON, "difference")
    assert w.put(m=20.000000000000004).get("m") != [20.0]  # the partner: one unit in the last place


def test_limits_of_the_description_are_those_the_library_enforces(wheel, description):
    """A value one unit beyond a limit is refused at the end of initialization, the limit's inside is taken."""

    def accepted(name: str, value: float) -> bool:
        w = wheel().initializing(**{name: value})
        taken = w.exitInitializationMode() == OK
        texts = [m.text for m in w.take_messages()]
        assert taken or any(text.startswith(name) for text in texts), (name, value, texts)
        w.close()
        return taken

    limited = 0
    for v in description.modelVariables:
        whole = v.type != "Real"
        for limit, outwards in ((v.min, -1), (v.max, 1)):
            if limit is None:
                continue
            limited += 1
            outside = int(limit) + outwards if whole else float(limit) + outwards * max(1e-3, 1e-3 * abs(float(limit)))
            assert not accepted(v.name, outside), (v.name, outside)
        if v.min is not None:
            factor = 0.99 if v.name == "J_z" else 1.01  # J_z is at its limit, J_x + J_y
            assert accepted(v.name, int(v.min) if whole else float(v.start) * factor), v.name
    assert limited == 21


def test_every_unit_is_defined_by_base_units_and_used(description, xml):
    defined = {u.name: u for u in description.unitDefinitions}
    used = {unit_of(v) for v in description.modelVariables} - {None}
    assert used == set(defined)
    assert all(unit.find("BaseUnit") is not None for unit in xml.find("UnitDefinitions"))
    exponents = {name: {k: n for k, n in attrs.asdict(u.baseUnit).items() if n} for name, u in defined.items()}
    newton = {"kg": 1, "m": 1, "s": -2, "factor": 1.0}
    assert exponents["N"] == newton and exponents["J"] == newton | {"m": 2} == exponents["N.m"]
    (degree,) = defined["rad"].displayUnits
    within(abs(degree.factor * FULL_TURN - 360), 2 * 360 * EPSILON, "full turn, degrees")  # 16 digits of 180/pi
    beyond(abs(57.295779513 * FULL_TURN - 360), 4e-11, "full turn, degrees")


def test_choices_are_integers_with_limits_and_their_meanings(description, xml):
    """Not enumerations, which Maestro refuses and libcosim ignores."""
    assert not list(xml.iter("Enumeration")) and not list(xml.iter("SimpleType"))
    variables = {v.name: v for v in description.modelVariables}
    for name, items in CHOICES.items():
        v = variables[name]
        assert (v.type, int(v.min), int(v.max)) == ("Integer", 1, len(items))
        told = re.findall(r"\b(\d) (\w+)", v.description)
        assert {item: int(k) for k, item in told} == items, name


def test_forces_and_moments_have_no_limits_in_the_description_and_the_library_refuses_what_no_wheel_bears(wheel, xml):
    limits = {v.get("name"): set(v[0].attrib) & {"min", "max"} for v in xml.find("ModelVariables")}
    assert {name for name in INPUTS if limits[name]} == {"M_brake"}
    w = wheel().start()
    assert [w.set(**{name: 1e301}) for name in INPUTS] == [DISCARD] * len(INPUTS)
    assert [w.set(**{name: 1e299}) for name in INPUTS] == [OK] * len(INPUTS)
    assert (w.set(M_brake=-1e-9), w.set(M_3=-1e-9)) == (DISCARD, OK)


def test_outputs_are_listed_in_order_and_the_initial_unknowns_are_exactly_the_calculated_outputs(description):
    listed = [unknown.variable.name for unknown in description.outputs]
    assert listed == outputs_of(description)
    derivatives = [unknown.variable.name for unknown in description.derivatives]
    assert derivatives == list(DERIVATIVES)
    assert [d.derivative.name for d in (u.variable for u in description.derivatives)] == list(STATES)
    accelerations = [name for name in derivatives if name not in listed]
    assert [unknown.variable.name for unknown in description.initialUnknowns] == [*listed, *accelerations]


def test_default_experiment_is_complete_and_divides(description):
    d = description.defaultExperiment
    start, stop, step, tolerance = (float(x) for x in (d.startTime, d.stopTime, d.stepSize, d.tolerance))
    assert (start, stop, step) == (0.0, 10.0, 0.01)
    assert 1e-13 <= tolerance <= 1e-6
    assert (stop - start) / step == round((stop - start) / step)


def test_numbers_carry_sixteen_digits_and_the_header_is_right(xml, fmu):
    assert xml.get("fmiVersion") == "2.0" and xml.get("variableNamingConvention") == "flat"
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", xml.get("generationDateAndTime"))
    text = (Path(fmu) / "modelDescription.xml").read_text(encoding="utf-8")
    assert text.startswith('<?xml version="1.0" encoding="UTF-8"?>')
    assert not re.search(r'"[+-]?(nan|inf)', text, re.IGNORECASE)


def test_capabilities_say_what_the_library_can_do(description, xml):
    flags = xml.find("CoSimulation").attrib
    true = {name for name, value in flags.items() if value == "true"}
    assert true == {
        *("canHandleVariableCommunicationStepSize", "canInterpolateInputs", "canNotUseMemoryManagementFunctions"),
        *("canGetAndSetFMUstate", "canSerializeFMUstate", "providesDirectionalDerivative"),
    }
    assert flags["maxOutputDerivativeOrder"] == "1" and flags["modelIdentifier"] == "wheel"
    exchange = xml.find("ModelExchange").attrib
    assert {name for name, value in exchange.items() if value == "true"} == {
        *("canNotUseMemoryManagementFunctions", "canGetAndSetFMUstate", "canSerializeFMUstate"),
        "providesDirectionalDerivative",
    }
    assert (exchange["modelIdentifier"], xml.get("numberOfEventIndicators")) == ("wheel", str(len(INDICATORS)))


def test_log_categories_are_those_the_library_knows(wheel, description):
    names = [category.name for category in description.logCategories]
    assert names == ["logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError", "logAll"]
    w = wheel()
    w.setDebugLogging(True, [*names])
    assert w.take_messages() == []
    w.setDebugLogging(True, ["logAll", "logNothing"])
    assert [m.text for m in w.take_messages()] == ['fmi2SetDebugLogging: there is no category "logNothing".']
