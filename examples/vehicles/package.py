"""Packs a system of FMUs as an SSP package (System Structure and Parameterization 1.0). Standard library alone.

    python package.py SYSTEM.toml PACKAGE.ssp FMU...

SYSTEM.toml has the components with their FMUs, the connections, the start values, the communication step and the end.
The package binds each component's start values there, as a parameter set (SSV): tools that look at components alone
would leave out a set bound at the system. start.ssv holds the values of all components, for FMPy, which takes one set.
"""

import sys
import tomllib
from pathlib import Path
from xml.etree import ElementTree
from zipfile import ZIP_DEFLATED, ZipFile

HEAD = '<?xml version="1.0" encoding="UTF-8"?>'
SSP = "http://ssp-standard.org/SSP1/SystemStructure"
OMS = "https://raw.githubusercontent.com/OpenModelica/OMSimulator/master/schema/oms.xsd"
OMSIMULATOR = """    <ssd:Annotations><!-- OMSimulator: its parallel master with this communication step -->
      <ssc:Annotation type="org.openmodelica"><oms:Annotations><oms:SimulationInformation>
        <oms:FixedStepMaster description="oms-ma" stepSize="{step}" absoluteTolerance="1e-6" relativeTolerance="1e-6"/>
      </oms:SimulationInformation></oms:Annotations></ssc:Annotation>
    </ssd:Annotations>"""


def read(path):
    """A system: `fmus` by component; `connections`, pairs of (component, variable), from output to input; `start`
    values by component; `step` and `stop`, s.

    A connection lists two components and the variables by the names that they have in the second; {wheel} stands for
    each component of wheel.fmu, which has the same name without its end _{wheel}.
    """
    system = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    fmus, start = system["fmus"], system["start"]
    connections = []
    for source, sink, *names in system["connect"]:
        for wheel in [name for name, fmu in fmus.items() if fmu == "wheel"] if "{wheel}" in (source, sink) else [""]:
            for name in names:
                ends = [(end.format(wheel=wheel), name.format(wheel=wheel)) for end in (source, sink)]
                connections.append(
                    tuple((end, of.removesuffix(f"_{wheel}") if end == wheel else of) for end, of in ends)
                )
    values = {name: start.get(fmu, {}) | start.get(name, {}) for name, fmu in fmus.items()}
    return system | {"connections": connections, "start": values}


def parameter_set(values):
    """An SSV file."""
    rows = [
        HEAD,
        f'<ssv:ParameterSet version="1.0" name="start" xmlns:ssv="{SSP}ParameterValues">',
        "  <ssv:Parameters>",
    ]
    for name, value in values.items():
        kind, text = ("Boolean", str(value).lower()) if isinstance(value, bool) else ("Real", repr(float(value)))
        rows.append(f'    <ssv:Parameter name="{name}"><ssv:{kind} value="{text}"/></ssv:Parameter>')
    return "\n".join([*rows, "  </ssv:Parameters>", "</ssv:ParameterSet>", ""])


def component(name, fmu, description, connected):
    """Of the structure: all outputs, the inputs that are connected, and the parameter set."""
    rows = [f'      <ssd:Component name="{name}" source="resources/{fmu}.fmu" type="application/x-fmu-sharedlibrary">']
    rows.append("        <ssd:Connectors>")
    for variable in description.iter("ScalarVariable"):
        of, kind = variable.get("name"), variable.get("causality")
        if variable[0].tag == "Real" and (kind == "output" or (name, of) in connected):
            rows.append(f'          <ssd:Connector name="{of}" kind="{kind}"><ssc:Real/></ssd:Connector>')
    source = f'source="resources/{name}.ssv" type="application/x-ssp-parameter-set"'
    binding = f"<ssd:ParameterBindings><ssd:ParameterBinding {source}/></ssd:ParameterBindings>"
    return [*rows, "        </ssd:Connectors>", f"        {binding}", "      </ssd:Component>"]


def structure(name, system, descriptions):
    """SystemStructure.ssd."""
    connected = {end for pair in system["connections"] for end in pair}
    spaces = f'xmlns:ssd="{SSP}Description" xmlns:ssc="{SSP}Common" xmlns:oms="{OMS}"'
    rows = [HEAD, f'<ssd:SystemStructureDescription version="1.0" name="{name}" {spaces}>']
    rows += [f'  <ssd:System name="{name}">', "    <ssd:Elements>"]
    for part, fmu in system["fmus"].items():
        rows += component(part, fmu, descriptions[fmu], connected)
    rows += ["    </ssd:Elements>", "    <ssd:Connections>"]
    for source, sink in system["connections"]:
        ends = 'startElement="{}" startConnector="{}" endElement="{}" endConnector="{}"'.format(*source, *sink)
        rows.append(f"      <ssd:Connection {ends}/>")
    rows += ["    </ssd:Connections>", OMSIMULATOR.format(step=system["step"]), "  </ssd:System>"]
    end = f'  <ssd:DefaultExperiment startTime="0" stopTime="{system["stop"]}"/>'
    return "\n".join([*rows, end, "</ssd:SystemStructureDescription>", ""])


def write(package, system, files):
    """The file `package` of a system as read() returns it; `files`: the paths of the FMUs by name."""
    descriptions = {}
    with ZipFile(package, "w", ZIP_DEFLATED) as archive:
        for fmu in sorted(set(system["fmus"].values())):
            descriptions[fmu] = ElementTree.fromstring(ZipFile(files[fmu]).read("modelDescription.xml"))
            archive.write(files[fmu], f"resources/{fmu}.fmu")
        archive.writestr("SystemStructure.ssd", structure(Path(package).stem, system, descriptions))
        for name, values in system["start"].items():
            archive.writestr(f"resources/{name}.ssv", parameter_set(values))
        every = {f"{name}.{of}": value for name, values in system["start"].items() for of, value in values.items()}
        archive.writestr("resources/start.ssv", parameter_set(every))


if __name__ == "__main__":
    of, to, *fmus = sys.argv[1:]
    write(to, read(of), {Path(fmu).stem: fmu for fmu in fmus})
