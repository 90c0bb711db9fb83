"""What the live page needs of the wheel: the WebAssembly module and its variables, out of modelDescription.xml."""

from __future__ import annotations

import xml.etree.ElementTree as xml
from pathlib import Path

from page.document import base64_of

READ = {"Real": float, "Integer": int, "Enumeration": int, "Boolean": lambda text: text == "true"}


def variables(description: Path) -> tuple[str, dict[str, dict]]:
    """GUID, and value reference, type and start value of every variable by name."""
    root = xml.parse(description).getroot()
    found = {}
    for variable in root.iterfind("ModelVariables/ScalarVariable"):
        kind = next(child for child in variable if child.tag in READ)
        entry = {"reference": int(variable.attrib["valueReference"]), "type": kind.tag, "unit": kind.get("unit", "")}
        if "start" in kind.attrib:
            entry["start"] = READ[kind.tag](kind.attrib["start"])
        found[variable.attrib["name"]] = entry
    return root.attrib["guid"], found


def source(wasm: Path, description: Path) -> dict:
    """The `live` part of a page's data."""
    guid, found = variables(description)
    return {"wasm": base64_of(wasm.read_bytes()), "description": {"guid": guid, "variables": found}}
