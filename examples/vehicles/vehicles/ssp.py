"""A system of FMUs as an SSP package (System Structure and Parameterization 1.0), and its run by fmpy.

NAME.ssp holds the FMUs, SystemStructure.ssd with every connection, and one SSV parameter set per component, bound at
that component: bound at the system, tools that look at components only would leave them out without a word.
fmpy.ssp steps all FMUs in parallel with held values. It begins with every connector at zero, which is why the bodies
couple a moment later (t_couple), and it takes one parameter set for all components: `run` puts them together.
"""

from __future__ import annotations

import zipfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
from fmpy import read_model_description
from fmpy.model_description import ModelDescription
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import ParameterSet, find_components, read_ssd, read_ssv

from .component import Component
from .master import Connection, Signal

SPACES = {
    part: f"http://ssp-standard.org/SSP1/SystemStructure{name}"
    for part, name in (("ssc", "Common"), ("ssd", "Description"), ("ssv", "ParameterValues"))
}
SPACES["oms"] = "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd"
SSV = "application/x-ssp-parameter-set"
FMU = "application/x-fmu-sharedlibrary"


@dataclass(frozen=True)
class System:
    """What goes into a package."""

    name: str
    components: list[Component]
    connections: list[Connection]
    step: float  # s
    stop: float  # s


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


def _component(elements: ET.Element, part: Component, description: ModelDescription, signals: set[Signal]) -> None:
    """One FMU with its outputs, the inputs that are connected, and its parameters."""
    component = _add(elements, "ssd:Component", name=part.name, source=f"resources/{part.path.name}", type=FMU)
    connectors = _add(component, "ssd:Connectors")
    for variable in description.modelVariables:
        if (part.name, variable.name) in signals or (variable.causality == "output" and variable.type == "Real"):
            connector = _add(connectors, "ssd:Connector", name=variable.name, kind=variable.causality)
            _add(connector, "ssc:Real", **({"unit": variable.unit} if variable.unit else {}))
    if part.start:
        bindings = _add(component, "ssd:ParameterBindings")
        _add(bindings, "ssd:ParameterBinding", source=f"resources/{part.name}.ssv", type=SSV)


def structure(system: System) -> str:
    """SystemStructure.ssd as text."""
    descriptions = {c.name: read_model_description(str(c.path), validate=False) for c in system.components}
    signals = {signal for pair in system.connections for signal in pair}
    root = ET.Element(_tag("ssd:SystemStructureDescription"), {"version": "1.0", "name": system.name})
    top = _add(root, "ssd:System", name=system.name)
    elements = _add(top, "ssd:Elements")
    for component in system.components:
        _component(elements, component, descriptions[component.name], signals)
    connections = _add(top, "ssd:Connections")
    for (source, output), (sink, name) in system.connections:
        ends = {"startElement": source, "startConnector": output, "endElement": sink, "endConnector": name}
        _add(connections, "ssd:Connection", **ends)
    _fixed_step(top, system.step)
    _units(root, descriptions, signals)
    _add(root, "ssd:DefaultExperiment", startTime="0", stopTime=repr(system.stop))
    return _text(root)


def _fixed_step(system: ET.Element, step: float) -> None:
    """OMSimulator's annotation: co-simulation by its parallel master with this communication step."""
    annotation = _add(_add(system, "ssd:Annotations"), "ssc:Annotation", type="org.openmodelica")
    information = _add(_add(annotation, "oms:Annotations"), "oms:SimulationInformation")
    how = {"description": "oms-ma", "stepSize": repr(step), "absoluteTolerance": "1e-6", "relativeTolerance": "1e-6"}
    _add(information, "oms:FixedStepMaster", **how)


def _units(root: ET.Element, descriptions: dict[str, ModelDescription], signals: set[Signal]) -> None:
    """The units of the connectors."""
    units = _add(root, "ssd:Units")
    written = set()
    for name, description in descriptions.items():
        given = [v for v in description.modelVariables if (name, v.name) in signals or v.causality == "output"]
        used = {v.unit for v in given} - written
        for unit in description.unitDefinitions:
            if unit.name in used:
                powers = {n: getattr(unit.baseUnit, n) for n in ("kg", "m", "s", "rad")}
                powers = {n: str(power) for n, power in powers.items() if power}
                _add(_add(units, "ssc:Unit", name=unit.name), "ssc:BaseUnit", **powers)
        written |= used


def parameters(component: Component) -> str:
    """A component's start values as an SSV parameter set."""
    kinds = {v.name: v.type for v in read_model_description(str(component.path), validate=False).modelVariables}
    root = ET.Element(_tag("ssv:ParameterSet"), {"version": "1.0", "name": "start"})  # ecos asks for it by name
    values = _add(root, "ssv:Parameters")
    for name, value in component.start.items():
        parameter = _add(values, "ssv:Parameter", name=name)
        if kinds[name] == "Boolean":
            _add(parameter, "ssv:Boolean", value="true" if value else "false")
        else:
            _add(parameter, "ssv:Real", value=repr(float(value)))
    return _text(root)


def build(system: System, folder: Path) -> Path:
    """folder/NAME.ssp."""
    package = folder / f"{system.name}.ssp"
    with zipfile.ZipFile(package, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", structure(system))
        for component in system.components:
            if component.start:
                archive.writestr(f"resources/{component.name}.ssv", parameters(component))
        for path in dict.fromkeys(component.path for component in system.components):
            archive.write(path, f"resources/{path.name}")
    return package


def parameter_set(package: Path) -> ParameterSet:
    """The parameter sets bound at the components as one, each name with its component in front."""
    every = ParameterSet(name="all", parameters=[])
    for component in find_components(read_ssd(str(package)).system):
        for binding in component.parameterBindings:
            for parameter in read_ssv(str(package), binding.source).parameters:
                parameter.name = f"{component.name}.{parameter.name}"
                every.parameters.append(parameter)
    return every


def run(package: Path, step: float, stop: float, grid: float) -> np.ndarray:
    """fmpy's run on the grid, from `grid` on; columns "component.connector".

    fmpy labels what holds after a step with the time before it.
    """
    rows = simulate_ssp(str(package), stop_time=stop - step / 2, step_size=step, parameter_set=parameter_set(package))
    every = round(grid / step)
    rows = rows[every - 1 :: every]
    rows["time"] += step
    return rows
