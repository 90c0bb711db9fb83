"""Writes an example's modelDescription.xml, terminalsAndIcons.xml and variables.h from its table of variables.

    python describe.py NAME TABLE FOLDER [LAYOUT]

TABLE is a CSV file: causality, name, unit, start, limit (>0 or >=0), depends, description. Its comments (#) come first;
the first of them describes the model. A name with {wheel} stands for one variable per wheel of LAYOUT, a TOML file
whose [wheel.NAME] tables also give start values: {x} is that wheel's x; for other variables they come from its table
[NAME of the model]. `depends` lists the inputs that an output depends on directly (patterns with *); `-` is none.
Numbers and GUID are written as those of the wheel are (cmake/description). variables.h names the value references: of
variables per wheel also by the name with `each`, the first wheel's; the next wheel's is wheel_parameters, wheel_inputs
or wheel_outputs further on.
"""

from __future__ import annotations

import csv
import sys
import tomllib
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "cmake"))
from description.numbering import numbered

BASE = {
    "kg": "kg=1", "m": "m=1", "s": "s=1", "rad": "rad=1", "kg.m2": "kg=1 m=2", "m/s": "m=1 s=-1", "m/s2": "m=1 s=-2",
    "rad/s": "rad=1 s=-1", "N": "kg=1 m=1 s=-2", "N/m": "kg=1 s=-2", "N/m2": "kg=1 m=-1 s=-2", "N.s/m": "kg=1 s=-1",
    "N.m": "kg=1 m=2 s=-2", "N.m/rad": "kg=1 m=2 s=-2 rad=-1", "N.m.s/rad": "kg=1 m=2 s=-1 rad=-1",
    "N.s": "kg=1 m=1 s=-1", "J": "kg=1 m=2 s=-2", "1/m": "m=-1", "1/s": "s=-1", "m/s3": "m=1 s=-3", "1": "",
}  # fmt: skip
Layout = dict[str, dict[str, dict[str, float | str]]]
WITH_RATE = ("X_O", "Y_O", "Z_O", "psi", "theta", "delta")  # inputs that may have their rate beside them
KINDS = ("parameter", "input", "output", "local")


@dataclass(frozen=True)
class Variable:
    """One scalar variable; `of` is its name with `each` in the place of the wheel, empty if it is of no wheel."""

    causality: str
    name: str
    unit: str
    start: float
    limit: str
    depends: tuple[str, ...]
    description: str
    of: str = ""


def read(name: str, table: Path, layout: Layout) -> tuple[str, list[Variable]]:
    """The model's description and all variables, those per wheel written out wheel by wheel."""
    lines = table.read_text().splitlines()
    about = next(line.lstrip("# ") for line in lines if line.startswith("#"))
    rows = list(csv.DictReader(line for line in lines if line and not line.startswith("#")))
    variables: list[Variable] = []
    for kind in KINDS:
        of_kind = [row for row in rows if row["causality"] == kind]
        variables += [_variable(row, "", layout.get(name, {})) for row in of_kind if "{wheel}" not in row["name"]]
        each = [row for row in of_kind if "{wheel}" in row["name"]]
        for wheel, properties in layout.get("wheel", {}).items():
            variables += [_variable(row, wheel, properties) for row in each]
    return about, variables


def _variable(row: dict[str, str], wheel: str, properties: dict[str, float | str]) -> Variable:
    text = {key: (value or "").format(wheel=wheel, **properties) for key, value in row.items()}
    return Variable(
        row["causality"],
        text["name"],
        row["unit"],
        float(text["start"] or 0),
        row["limit"],
        tuple(text["depends"].split()),
        text["description"].strip(),
        row["name"].format(wheel="each") if wheel else "",
    )


def matching(variable: Variable, variables: list[Variable]) -> list[str]:
    """The inputs that an output depends on."""
    inputs = [v.name for v in variables if v.causality == "input"]
    return [name for name in inputs if any(fnmatchcase(name, pattern) for pattern in variable.depends)]


def _scalar(v: Variable) -> str:
    how = {
        "parameter": 'causality="parameter" variability="fixed" initial="exact"',
        "input": 'causality="input" variability="continuous"',
        "output": 'causality="output" variability="continuous" initial="calculated"',
        "local": 'causality="local" variability="continuous" initial="calculated"',
    }[v.causality]
    start = f' start="{v.start!r}"' if v.causality in ("parameter", "input") else ""
    least, above = ' min="0"' if v.limit else "", ", above 0" if v.limit == ">0" else ""
    return (
        f'    <ScalarVariable name="{v.name}" {how}\n'
        f'      description={quoteattr(v.description + above)}><Real unit="{v.unit}"{least}{start}/></ScalarVariable>'
    )


def _units(variables: list[Variable]) -> list[str]:
    lines = []
    for unit in dict.fromkeys(v.unit for v in variables):
        powers = " ".join(f'{p.split("=")[0]}="{p.split("=")[1]}"' for p in BASE[unit].split())
        lines.append(f'    <Unit name="{unit}"><BaseUnit {powers}/></Unit>'.replace(" />", "/>"))
    return lines


