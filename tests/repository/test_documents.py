"""The documents are true: figures and tables are those of the data, what they name exists, messages are the code's.

figures.csv lists the measured figures in prose. The strict build of the site checks links and formulas, ./scripts/lint
the spelling.
"""

from __future__ import annotations

import csv
import os
import re
import subprocess
import sys
from decimal import Decimal
from math import inf
from pathlib import Path

import pytest
from lxml import etree
from support.paths import ROOT

from publishing import variables
from publishing.markdown import number, pages

RESULTS = ROOT / "docs" / "results"
TEXTS = {str(page.relative_to(ROOT)): page.read_text(encoding="utf-8") for page in pages()}


def run(*command: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=ROOT, env=os.environ | variables, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("module", "folders"),
    [(("publishing.variables",), ("tools",)), (("reports", "all"), ("tools", "examples/vehicles", "tests"))],
)
def test_tables_of_variables_and_reports_are_those_of_the_data(
    module: tuple[str, ...], folders: tuple[str, ...]
) -> None:
    done = run(sys.executable, "-m", *module, "--check", PYTHONPATH=":".join(folders))
    assert done.returncode == 0, done.stdout + done.stderr


def test_another_variable_would_be_noticed() -> None:
    rows = variables.read_variables()
    for page in variables.PAGES:
        text = page.read_text(encoding="utf-8")
        assert variables.with_tables(text, rows[1:], page) != text


FIGURES = list(csv.DictReader(Path(__file__).with_name("figures.csv").read_text(encoding="utf-8").splitlines()))


def measured(figure: str) -> float:
    """A figure of a report, REPORT.NAME, from docs/results/data."""
    report, name = figure.split(".")
    rows = csv.DictReader((RESULTS / "data" / f"{report}.csv").read_text(encoding="utf-8").splitlines())
    return next(float(row["measured"]) for row in rows if row["figure"] == name)


def rounds_to(text: str, value: float) -> bool:
    """Within half a unit of the last digit of the text; a zero at the end of an integer is no digit."""
    digits = Decimal(text).normalize()
    return abs(Decimal(value) - digits) <= Decimal("0.501") * Decimal(10) ** digits.as_tuple().exponent


@pytest.mark.parametrize("row", FIGURES, ids=lambda row: f"{row['page']}:{row['figure']}")
def test_a_measured_figure_in_a_document_is_that_of_its_report(row: dict[str, str]) -> None:
    page = (ROOT / row["page"]).read_text(encoding="utf-8").replace("−", "-")
    assert re.search(rf"(?<![\w.]){re.escape(row['text'])}(?![\w.]\d)", page)
    assert rounds_to(row["text"], measured(row["figure"]))


def test_a_figure_off_by_a_digit_would_be_noticed() -> None:
    assert rounds_to("3.1e-9", 3.06e-9) and not rounds_to("3.2e-9", 3.06e-9)
    assert rounds_to("60", 56.3) and not rounds_to("60", 54.9) and not rounds_to("60.1", 60.2)


SHORT = {4.04e-8: "4e-8", 3.46e-9: "3.5e-9", 1.25e-3: "0.00125", 0.0: "0", 123456.0: "1.2e5", 37: "37", inf: "inf"}


def test_a_number_is_short() -> None:
    assert {value: number(value) for value in SHORT} == SHORT


COMMAND = re.compile(r"\./scripts/(\w+)")
NAMED = re.compile(r"`((?:cmake|docs|examples|fmu-src|publishing|release|reports|scripts|tests|tools)/[\w./-]*)`")


def missing(text: str, beside: Path = ROOT) -> list[str]:
    """Commands and places that the text names and the project has not."""
    gone = [f"./scripts/{name}" for name in COMMAND.findall(text) if not (ROOT / "scripts" / name).is_file()]
    named = [name for name in NAMED.findall(text) if "NAME" not in name]
    return gone + [name for name in named if not (ROOT / name).exists() and not (beside / name).exists()]


