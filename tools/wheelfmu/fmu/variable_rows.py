"""variable_rows.py DESCRIPTION OUTPUT: the variables of modelDescription.xml as rows for C and C++ (variables.inc).

No paper equation; SI units as in the description. A row of a parameter or input, and of a calculated variable:

    STORED(name, reference, type, role, start, min, max)    a limit that the description does not set is `unlimited`
    COMPUTED(name, reference, type, role)

Rows stand in the order of the description: parameters, inputs, outputs, locals. A value reference is any number that
no other variable has. Both macros end with the rows.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from xml.etree import ElementTree

ROLES = ("parameter", "input", "output", "local")
TYPES = ("Real", "Integer", "Boolean")
BOOLEAN = {"false": "0", "true": "1"}


def check(variables: list[ElementTree.Element]) -> None:
    """One sentence for a description that the rows cannot follow."""
    roles = [ROLES.index(v.attrib["causality"]) for v in variables]
    references = [v.get("valueReference", "") for v in variables]
    if len({*references}) < len(references) or not all(map(str.isdigit, references)) or roles != sorted(roles):
        order = ", ".join(ROLES)
        raise SystemExit(f"modelDescription.xml must number its variables and list them in the order {order}.")
    for v in variables:
        if v[0].tag not in TYPES or not re.fullmatch(r"[A-Za-z]\w*", v.attrib["name"]):
            raise SystemExit(f'The rows cannot have "{v.get("name")}" of type {v[0].tag} in modelDescription.xml.')


def row(variable: ElementTree.Element) -> str:
    (typed,) = variable
    name, kind, role = variable.get("name"), typed.tag.lower(), variable.get("causality")
    named = f"{name}, {variable.get('valueReference')}"
    if role in ("output", "local"):
        return f"COMPUTED({named}, {kind}, {role})\n"
    if variable.get("variability") == "tunable":
        role = "tunable"
    start = typed.attrib["start"]
    low, high = ("0", "1") if kind == "boolean" else (typed.get("min", "-unlimited"), typed.get("max", "unlimited"))
    return f"STORED({named}, {kind}, {role}, {BOOLEAN.get(start, start)}, {low}, {high})\n"


if __name__ == "__main__":
    description, output = map(Path, sys.argv[1:])
    rows = list(ElementTree.parse(description).iter("ScalarVariable"))
    check(rows)
    output.write_text("".join(map(row, rows)) + "#undef STORED\n#undef COMPUTED\n", encoding="utf-8")
