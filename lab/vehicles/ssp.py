"""A system of FMUs as an SSP package (System Structure and Parameterization 1.0), and its run by fmpy.

NAME.ssp holds the FMUs, SystemStructure.ssd with every connection, and one SSV parameter set per component, bound at
that component: tools that look at components only would silently leave out one bound at the system. fmpy.ssp steps all
FMUs in parallel with held values. It begins with every connector at zero, which is why the bodies couple a moment later
(t_couple), and it takes one parameter set for all components: `run` puts them together.
"""

import zipfile
from pathlib import Path

import numpy as np
from fmpy import read_model_description
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import ParameterSet, find_components, read_ssd, read_ssv
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from .master import Component, Connection

TEMPLATES = Environment(loader=FileSystemLoader(Path(__file__).parent), undefined=StrictUndefined, autoescape=True)


def build(package: Path, parts: list[Component], connections: list[Connection], step: float, stop: float) -> Path:
    """The file `package`. Connectors: all outputs, and the inputs that are connected; units as in the FMUs."""
    structure, parameters = (TEMPLATES.get_template(f"{n}.jinja") for n in ("SystemStructure.ssd", "parameters.ssv"))
    connected, connectors, units = {signal for pair in connections for signal in pair}, {}, {}
    with zipfile.ZipFile(package, "w", zipfile.ZIP_DEFLATED) as archive:
        for part in parts:
            of = read_model_description(str(part.path), validate=False)
            shown = {v.name for v in of.modelVariables if v.causality == "output" and v.type == "Real"}
            shown |= {name for component, name in connected if component == part.name}
            connectors[part.name] = [v for v in of.modelVariables if v.name in shown]
            used = {v.unit for v in connectors[part.name]}
            units |= {unit.name: unit.baseUnit for unit in of.unitDefinitions if unit.name in used}
            if part.start:
                kinds = {v.name: v.type for v in of.modelVariables}
                archive.writestr(f"resources/{part.name}.ssv", parameters.render(part=part, kinds=kinds))
        system = {"name": package.stem, "parts": parts, "connections": connections, "step": step, "stop": stop}
        archive.writestr("SystemStructure.ssd", structure.render(**system, connectors=connectors, units=units))
        for path in dict.fromkeys(part.path for part in parts):
            archive.write(path, f"resources/{path.name}")
    return package


def parameter_set(package: Path) -> ParameterSet:
    """The parameter sets bound at the components as one, each name with its component in front."""
    bound = [(c.name, b.source) for c in find_components(read_ssd(str(package)).system) for b in c.parameterBindings]
    every = [(name, parameter) for name, source in bound for parameter in read_ssv(str(package), source).parameters]
    for name, parameter in every:
        parameter.name = f"{name}.{parameter.name}"
    return ParameterSet(name="all", parameters=[parameter for _, parameter in every])


def run(package: Path, step: float, stop: float, grid: float) -> dict[str, np.ndarray]:
    """fmpy's run on the grid, from `grid` on; columns by "component.connector".

    fmpy labels the state after a step with the time before it.
    """
    how, every = {"step_size": step, "parameter_set": parameter_set(package)}, round(grid / step)
    rows = simulate_ssp(str(package), stop_time=stop - step / 2, **how)[every - 1 :: every]
    rows["time"] += step
    return {name: rows[name] for name in rows.dtype.names}
