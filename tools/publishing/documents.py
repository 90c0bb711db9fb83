"""Writes into the marked places of the documents what is measured or stands elsewhere: no figure is typed by hand.

A place in Markdown or HTML is `<!-- = report.figure -->4e-8<!-- . -->`: the comment names a row of
docs/results/data/report.csv, which `scripts/report` measures, and what stands up to the next comment is written here.
After `<!-- variables -->` stand all variables.
No line begins with a place: Markdown takes a comment at the beginning of a line for a block of HTML, which ends the
paragraph. With --check nothing is changed; the exit status is 1 where a page differs from the data or breaks the rule.
"""

from __future__ import annotations

import csv
import re
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from publishing import variables
from publishing.markdown import ROOT, number

DATA = ROOT / "docs" / "results" / "data"
PLACE = re.compile(r"(<!-- = ([\w.]+) -->)(.*?)(<!-- \. -->)", re.DOTALL)
# The end of a line, from the last word that may begin one, and the place that begins the next line.
WORD = r"(?:<!-- = [\w.]+ -->[^\n]*?<!-- \. -->|\S)+"
BEGINNING = re.compile(rf" ((?![-+*=#>|<]){WORD}(?: [-+*=#>|]\S*)*)\n([ \t]*)(?=<!-- = )")


class UnknownFigure(SystemExit):
    """The message is one line for the writer of the page."""


def read_figures(folder: Path = DATA) -> dict[str, str]:
    """Text of each figure by `report.figure`."""
    figures = {}
    for path in sorted(folder.glob("*.csv")):
        rows = csv.DictReader(path.read_text(encoding="utf-8").splitlines(keepends=True))
        figured = (row for row in rows if {"figure", "measured"} <= {*row})
        figures |= {f"{path.stem}.{row['figure']}": number(float(row["measured"])) for row in figured}
    return figures


def with_figures(text: str, figures: Mapping[str, str], name: str = "the page") -> str:
    """The page's text with every marked place filled."""

    def fill(place: re.Match[str]) -> str:
        if place[2] not in figures:
            raise UnknownFigure(f"documents: {name} asks for {place[2]}, which no report has measured.")
        return f"{place[1]}{figures[place[2]]}{place[4]}"

    return PLACE.sub(fill, text)


def reflowed(text: str) -> str:
    """The page's text with each place that began a line behind the last word of the line before."""
    while (fresh := BEGINNING.sub(r"\n\2\1 ", text)) != text:
        text = fresh
    return text


def pages() -> list[Path]:
    """Every page that is kept under version control."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md", "*.html"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / name for name in sorted(listed.stdout.split("\0")) if name and (ROOT / name).is_file()]


def main() -> int:
    check = sys.argv[1:] == ["--check"]
    figures, known, stale = read_figures(), variables.read_variables(), 0
    for page in pages():
        text = page.read_text(encoding="utf-8")
        fresh = variables.with_tables(with_figures(text, figures, page.name), known, page)
        fresh = reflowed(fresh) if page.suffix == ".md" else fresh
        if text != fresh:
            stale += 1
            print(f"{'Stale' if check else 'Filled'}: {page.relative_to(ROOT)}")
            if not check:
                page.write_text(fresh, encoding="utf-8")
    return int(check and stale > 0)


if __name__ == "__main__":
    sys.exit(main())
