"""Writes the variables of modelDescription.xml as tables into docs/variables.md and the FMU's documentation."""

from __future__ import annotations

import html
import re
from pathlib import Path

from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Variable
from wheelfmu.fmu.values import variables as described
from wheelfmu.publishing.markdown import page

PAGES = (ROOT / "docs" / "variables.md", ROOT / "fmu-src" / "archive" / "documentation" / "index.html")
TITLES = {
    "parameter": "Parameters, set before the run ({tunable} also between steps)",
    "input": "Inputs",
    "output": "Outputs",
    "local": "For inspection",
}
PLACE = re.compile("(<!-- variables -->).*(<!-- end of variables -->)", re.DOTALL)


def start(v: Variable) -> str:
    return f"{float(v.start):.6g}" if v.type == "Real" and v.start else v.start


def marked(text: str) -> str:
    """Prose with `names` as HTML."""
    return re.sub("`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False))


def tables(variables: list[Variable], suffix: str) -> str:
    """A table of each kind; only parameters and inputs have a start value."""
    tunable = ", ".join(f"`{v.name}`" for v in variables if v.variability == "tunable")
    kinds = {title.format(tunable=tunable): [v for v in variables if v.causality == of] for of, title in TITLES.items()}
    return page(f"variables{suffix}.j2", kinds=kinds, start=start, marked=marked).strip()


def with_tables(text: str, variables: list[Variable], place: Path) -> str:
    """The text of the page at a place, with what stands between the two marks replaced, if it has them."""
    return PLACE.sub(lambda found: f"{found[1]}\n\n{tables(variables, place.suffix)}\n\n{found[2]}", text)


def fill(check: bool = False) -> bool:
    """Whether a page differs from the description; it is filled, unless it is to be checked alone."""
    known = [*described().values()]
    texts = {place: place.read_text(encoding="utf-8") for place in PAGES}
    filled = {place: with_tables(text, known, place) for place, text in texts.items()}
    # All of them are filled before the first is written.
    stale = [place for place in PAGES if texts[place] != filled[place]]
    for place in stale:
        print(f"{'Stale' if check else 'Filled'}: {place.relative_to(ROOT)}")
        if not check:
            place.write_text(filled[place], encoding="utf-8")
    return bool(stale)
