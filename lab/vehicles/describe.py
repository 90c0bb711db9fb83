"""Writes an example's modelDescription.xml and variables.hpp from its table of variables.

    python -m lab.vehicles.describe TABLE FOLDER

TABLE is a CSV file NAME.csv: causality, name, unit, start, limit (>0 or >=0), depends, description. Its comments (#)
come first; the first of them describes the model. A name with {wheel} stands for one variable per wheel of the layout,
the TOML file named after TABLE's folder, in it. Its [wheel.NAME] tables also give start values: {x} is that wheel's x;
for other variables they come from its table [NAME of the model]. `depends` lists the inputs that an output depends on
directly (patterns with *); `-` is none. Numbers and GUID are written as those of the wheel are (fmu.description).
variables.hpp names the value references: of variables per wheel also by the name with `each`, the first wheel's; the
next wheel's is wheel_parameters, wheel_inputs or wheel_outputs further on. The templates and units.csv are beside this
program; FOLDER/fmu is packed as the FMU.
"""

import csv
import re
import sys
import tomllib
from fnmatch import fnmatchcase
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

HERE = Path(__file__).parent
RATE = re.compile(r"^([XYZ]_O|psi|theta|delta)(?=_|$)")  # inputs that may have their rate beside them: X_O_dot_left


class Variable(NamedTuple):
    """One scalar variable; `of` is its name with `each` in the place of the wheel, empty if it is of no wheel."""

    causality: str
    name: str
    unit: str
    start: float
    limit: str
    depends: tuple[str, ...]
    description: str
    of: str = ""


Wheels = dict[str, dict[str, float | str]]


def read(table: Path) -> tuple[str, Wheels, list[Variable]]:
    """The model's description, the layout's wheels, and all variables, those per wheel written out wheel by wheel."""
    layout = table.with_name(f"{table.parent.name}.toml")
    given = tomllib.loads(layout.read_text()) if layout.exists() else {}
    lines = table.read_text().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    wheels, variables = given.get("wheel", {}), []
    for kind in ("parameter", "input", "output", "local"):
        for wheel, properties in [("", given.get(table.stem, {})), *wheels.items()]:
            of_kind = [row for row in rows if row["causality"] == kind and ("{wheel}" in row["name"]) == bool(wheel)]
            variables += [_variable(row, wheel, properties) for row in of_kind]
    return lines[0].lstrip("# "), wheels, variables


def _variable(row: dict[str, str], wheel: str, properties: dict[str, float | str]) -> Variable:
    text = {key: (value or "").format(wheel=wheel, **properties).strip() for key, value in row.items()}
    typed = {"start": float(text["start"] or 0), "depends": tuple(text["depends"].split())}
    return Variable(**text | typed, of=row["name"].format(wheel="each") if wheel else "")


def main() -> None:
    """Writes the files."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    from wheelfmu.fmu.description.numbering import numbered

    table, folder = map(Path, sys.argv[1:])
    about, wheels, variables = read(table)
    kinds = ("input", "parameter", "output")
    inputs, parameters, outputs = ({v.name: v.depends for v in variables if v.causality == kind} for kind in kinds)
    known = {output: [n for n in inputs if any(fnmatchcase(n, p) for p in on)] for output, on in outputs.items()}
    at_start = {output: [*parameters, *on] for output, on in known.items()}  # states follow from parameters
    number = {name: k for k, name in enumerate(inputs)}
    rates = [number.get(rate, -1) if found else -1 for rate, found in (RATE.subn(r"\1_dot", name) for name in inputs)]
    values = {"variables": variables, "wheels": wheels, "rates": rates, "name": table.stem, "about": about}
    values["units"] = {row["unit"]: row for row in csv.DictReader((HERE / "units.csv").read_text().splitlines())}
    how = {"undefined": StrictUndefined, "keep_trailing_newline": True}
    templates = Environment(loader=FileSystemLoader(HERE), autoescape=lambda name: ".xml" in name, **how)

    description = templates.get_template("modelDescription.xml.jinja").render(values)
    description = numbered(description, {"Outputs": known, "InitialUnknowns": at_start})
    values["guid"] = ElementTree.fromstring(description.encode()).attrib["guid"]
    (folder / "fmu").mkdir(parents=True, exist_ok=True)
    (folder / "fmu" / "modelDescription.xml").write_text(description)
    (folder / "variables.hpp").write_text(templates.get_template("variables.hpp.jinja").render(values))


if __name__ == "__main__":
    main()
