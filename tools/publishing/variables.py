"""The variables of modelDescription.xml as tables, for docs/variables.md and the FMU's documentation."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator
from pathlib import Path

from diagrams.start_values import Variable
from diagrams.start_values import variables as described
from publishing.markdown import ROOT, table

PAGES = (ROOT / "docs" / "variables.md", ROOT / "fmu-src" / "archive" / "documentation" / "index.html")
TITLES = {
    "parameter": "Parameters, set before the run ({tunable} also between steps)",
    "input": "Inputs",
    "output": "Outputs",
    "local": "For inspection",
}
PLACE = re.compile("(<!-- variables -->).*(<!-- end of variables -->)", re.DOTALL)


def read_variables() -> list[Variable]:
    return [*described().values()]


def start(v: Variable) -> str:
    return f"{float(v.start):.6g}" if v.type == "Real" and v.start else v.start


def tables(variables: list[Variable]) -> Iterator[tuple[str, *tuple[list[str], ...]]]:
    """Title, head and rows of the table of each kind; only parameters and inputs have a start value."""
    tunable = ", ".join(f"`{v.name}`" for v in variables if v.variability == "tunable")
    for causality, title in TITLES.items():
        of_kind = [v for v in variables if v.causality == causality]
        started = any(v.start for v in of_kind)
        head = ["name", "unit", "start", "meaning"] if started else ["name", "unit", "meaning"]
        rows = [[f"`{v.name}`", v.unit, *([start(v)] if started else []), v.description] for v in of_kind]
        yield title.format(tunable=tunable), head, *rows


def in_markdown(variables: list[Variable]) -> str:
    """Name and unit share a column."""
    found = []
    for title, *rows in tables(variables):
        head, *others = ([", ".join(filter(None, row[:2])), *row[2:]] for row in rows)
        found.append(f"**{title}**\n\n{table(head, others)}")
    return "\n\n".join(found)


def in_html(variables: list[Variable]) -> str:
    def marked(text: str) -> str:
        return re.sub("`([^`]*)`", r"<code>\1</code>", html.escape(text, quote=False))

    def line(row: list[str], tag: str = "td") -> str:
        return f"<tr>{''.join(f'<{tag}>{marked(cell)}</{tag}>' for cell in row)}</tr>"

    found = []
    for title, head, *rows in tables(variables):
        found += [f"<h3>{marked(title)}</h3>", "<table>", line(head, "th"), *map(line, rows), "</table>"]
    return "\n".join(found)


def with_tables(text: str, variables: list[Variable], page: Path) -> str:
    """The page's text with what stands between the two marks replaced, if it has them."""
    render = in_html if page.suffix == ".html" else in_markdown
    return PLACE.sub(lambda place: f"{place[1]}\n\n{render(variables)}\n\n{place[2]}", text)
