"""Writes the variables of modelDescription.xml as rows for C and C++: variables.inc, for the library and its tests.

No paper equation; SI units as in the description. A row of a parameter or input, and of a calculated variable:

    STORED(name, type, role, start, min, max)    a limit that the description does not set is `unlimited`
    COMPUTED(name, type, role)

Rows stand in the order of their value references, which count from zero: parameters, inputs, outputs, locals. Both
macros end with the rows.
"""

from __future__ import annotations

import argparse
import re
from pathlib import Path
from xml.etree import ElementTree

ROLES = ("parameter", "input", "output", "local")
TYPES = ("Real", "Integer", "Boolean")
BOOLEAN = {"false": "0", "true": "1"}


def check(variables: list[ElementTree.Element]) -> None:
    """One sentence for a description that the rows cannot follow."""
    kinds = [ROLES.index(v.get("causality")) for v in variables]
    if [int(v.get("valueReference")) for v in variables] != list(range(len(variables))):
        raise SystemExit(
            "The value references of modelDescription.xml must count from 0 in the order of the variables."
        )
    if kinds != sorted(kinds):
        raise SystemExit(f"modelDescription.xml must list its variables in the order {', '.join(ROLES)}.")
    for variable in variables:
        name, (typed,) = variable.get("name"), variable
        if not re.fullmatch(r"[A-Za-z]\w*", name):
            raise SystemExit(f'The variable name "{name}" of modelDescription.xml is no name in C.')
        if typed.tag not in TYPES:
            raise SystemExit(f"{name} of modelDescription.xml is of type {typed.tag}; {', '.join(TYPES)} are known.")


def row(variable: ElementTree.Element) -> str:
    (typed,) = variable
    name, kind, role = variable.get("name"), typed.tag.lower(), variable.get("causality")
    if role in ("output", "local"):
        return f"COMPUTED({name}, {kind}, {role})"
    if variable.get("variability") == "tunable":
        role = "tunable"
    if kind == "boolean":
        return f"STORED({name}, {kind}, {role}, {BOOLEAN[typed.get('start')]}, 0, 1)"
    low, high = typed.get("min", "-unlimited"), typed.get("max", "unlimited")
    return f"STORED({name}, {kind}, {role}, {typed.get('start')}, {low}, {high})"


def rows(description: Path) -> str:
    variables = list(ElementTree.parse(description).getroot().iter("ScalarVariable"))
    check(variables)
    return "".join(f"{row(variable)}\n" for variable in variables) + "#undef STORED\n#undef COMPUTED\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("description", type=Path, help="modelDescription.xml")
    parser.add_argument("output", type=Path, help="the file to write")
    arguments = parser.parse_args()
    arguments.output.write_text(rows(arguments.description), encoding="utf-8")


if __name__ == "__main__":
    main()