def description(name: str, about: str, variables: list[Variable]) -> str:
    """modelDescription.xml as text."""
    parameters = [v.name for v in variables if v.causality == "parameter"]
    outputs = {v.name: matching(v, variables) for v in variables if v.causality == "output"}
    # The states at the start follow from the parameters.
    start = {name: parameters + inputs for name, inputs in outputs.items()}
    text = "\n".join([
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid=""',
        f"  description={quoteattr(about)}",
        '  generationDateAndTime="2026-11-21T00:00:00Z" variableNamingConvention="flat" numberOfEventIndicators="0">',
        f'  <CoSimulation modelIdentifier="{name}" canHandleVariableCommunicationStepSize="true"',
        '    canInterpolateInputs="true" maxOutputDerivativeOrder="1" canNotUseMemoryManagementFunctions="true"',
        '    canGetAndSetFMUstate="true" canSerializeFMUstate="true"/>',
        "  <UnitDefinitions>", *_units(variables), "  </UnitDefinitions>",
        "  <LogCategories>",
        '    <Category name="logStatusError" description="what was wrong with a call or a parameter"/>',
        "  </LogCategories>",
        '  <DefaultExperiment startTime="0" stopTime="10" stepSize="0.001"/>',
        "  <ModelVariables>", *map(_scalar, variables), "  </ModelVariables>",
        "  <ModelStructure/>",
        "</fmiModelDescription>", "",
    ])  # fmt: skip
    return numbered(text, {"Outputs": outputs, "InitialUnknowns": start})


def rate_name(name: str) -> str:
    """X_O_left -> X_O_dot_left, psi -> psi_dot; empty if an input of this name has no rate among the inputs."""
    for stem in WITH_RATE:
        if name == stem or (name.startswith(f"{stem}_") and not name.startswith(f"{stem}_dot")):
            return f"{stem}_dot{name.removeprefix(stem)}"
    return ""


def header(guid: str, variables: list[Variable], wheels: dict[str, dict[str, float | str]]) -> str:
    """variables.h as text."""
    of = [v.causality for v in variables]
    first = next(iter(wheels), None)
    numbers = {v.name: i for i, v in enumerate(variables)}
    numbers |= {v.of: i for i, v in reversed(list(enumerate(variables))) if v.of}
    stride = {kind: sum(v.causality == kind and bool(v.of) for v in variables) // max(len(wheels), 1) for kind in KINDS}
    numbers |= {
        "first_input": of.count("parameter"),
        "input_count": of.count("input"),
        "first_output": of.count("parameter") + of.count("input"),
        "variable_count": len(variables),
        "wheel_count": len(wheels),
        **{f"wheel_{kind}s": count for kind, count in stride.items()},
    }
    given = [v for v in variables if v.causality in ("parameter", "input")]
    limits = {"": 0, ">=0": 1, ">0": 2}
    stored = ", ".join(f'{{"{v.name}", "{v.unit}", {v.start!r}, {limits[v.limit]}}}' for v in given)
    inputs = {v.name: i for i, v in enumerate(v for v in variables if v.causality == "input")}
    rates = [inputs.get(rate, -1) for rate in map(rate_name, inputs)]
    partner = [list(wheels).index(w["bar_to"]) if "bar_to" in w else -1 for w in wheels.values()]
    return "\n".join([
        "/* Value references of an example: generated from its table of variables. */",
        "#ifndef VARIABLES_H", "#define VARIABLES_H",
        f"#define MODEL_GUID \"{guid}\"",
        "enum {", *(f"  {key} = {value}," for key, value in numbers.items()), "};",
        "/* Parameters and inputs: name, unit, start value; limit: 1 a value must be at least 0, 2 above 0. */",
        "typedef struct Stored {", "  const char *name, *unit;", "  double start;", "  int limit;", "} Stored;",
        f"static const Stored stored[] = {{{stored}}};",
        "/* Of each input the input that is its rate, or -1. */",
        f"static const int rate_of[] = {{{', '.join(map(str, rates or [-1]))}}};",
        *([f"static const int bar_partner[] = {{{', '.join(map(str, partner))}}};"] if first else []),
        "#endif", "",
    ])  # fmt: skip


def terminals(variables: list[Variable], wheels: list[str]) -> str:
    """terminalsAndIcons.xml: per wheel what goes to its hub terminal, by the wheel's own names (rule `bus`)."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', '<fmiTerminalsAndIcons fmiVersion="3.0">', "  <Terminals>"]
    for wheel in wheels:
        lines.append(f'    <Terminal name="{wheel}" matchingRule="bus" description="To the terminal hub of the wheel">')
        for v in variables:
            if v.causality in ("input", "output") and v.of and v.name.endswith(f"_{wheel}"):
                member = v.name.removesuffix(f"_{wheel}")
                names = f'variableName="{v.name}" memberName="{member}"'
                lines.append(f'      <TerminalMemberVariable {names} variableKind="signal"/>')
        lines.append("    </Terminal>")
    return "\n".join([*lines, "  </Terminals>", "</fmiTerminalsAndIcons>", ""])


def main() -> None:
    """Writes the files; terminalsAndIcons.xml only where there are wheels."""
    name, table, folder, *layout = sys.argv[1:]
    given: Layout = tomllib.loads(Path(layout[0]).read_text()) if layout else {}
    about, variables = read(name, Path(table), given)
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    xml = description(name, about, variables)
    (target / "modelDescription.xml").write_text(xml)
    if given.get("wheel"):
        (target / "terminalsAndIcons.xml").write_text(terminals(variables, list(given["wheel"])))
    guid = ElementTree.fromstring(xml.encode()).get("guid")
    (target / "variables.h").write_text(header(guid, variables, given.get("wheel", {})))


if __name__ == "__main__":
    main()
