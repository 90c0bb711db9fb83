"""The variables of modelDescription.xml as tables, for docs/variables.md and the FMU's documentation."""

from __future__ import annotations

import html
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
BEGIN, END = "<!-- variables -->", "<!-- end of variables -->"


def read_variables() -> list[Variable]:
    return [*described().values()]


def start(v: Variable) -> str:
    return f"{float(v.start):.6g}" if v.type == "Real" and v.start else v.start


def tables(variables: list[Variable]) -> Iterator[tuple[str, list[str], list[list[str]]]]:
    """Title, head and rows of the table of each kind; only parameters and inputs have a start value."""
    tunable = ", ".join(f"`{v.name}`" for v in variables if v.variability == "tunable")
    for causality, title in TITLES.items():
        of_kind = [v for v in variables if v.causality == causality]
        started = any(v.start for v in of_kind)
        head = ["name", "unit", "start", "meaning"] if started else ["name", "unit", "meaning"]
        rows = [[f"`{v.name}`", v.unit, *([start(v)] if started else []), v.description] for v in of_kind]
        yield title.format(tunable=tunable), head, rows


def in_markdown(variables: list[Variable]) -> str:
    """Name and unit share a column."""
    return "\n\n".join(f"**{title}**\n\n{table(*with_units(head, *rows))}" for title, head, rows in tables(variables))


def with_units(*rows: list[str]) -> tuple[list[str], list[list[str]]]:
    head, *others = ([", ".join(filter(None, row[:2])), *row[2:]] for row in rows)
    return head, others


def in_html(variables: list[Variable]) -> str:
    def cell(text: str, tag: str = "td") -> str:
        return f"<{tag}>{marked(text)}</{tag}>"

    def marked(text: str) -> str:
        pieces = html.escape(text, quote=False).split("`")
        return "".join(f"<code>{piece}</code>" if k % 2 else piece for k, piece in enumerate(pieces))

    lines = []
    for title, head, rows in tables(variables):
        lines += [f"<h3>{marked(title)}</h3>", "<table>", f"<tr>{''.join(cell(c, 'th') for c in head)}</tr>"]
        lines += [f"<tr>{''.join(map(cell, row))}</tr>" for row in rows] + ["</table>"]
    return "\n".join(lines)


def with_tables(text: str, variables: list[Variable], page: Path) -> str:
    """The page's text with what stands between the two marks replaced, if it has them."""
    before, mark, rest = text.partition(BEGIN)
    if not mark:
        return text
    _, _, after = rest.partition(END)
    render = in_html if page.suffix == ".html" else in_markdown
    return f"{before}{BEGIN}\n\n{render(variables)}\n\n{END}{after}"
