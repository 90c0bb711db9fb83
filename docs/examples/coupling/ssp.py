"""The suspended wheel as an SSP package (System Structure and Parameterization 1.0), and its run by fmpy.

suspended_wheel.ssp holds both FMUs, SystemStructure.ssd with every connection, and the wheel's start values in
suspended_wheel.ssv. fmpy.ssp steps all FMUs in parallel with held values; it starts every connector at zero, which is
why the quarter car carries no load before t_couple.
"""

from __future__ import annotations

import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
from fmpy import read_model_description
from fmpy.model_description import ModelDescription
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssv

from .suspended import CONNECTIONS, GRID, START, STOP, Signal

SPACES = {
    part: f"http://ssp-standard.org/SSP1/SystemStructure{name}"
    for part, name in (("ssc", "Common"), ("ssd", "Description"), ("ssv", "ParameterValues"))
}
SPACES["oms"] = "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd"
NAME = "suspended_wheel"
PARAMETERS = f"resources/{NAME}.ssv"


def _tag(prefixed: str) -> str:
    part, name = prefixed.split(":")
    return f"{{{SPACES[part]}}}{name}"


def _add(parent: ET.Element, prefixed: str, **attributes: str) -> ET.Element:
    return ET.SubElement(parent, _tag(prefixed), attributes)


def _text(root: ET.Element) -> str:
    for part, space in SPACES.items():
        ET.register_namespace(part, space)
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _component(elements: ET.Element, name: str, description: ModelDescription, signals: set[Signal]) -> None:
    """One FMU with the connectors that are used."""
    component = _add(
        elements, "ssd:Component", name=name, source=f"resources/{name}.fmu", type="application/x-fmu-sharedlibrary"
    )
    connectors = _add(component, "ssd:Connectors")
    for variable in description.modelVariables:
        if (name, variable.name) in signals:
            connector = _add(connectors, "ssd:Connector", name=variable.name, kind=variable.causality)
            _add(connector, "ssc:Real", unit=variable.unit)


def structure(fmus: dict[str, Path], step: float) -> str:
    """SystemStructure.ssd as text."""
    root = ET.Element(_tag("ssd:SystemStructureDescription"), {"version": "1.0", "name": NAME})
    system = _add(root, "ssd:System", name=NAME, description="Quarter car on a rolling wheel")
    bindings = _add(system, "ssd:ParameterBindings")
    _add(bindings, "ssd:ParameterBinding", source=PARAMETERS, type="application/x-ssp-parameter-set")
    elements = _add(system, "ssd:Elements")
    signals = {end for pair in CONNECTIONS for end in pair}
    descriptions = {name: read_model_description(str(fmus[name])) for name in ("wheel", "quarter_car")}
    for name, description in descriptions.items():
        _component(elements, name, description, signals)
    connections = _add(system, "ssd:Connections")
    for (source, output), (sink, name) in CONNECTIONS:
        ends = {"startElement": source, "startConnector": output, "endElement": sink, "endConnector": name}
        _add(connections, "ssd:Connection", **ends)
    _fixed_step(system, step)
    _units(root, descriptions["wheel"], signals)
    _add(root, "ssd:DefaultExperiment", startTime="0", stopTime=str(STOP))
    return _text(root)


def _fixed_step(system: ET.Element, step: float) -> None:
    """OMSimulator's annotation: co-simulation by its parallel master with this communication step."""
    annotation = _add(_add(system, "ssd:Annotations"), "ssc:Annotation", type="org.openmodelica")
    information = _add(_add(annotation, "oms:Annotations"), "oms:SimulationInformation")
    how = {"description": "oms-ma", "stepSize": repr(step), "absoluteTolerance": "1e-6", "relativeTolerance": "1e-6"}
    _add(information, "oms:FixedStepMaster", **how)


def _units(root: ET.Element, description: ModelDescription, signals: set[Signal]) -> None:
    """The units of the connectors, all of which are the wheel's."""
    used = {v.unit for v in description.modelVariables if ("wheel", v.name) in signals}
    units = _add(root, "ssd:Units")
    for unit in description.unitDefinitions:
        if unit.name in used:
            powers = {n: str(getattr(unit.baseUnit, n)) for n in ("kg", "m", "s", "rad") if getattr(unit.baseUnit, n)}
            _add(_add(units, "ssc:Unit", name=unit.name), "ssc:BaseUnit", **powers)


def parameters() -> str:
    """The wheel's start values as an SSV parameter set."""
    root = ET.Element(_tag("ssv:ParameterSet"), {"version": "1.0", "name": NAME})
    values = _add(root, "ssv:Parameters")
    for name, value in START.items():
        _add(_add(values, "ssv:Parameter", name=f"wheel.{name}"), "ssv:Real", value=repr(float(value)))
    return _text(root)


def build(fmus: dict[str, Path], folder: Path, step: float = 0.001) -> Path:
    """suspended_wheel.ssp in `folder`."""
    package = folder / f"{NAME}.ssp"
    with zipfile.ZipFile(package, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", structure(fmus, step))
        archive.writestr(PARAMETERS, parameters())
        for name in ("wheel", "quarter_car"):
            archive.write(fmus[name], f"resources/{name}.fmu")
    return package


def simulate(package: Path, step: float, stop: float = STOP, grid: float = GRID) -> dict[str, np.ndarray]:
    """fmpy's run on the comparison grid from `grid` on, columns by variable name.

    fmpy labels what holds after a step with the time before it.
    """
    rows = simulate_ssp(
        str(package), stop_time=stop - step / 2, step_size=step, parameter_set=read_ssv(str(package), PARAMETERS)
    )
    every = round(grid / step)
    rows = rows[every - 1 :: every]
    table = {"time": rows["time"] + step}
    for (name, variable), _ in CONNECTIONS:
        table[variable] = rows[f"{name}.{variable}"]
    return table


def distance(table: dict[str, np.ndarray], truth: dict[str, np.ndarray]) -> float:
    """Largest difference over time of X_O, theta and psi_dot, each relative to its range."""
    return max(
        float(np.abs(table[n] - truth[n][1 : 1 + len(table[n])]).max() / np.ptp(truth[n]))
        for n in ("X_O", "theta", "psi_dot")
    )
