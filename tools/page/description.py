"""The variables of modelDescription.xml, and what the live page needs besides: the WebAssembly module, ready wheels."""

from __future__ import annotations

import base64
from pathlib import Path
from xml.etree import ElementTree

from diagrams.start_values import ROOT, wheels
from diagrams.start_values import variables as described

READ = {"Real": float, "Integer": int, "Enumeration": int, "Boolean": lambda text: text == "true"}


def variables() -> dict[str, dict]:
    """Value reference, type, unit, causality, meaning and start value of every variable by name."""
    found = {}
    for name, v in described().items():
        found[name] = {"reference": v.reference, "type": v.type, "unit": v.unit}
        found[name] |= {"causality": v.causality, "meaning": v.description}
        found[name] |= {"start": READ[v.type](v.start)} if v.start else {}
    return found


def parameters() -> list[str]:
    return [*described("parameter")]


def live(wasm: Path) -> dict:
    """The `live` part of a page's data."""
    guid = ElementTree.parse(ROOT / "modelDescription.xml").getroot().attrib["guid"]
    module = base64.b64encode(wasm.read_bytes()).decode("ascii")
    return {"wasm": module, "guid": guid, "wheels": wheels()}