def test_every_command_and_file_that_a_document_names_exists_and_every_decision_is_listed() -> None:
    found = {name: missing(text, (ROOT / name).parent) for name, text in TEXTS.items() if name.endswith(".md")}
    assert {name: gone for name, gone in found.items() if gone} == {}
    assert missing("`./scripts/run`, `tests/support/bounds.py`, `fmu-src/`") == []
    assert missing("`./scripts/walk` and `tests/support/bounds.cpp`") == ["./scripts/walk", "tests/support/bounds.cpp"]
    listed = re.findall(r"\]\((decisions/\w+\.md)\)", TEXTS["docs/README.md"])
    assert set(listed) == {f"decisions/{path.name}" for path in (ROOT / "docs" / "decisions").glob("*.md")}


OUTSIDE = r"(^|[^A-Za-z0-9_./])/(work|home|root|Users)/[A-Za-z0-9_.-]|ROOT\.parent|CMAKE_SOURCE_DIR\}/\.\."


PLACES = "${CMAKE_SOURCE_DIR}/../x ROOT.parent cat /home/someone/table.csv"


def test_no_file_names_a_place_of_some_machine_or_above_the_root() -> None:
    """What a file does at run time is tried by .ci/run, in a clone with nothing beside it."""
    found = run("git", "grep", "-IcE", "--untracked", OUTSIDE)
    assert found.stdout == f"tests/repository/{Path(__file__).name}:1\n" and len(re.findall(OUTSIDE, PLACES)) == 3


PIECE = r'"(?:[^"\\\n]|\\.)*"'
COMMENT = re.compile(
    rf"({PIECE})|//[^\n]*|/\*.*?\*/|^\s*#\s*include[^\n]*|\bstatic_assert\(.*?;", re.DOTALL | re.MULTILINE
)
LITERAL = re.compile(rf"{PIECE}(?:\s*(?:[A-Z_]+\s*)?{PIECE})*")
REASON = re.compile(rf"(?:\breturn|\bfailure_ =)\s+({PIECE})")


def bare(code: str) -> str:
    """Without comments."""
    return COMMENT.sub(lambda found: found[1] or " ", code)


def code_of(*folders: str) -> str:
    files = [path for name in folders for path in sorted((ROOT / "fmu-src" / name).glob("*.[ch]pp"))]
    return "\n".join(bare(file.read_text(encoding="utf-8")) for file in files)


def texts(pattern: re.Pattern[str], code: str) -> set[str]:
    """Literals, joined from their pieces, with … for what is filled in when the FMU runs."""
    joined = (re.sub(r'"\s*[A-Z_]+\s*"', "…", re.sub(r'"\s*"', "", found))[1:-1] for found in pattern.findall(code))
    filled = (re.sub(r"%(?:s|d|u|zu|lld)(?:%s)?", "…", text.replace('\\"', '"')) for text in joined)
    return {text.replace("……", "…") for text in filled}


def whole(literals: set[str]) -> set[str]:
    """Messages: those that end with a full stop."""
    return {text for text in literals if " " in text and text.endswith(".")}


def test_the_page_lists_every_message_of_the_code_and_every_reason_of_the_solver_and_no_other() -> None:
    literals = texts(LITERAL, code_of("fmi", "wheel", "solver", "orbit", "support"))
    reasons, listed = texts(REASON, code_of("solver")), {*re.findall(r"^- `([^`]+)`", TEXTS["docs/messages.md"], re.M)}
    assert len(whole(literals)) > 50 and len(reasons) > 5
    assert whole(literals) ^ whole(listed) == set()
    assert listed - literals == reasons - listed == set()
    code = 'i.log(e, "%s: the %d-th wheel "\n  "is %s.", a); // "a comment is no message."\nlog("x");'
    assert whole(texts(LITERAL, bare(code))) == {"…: the …-th wheel is …."}


def test_the_fmus_page_is_well_formed_and_complete_offline(fmu: str) -> None:
    folder, strict = Path(fmu) / "documentation", etree.HTMLParser(recover=False)
    page = etree.parse(folder / "index.html", strict)
    references = page.xpath("//@src | //@href")
    assert len(references) == 9
    for reference in references:
        known = reference[1:] in page.xpath("//@id") if reference.startswith("#") else (folder / reference).is_file()
        assert known, reference
    with pytest.raises(etree.XMLSyntaxError):
        etree.fromstring(b"<p><b>crossed</p></b>", strict)
