"""Numbers an FMI 2.0 description: what follows from the order of its variables and from dependencies by name.

No paper equation. A value reference is the variable's place, from 0; an index is that place, from 1. Whoever adds a
variable leaves `valueReference` out, writes names where FMI wants indices (derivative="X_O", dependencies="m r_0"), and
leaves ModelStructure alone. The wheel's modelDescription.xml and those of the examples are numbered here.
"""

from __future__ import annotations

import re
import uuid
from collections.abc import Callable, Iterable
from xml.etree import ElementTree

# Of each section of ModelStructure and each unknown in it: the names that it depends on. An unknown that is not listed
# may depend on all, as in FMI.
Dependencies = dict[str, dict[str, Iterable[str]]]
# What a master relies on: a library and a description that differ here do not belong together.
BINDING = ("ModelExchange", "CoSimulation", "UnitDefinitions", "ModelVariables", "ModelStructure")
TAG = re.compile(r'<ScalarVariable name="([^"]*)"(?: valueReference="\d+")?')


def variables_of(root: ElementTree.Element) -> list[ElementTree.Element]:
    return list(root.iter("ScalarVariable"))


def names_by_index(root: ElementTree.Element) -> Callable[[str], list[str]]:
    """Reads indices of the present numbering, or names, as names; what is gone is left out."""
    variables = variables_of(root)
    present = {v.get("name") for v in variables}
    old: dict[str, str] = {}
    for v in variables:
        index = str(int(v.get("valueReference", -1)) + 1)
        if index in old:
            raise SystemExit(f"{old[index]} and {v.get('name')} have one valueReference: leave it out of the new one.")
        if index != "0":
            old[index] = v.get("name")

    def names(tokens: str) -> list[str]:
        for token in tokens.split():
            if not token.isdigit() and token not in present:
                raise SystemExit(f"modelDescription.xml refers to {token}, which is none of its variables.")
        return [old.get(token, token) for token in tokens.split() if token in old or token in present]

    return names


def dependencies_of(root: ElementTree.Element) -> Dependencies:
    """The dependencies that the description declares, by name."""
    names = names_by_index(root)
    return {
        section.tag: {
            name: names(row.get("dependencies"))
            for row in section
            for name in names(row.get("index"))
            if row.get("dependencies") is not None
        }
        for section in root.iterfind("ModelStructure/*")
    }


def unknowns_of(root: ElementTree.Element) -> dict[str, list[str]]:
    """The unknowns of each section of ModelStructure, and the continuous states in the order of their derivatives: that
    of the section Derivatives, new ones last."""
    variables = variables_of(root)
    names = names_by_index(root)
    state_of = {v.get("name"): state for v in variables for state in names(v[0].get("derivative", ""))}
    known = [n for row in root.findall("ModelStructure/Derivatives/Unknown") for n in names(row.get("index"))]
    state_of = {name: state_of[name] for name in dict.fromkeys([*known, *state_of]) if name in state_of}
    calculated = {v.get("name") for v in variables if v.get("initial") in ("approx", "calculated")}
    outputs = [v.get("name") for v in variables if v.get("causality") == "output"]
    parameters = [v.get("name") for v in variables if v.get("causality") == "calculatedParameter"]
    at_start = calculated.intersection([*outputs, *state_of, *state_of.values()]).union(parameters)
    return {
        "Outputs": outputs,
        "Derivatives": list(state_of),
        "InitialUnknowns": [v.get("name") for v in variables if v.get("name") in at_start],
        "States": list(state_of.values()),
    }


def structure(sections: dict[str, list[str]], index: dict[str, int], depends: Dependencies) -> str:
    lines = ["<ModelStructure>"]
    for section in ("Outputs", "Derivatives", "InitialUnknowns"):
        rows = sections[section]
        if not rows:
            continue
        lines.append(f"    <{section}>")
        for name in rows:
            known = depends.get(section, {}).get(name)
            numbers = "" if known is None else f' dependencies="{" ".join(map(str, sorted(index[k] for k in known)))}"'
            lines.append(f'      <Unknown index="{index[name]}"{numbers}/><!-- {name} -->')
        lines.append(f"    </{section}>")
    return "\n".join([*lines, "  </ModelStructure>"])


def numbered(text: str, depends: Dependencies | None = None) -> str:
    """The description with all its numbers and its GUID; dependencies as given, else those that it declares."""
    root = ElementTree.fromstring(text.encode())
    variables = variables_of(root)
    index = {v.get("name"): place for place, v in enumerate(variables, 1)}
    if len(index) != len(variables):
        raise SystemExit("modelDescription.xml has two variables of one name.")
    names = names_by_index(root)
    text = TAG.sub(lambda tag: f'<ScalarVariable name="{tag[1]}" valueReference="{index[tag[1]] - 1}"', text)
    text = re.sub(r' derivative="([^"]*)"', lambda found: f' derivative="{index[names(found[1])[0]]}"', text)
    sections = structure(unknowns_of(root), index, dependencies_of(root) if depends is None else depends)
    text = re.sub(r"<ModelStructure>.*</ModelStructure>|<ModelStructure/>", sections, text, count=1, flags=re.DOTALL)
    return re.sub(r' guid="[^"]*"', f' guid="{guid_of(text)}"', text, count=1)


def with_event_indicators(text: str, count: int) -> str:
    return re.sub(r'numberOfEventIndicators="\d+"', f'numberOfEventIndicators="{count}"', text, count=1)


def guid_of(description: str) -> str:
    """The GUID as a digest of all that binds library and description; comments, layout and prose do not count."""
    root = ElementTree.fromstring(description.encode())
    bound = [element for element in map(root.find, BINDING) if element is not None]
    parts = [ElementTree.tostring(element, encoding="unicode") for element in bound]
    text = "".join(ElementTree.canonicalize(part, strip_text=True, exclude_attrs=["description"]) for part in parts)
    return "{" + str(uuid.uuid5(uuid.NAMESPACE_OID, root.get("numberOfEventIndicators", "") + text)) + "}"
