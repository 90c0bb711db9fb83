"""Figures in prose are those of the data: marked places are filled from docs/results/data, none is typed by hand."""

import os
import re
import subprocess
import sys
from math import inf
from pathlib import Path

import pytest
from support.paths import ROOT

from publishing.documents import PLACE, UnknownFigure, pages, read_figures, reflowed, with_figures
from publishing.markdown import number

RESULTS = ROOT / "docs" / "results"
BY_HAND = ROOT / "docs" / "interoperability.md"  # runs of other programs, which no command of this project starts
PROSE = [page for page in pages() if RESULTS not in page.parents and page != BY_HAND]
CODE = re.compile(
    r"```.*?```|(?m:^ {4}[^\n]*$)|`[^`]*`|<pre>.*?</pre>|<code>.*?</code>|<math.*?</math>|<!--.*?-->|]\([^)]*\)",
    re.DOTALL,
)
# What looks measured: a mantissa with a negative exponent (a power of ten is a tolerance), or a time or size.
TYPED = re.compile(r"(?<![\w.])(?!1e)\d+(?:\.\d+)?e-\d+\b|\b\d[\d.,]* ?(?:ns|µs|us|KiB|MiB)\b")
# Figures that no report measures: the rounding of a constant, a limit that the code sets.
GIVEN = {"docs/physics.md": {"6e-17"}, "docs/decisions/others.md": {"128 KiB"}}


def typed(text: str) -> list[str]:
    """What looks like a measured figure outside of marked places, code and links."""
    return TYPED.findall(CODE.sub(" ", PLACE.sub(" ", text)))


@pytest.mark.parametrize("page", pages(), ids=lambda page: str(page.relative_to(ROOT)))
def test_the_figures_of_a_page_are_those_of_the_data(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    stale = "run ./scripts/documents: the figures are not those of docs/results/data"
    assert with_figures(text, read_figures(), page.name) == text, stale


def test_the_pages_of_the_reports_are_those_of_the_data() -> None:
    command = [sys.executable, "-m", "reports", "all", "--check"]
    environment = os.environ | {"PYTHONPATH": ":".join(["tools", "examples/vehicles", "tests"])}
    found = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr


def test_the_readme_takes_its_figures_from_the_data_and_would_notice_another_one() -> None:
    text, figures = (ROOT / "README.md").read_text(encoding="utf-8"), read_figures()
    names = [place[1] for place in PLACE.findall(text)]
    assert len(names) >= 5
    changed = figures | {names[0]: "other"}
    assert with_figures(text, changed) != text == with_figures(text, figures)


@pytest.mark.parametrize("page", PROSE, ids=lambda page: str(page.relative_to(ROOT)))
def test_no_measured_figure_is_typed_by_hand(page: Path) -> None:
    given = GIVEN.get(str(page.relative_to(ROOT)), set())
    assert [figure for figure in typed(page.read_text(encoding="utf-8")) if figure not in given] == []


# Markdown takes a comment that opens a line or an item for a block of HTML.
BROKEN = re.compile(r"^[ \t]*(?:(?:[-*+>]|\d+\.) +)*<!-- =", re.MULTILINE)


def test_no_line_begins_with_a_marked_figure_which_would_break_its_paragraph() -> None:
    texts = {page.name: page.read_text(encoding="utf-8") for page in PROSE if page.suffix == ".md"}
    assert [name for name, text in texts.items() if BROKEN.search(text)] == []
    broken = "The run takes\n<!-- = commands.disk_run -->0.8<!-- . --> GB.\n"
    assert BROKEN.search(broken) and BROKEN.search("- <!-- = commands.disk_run -->0.8<!-- . --> GB")
    assert reflowed(broken) == "The run\ntakes <!-- = commands.disk_run -->0.8<!-- . --> GB.\n"


COUNTS = {"right to 4e-8 of the range": 1, "it takes 0.5 µs a step": 1, "1,420 KiB and 94 ns": 2}
COUNTS |= {"a tolerance of 1e-8": 0, "run `x = 4e-8`": 0}
COUNTS |= {"right to <!-- = accuracy.error_free -->4e-8<!-- . --> of the range": 0}


@pytest.mark.parametrize(("text", "count"), COUNTS.items())
def test_a_typed_figure_is_found(text: str, count: int) -> None:
    assert len(typed(text)) == count


def test_an_unknown_figure_is_refused_and_a_known_one_is_filled(tmp_path: Path) -> None:
    (tmp_path / "report.csv").write_text("figure,measured\nerror,4.04e-08\n")
    (tmp_path / "report_rows.csv").write_text("t,x\n0,1\n")
    figures = read_figures(tmp_path)
    assert figures == {"report.error": "4e-8"}
    page = "an error of <!-- = report.error -->?<!-- . -->."
    assert with_figures(page, figures) == "an error of <!-- = report.error -->4e-8<!-- . -->."
    with pytest.raises(UnknownFigure, match="asks for report.time"):
        with_figures("<!-- = report.time --><!-- . -->", figures)


SHORT = {4.04e-8: "4e-8", 3.46e-9: "3.5e-9", 1.25e-3: "0.00125", 0.0: "0", 123456.0: "1.2e5", 37: "37", inf: "inf"}


@pytest.mark.parametrize(("value", "text"), SHORT.items())
def test_a_number_is_short(value: float, text: str) -> None:
    assert number(value) == text
