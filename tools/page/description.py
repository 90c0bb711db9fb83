"""The variables of modelDescription.xml, and what the live page needs besides: the WebAssembly module, ready wheels."""

from __future__ import annotations

import base64
import json
import xml.etree.ElementTree as xml
from functools import cache
from pathlib import Path

READ = {"Real": float, "Integer": int, "Enumeration": int, "Boolean": lambda text: text == "true"}
ROOT = next(folder for folder in Path(__file__).resolve().parents if (folder / "modelDescription.xml").exists())


@cache
def root() -> xml.Element:
    return xml.parse(ROOT / "modelDescription.xml").getroot()


@cache
def variables() -> dict[str, dict]:
    """Value reference, type, unit, causality, meaning and start value of every variable by name."""
    found = {}
    for variable in root().iterfind("ModelVariables/ScalarVariable"):
        kind = next(child for child in variable if child.tag in READ)
        entry = {"reference": int(variable.attrib["valueReference"]), "type": kind.tag, "unit": kind.get("unit", "")}
        entry |= {"causality": variable.get("causality", "local"), "meaning": variable.get("description", "")}
        if "start" in kind.attrib:
            entry["start"] = READ[kind.tag](kind.attrib["start"])
        found[variable.attrib["name"]] = entry
    return found


def parameters() -> list[str]:
    return [name for name, variable in variables().items() if variable["causality"] == "parameter"]


def live(wasm: Path) -> dict:
    """The `live` part of a page's data."""
    ready = ROOT / "examples" / "wheels.json"
    wheels = json.loads(ready.read_text(encoding="utf-8")) if ready.exists() else {}
    module = base64.b64encode(wasm.read_bytes()).decode("ascii")
    return {"wasm": module, "guid": root().attrib["guid"], "wheels": wheels}
