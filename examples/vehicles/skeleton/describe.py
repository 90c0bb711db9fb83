"""Writes an example's modelDescription.xml, terminalsAndIcons.xml and variables.hpp from its table of variables.

    PYTHONPATH=<the project's folder cmake> python describe.py NAME TABLE FOLDER [LAYOUT]

TABLE is a CSV file: causality, name, unit, start, limit (>0 or >=0), depends, description. Its comments (#) come first;
the first of them describes the model. A name with {wheel} stands for one variable per wheel of LAYOUT, a TOML file
whose [wheel.NAME] tables also give start values: {x} is that wheel's x; for other variables they come from its table
[NAME of the model]. `depends` lists the inputs that an output depends on directly (patterns with *); `-` is none.
Numbers and GUID are written as those of the wheel are (cmake/description). variables.hpp names the value references: of
variables per wheel also by the name with `each`, the first wheel's; the next wheel's is wheel_parameters, wheel_inputs
or wheel_outputs further on. The files are templates beside this program; FOLDER/fmu is packed as the FMU.
"""

from __future__ import annotations

import csv
import re
import sys
import tomllib
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from xml.etree import ElementTree

BASE = {  # powers of kg, m, s and rad
    "kg": "1 0 0 0", "m": "0 1 0 0", "s": "0 0 1 0", "rad": "0 0 0 1", "kg.m2": "1 2 0 0", "m/s": "0 1 -1 0",
    "m/s2": "0 1 -2 0", "rad/s": "0 0 -1 1", "N": "1 1 -2 0", "N/m": "1 0 -2 0", "N/m2": "1 -1 -2 0", "1": "0 0 0 0",
    "N.s/m": "1 0 -1 0", "N.m": "1 2 -2 0", "N.m/rad": "1 2 -2 -1", "N.m.s/rad": "1 2 -1 -1", "N.s": "1 1 -1 0",
    "J": "1 2 -2 0", "1/m": "0 -1 0 0", "1/s": "0 0 -1 0", "m/s3": "0 1 -3 0",
}  # fmt: skip
Layout = dict[str, dict[str, dict[str, float | str]]]
KINDS = ("parameter", "input", "output", "local")
RATE = re.compile(r"^([XYZ]_O|psi|theta|delta)(?=_|$)")  # inputs that may have their rate beside them: X_O_dot_left


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

    @property
    def given(self) -> bool:
        """Whether it has a start value."""
        return self.causality in ("parameter", "input")


def read(name: str, table: Path, layout: Layout) -> tuple[str, list[Variable]]:
    """The model's description and all variables, those per wheel written out wheel by wheel."""
    lines = table.read_text().splitlines()
    about = next(line.lstrip("# ") for line in lines if line.startswith("#"))
    rows = list(csv.DictReader(line for line in lines if line and not line.startswith("#")))
    variables: list[Variable] = []
    for kind in KINDS:
        for wheel, properties in [("", layout.get(name, {})), *layout.get("wheel", {}).items()]:
            of_kind = [row for row in rows if row["causality"] == kind and ("{wheel}" in row["name"]) == bool(wheel)]
            variables += [_variable(row, wheel, properties) for row in of_kind]
    return about, variables


def _variable(row: dict[str, str], wheel: str, properties: dict[str, float | str]) -> Variable:
    text = {key: (value or "").format(wheel=wheel, **properties).strip() for key, value in row.items()}
    typed = {"start": float(text["start"] or 0), "depends": tuple(text["depends"].split())}
    return Variable(**text | typed, of=row["name"].format(wheel="each") if wheel else "")


def main() -> None:
    """Writes the files; terminalsAndIcons.xml only where there are wheels."""
    from description.numbering import numbered
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    name, table, folder, *layout = sys.argv[1:]
    given: Layout = tomllib.loads(Path(layout[0]).read_text()) if layout else {}
    (about, variables), wheels = read(name, Path(table), given), given.get("wheel", {})
    loader = FileSystemLoader(Path(__file__).parent)
    templates = Environment(
        loader=loader, autoescape=lambda name: ".xml" in name, undefined=StrictUndefined, keep_trailing_newline=True
    )

    def rendered(file: str, **values: object) -> str:
        return templates.get_template(f"{file}.jinja").render(variables=variables, wheels=wheels, **values)

    inputs, parameters = ([v.name for v in variables if v.causality == kind] for kind in ("input", "parameter"))
    outputs = {
        v.name: [n for n in inputs if any(fnmatchcase(n, p) for p in v.depends)]
        for v in variables
        if v.causality == "output"
    }
    unknowns = {output: parameters + on for output, on in outputs.items()}  # states at the start follow from parameters
    powers = {unit: dict(zip(("kg", "m", "s", "rad"), text.split(), strict=True)) for unit, text in BASE.items()}
    xml = numbered(
        rendered("modelDescription.xml", name=name, about=about, base=powers),
        {"Outputs": outputs, "InitialUnknowns": unknowns},
    )
    rates = [RATE.sub(r"\1_dot", n) for n in inputs]
    header = rendered(
        "variables.hpp",
        guid=ElementTree.fromstring(xml.encode()).get("guid"),
        each=[v for v in variables if v.of and v.name == v.of.replace("each", next(iter(wheels)))],
        rates=[inputs.index(r) if r in inputs and r != n else -1 for n, r in zip(inputs, rates, strict=True)],
        partners=[list(wheels).index(w["bar_to"]) if "bar_to" in w else -1 for w in wheels.values()],
    )
    files = {"fmu/modelDescription.xml": xml, "variables.hpp": header}
    if wheels:
        files["fmu/terminalsAndIcons/terminalsAndIcons.xml"] = rendered("terminalsAndIcons.xml")
    for file, text in files.items():
        (Path(folder) / file).parent.mkdir(parents=True, exist_ok=True)
        (Path(folder) / file).write_text(text)


if __name__ == "__main__":
    main()
