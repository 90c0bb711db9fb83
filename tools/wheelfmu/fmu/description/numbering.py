"""Numbers an FMI 2.0 description: what follows from the order of its variables and from dependencies by name.

No paper equation. A value reference stays with its variable; a new variable gets the next one, from 0. An index is the
variable's place, from 1. Whoever adds a variable leaves `valueReference` out, writes names where FMI wants indices
(derivative="X_O", dependencies="m r_0"), and leaves ModelStructure alone. The wheel's modelDescription.xml and those of
the examples are numbered here.
"""

from __future__ import annotations

import re
import uuid
from collections.abc import Callable, Collection, Mapping
from itertools import count
from xml.etree import ElementTree

# Of each section of ModelStructure and each unknown in it: the names that it depends on. An unknown that is not listed
# may depend on all, as in FMI.
Dependencies = Mapping[str, Mapping[str, Collection[str]]]
# What a master relies on: a library and a description that differ here do not belong together.
BINDING = ("ModelExchange", "CoSimulation", "UnitDefinitions", "ModelVariables", "ModelStructure")
TAG = re.compile(r'<ScalarVariable name="([^"]*)"(?: valueReference="(\d+)")?')
UNKNOWN = re.compile(r'<Unknown index="(\d+)"[^>]*/><!-- (\w+) -->')


def names_by_index(text: str) -> Callable[[str], list[str]]:
    """Reads indices of the numbering before variables were added, moved or removed, or names, as names; what is gone is
    left out. Indices are those of the variables with a reference; unknowns stand beside theirs."""
    tags: list[tuple[str, str]] = TAG.findall(text)
    by_reference: dict[str, str] = {}
    for name, reference in tags:
        if reference and (other := by_reference.setdefault(reference, name)) != name:
            raise SystemExit(f"{other} and {name} have one valueReference: leave it out of the new one.")
    old = {name: name for name, _ in tags}
    if len(old) < len(tags):
        raise SystemExit("modelDescription.xml has two variables of one name.")
    old |= {str(index): name for index, name in enumerate(by_reference.values(), 1)}
    for index, name in UNKNOWN.findall(text):
        if name in old:
            old[index] = name
        else:
            old.pop(index, None)

    def names(tokens: str) -> list[str]:
        for token in tokens.split():
            if not token.isdigit() and token not in old:
                raise SystemExit(f"modelDescription.xml refers to {token}, which is none of its variables.")
        return [old[token] for token in tokens.split() if token in old]

    return names


def dependencies_of(root: ElementTree.Element, names: Callable[[str], list[str]]) -> Dependencies:
    """The dependencies that the description declares, by name."""
    return {
        section.tag: {
            name: names(row.attrib["dependencies"])
            for row in section.iterfind("*[@dependencies]")
            for name in names(row.attrib["index"])
        }
        for section in root.iterfind("ModelStructure/*")
    }


def unknowns_of(root: ElementTree.Element, names: Callable[[str], list[str]]) -> dict[str, list[str]]:
    """The unknowns of each section of ModelStructure; derivatives in their order there, new ones last."""
    variables = {v.attrib["name"]: v for v in root.iter("ScalarVariable")}
    state_of = {name: state for name, v in variables.items() for state in names(v[0].get("derivative", ""))}
    known = [n for row in root.iterfind("ModelStructure/Derivatives/Unknown") for n in names(row.attrib["index"])]
    derivatives = [name for name in dict.fromkeys([*known, *state_of]) if name in state_of]
    outputs = [name for name, v in variables.items() if v.get("causality") == "output"]
    follow = {*outputs, *state_of, *state_of.values()}  # at the start, where they are calculated

    initial = [
        name
        for name, v in variables.items()
        if v.get("causality") == "calculatedParameter"
        or (v.get("initial") in ("approx", "calculated") and name in follow)
    ]
    return {"Outputs": outputs, "Derivatives": derivatives, "InitialUnknowns": initial}


def structure(sections: dict[str, list[str]], index: dict[str, int], depends: Dependencies) -> str:
    lines = ["<ModelStructure>"]
    for section, rows in sections.items():
        lines += [f"    <{section}>"] if rows else []
        for name in rows:
            known = depends.get(section, {}).get(name)
            numbers = "" if known is None else f' dependencies="{" ".join(map(str, sorted(index[k] for k in known)))}"'
            lines.append(f'      <Unknown index="{index[name]}"{numbers}/><!-- {name} -->')
        lines += [f"    </{section}>"] if rows else []
    return "\n".join([*lines, "  </ModelStructure>"])


def numbered(text: str, depends: Dependencies | None = None) -> str:
    """The description with all its numbers and its GUID; dependencies as given, else those that it declares."""
    root = ElementTree.fromstring(text.encode())
    names = names_by_index(text)
    index = {v.attrib["name"]: place for place, v in enumerate(root.iter("ScalarVariable"), 1)}
    new = count(max((int(reference) + 1 for _, reference in TAG.findall(text) if reference), default=0))
    text = TAG.sub(lambda tag: f'<ScalarVariable name="{tag[1]}" valueReference="{tag[2] or next(new)}"', text)
    text = re.sub(r' derivative="([^"]*)"', lambda found: f' derivative="{index[names(found[1])[0]]}"', text)
    known = dependencies_of(root, names) if depends is None else depends
    sections = structure(unknowns_of(root, names), index, known)
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
