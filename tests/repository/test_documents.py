"""The documents are true: figures and tables are those of the data, commands are taken, messages are the code's.

The strict build of the site checks formulas, ./scripts/lint links and spelling.
"""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from lxml import etree
from support.checkout import copy_checkout
from support.printed import COMMANDS, PAGES, TEXTS
from support.typed import READS

from wheelfmu.commands import MODULES
from wheelfmu.fmu.driver import DERIVATIVES, STATES
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault
from wheelfmu.fmu.values import variables as described
from wheelfmu.publishing import markdown, variables
from wheelfmu.publishing.markdown import pages, with_figures

LAB = ("lesson", "notebook", "reports", "site", "studies", "vehicles")
ABSENT = [name for name in LAB if not (ROOT / "lab" / name).exists()]


def skip_deleted(deleted: bool) -> None:
    """Where a folder of the lab is not here, its commands and tests, which documents name, are not either."""
    if ABSENT and deleted:
        pytest.skip(f"of a folder of the lab that was deleted: {', '.join(ABSENT)}")


def run(*command: str, **variables: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=ROOT, env=os.environ | variables, capture_output=True, text=True, check=False)


def test_tables_of_variables_are_those_of_the_description() -> None:
    done = run(sys.executable, "-m", "wheelfmu", "variables", "--check")
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_zip_without_git_has_the_same_documents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    known = {page.relative_to(ROOT) for page in pages()}
    copy_checkout(tmp_path)
    for name in ("build/site/index.html", "results/wheel.html", ".venv/notes.md", "new.md"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    monkeypatch.setattr(markdown, "ROOT", tmp_path)
    assert {page.relative_to(tmp_path) for page in pages()} == {*known, Path("new.md")}


def test_another_variable_would_be_noticed() -> None:
    rows = [*described().values()]
    for page in variables.PAGES:
        text = page.read_text(encoding="utf-8")
        assert variables.with_tables(text, rows[1:], page) != text


def test_another_figure_in_prose_would_be_noticed() -> None:
    for page in ("README.md", "docs/physics.md", "docs/brake_hold_steer.md"):
        wrong = re.sub(r"\d(?=<!--\w+\.)", "7", TEXTS[page])
        assert wrong != with_figures(wrong) == TEXTS[page]
    for wrong in ("1<!--physics.nothing-->", "1 <!--physics.tips-->", "<!--physics.tips-->"):
        with pytest.raises(Fault, match=re.search(r"\w+\.\w+", wrong)[0]):
            with_figures(wrong)


def files(*patterns: str) -> list[str]:
    """Of the project, from its root."""
    command = ("git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", *patterns)
    return [name for name in run(*command).stdout.split("\0") if (ROOT / name).is_file()]


def words(*patterns: str) -> set[str]:
    """Of files and their names."""
    names = files(*patterns)
    found = ((ROOT / name).read_text(encoding="utf-8", errors="ignore") for name in names)
    return {word for text in (*found, *names) for word in re.findall(r"\w+", text)}


def accepted(name: str, *arguments: str) -> bool:
    """Whether the command takes the arguments."""
    reads = run(*READS, name, *arguments) if arguments else None
    return (ROOT / "scripts" / name).is_file() and not (reads and reads.returncode)


MADE_UP = re.compile(r"…|\b(?:NAME|FILE|FOLDER|PRESET|SECONDS|results|upright|driven|my_study)\b")  # by the reader


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_every_printed_command_takes_its_arguments(command: tuple[str, ...]) -> None:
    """Every ./scripts/run is run as well (tests/diagrams/test_start_values.py), so are FMPy's commands and the programs
    of the pages (test_readme.py), studies and vehicles (lab). The others are those by which this project is built and
    tested."""
    skip_deleted(command[0] not in MODULES or any(name in command for name in ABSENT))
    assert MADE_UP.search(" ".join(command)) or accepted(*command)


PYTEST = re.compile(r"\.venv/bin/python -m pytest ([^`\n]+)`")


@pytest.mark.parametrize("arguments", sorted({found for text in PAGES.values() for found in PYTEST.findall(text)}))
def test_every_printed_command_of_pytest_selects_tests(arguments: str) -> None:
    skip_deleted(any(f"lab/{name}" in arguments for name in ABSENT))
    done = run(sys.executable, "-m", "pytest", "--collect-only", "-q", *shlex.split(arguments))
    assert done.returncode == 0, done.stdout[-2000:]


def test_a_wrong_command_would_be_noticed() -> None:
    assert ("run", "s=0.01") in COMMANDS or len(COMMANDS) > 30
    assert not accepted("walk") and not accepted("lint", "--fixx") and not accepted("run", "m=-5")


SCRIPTS = sorted(MODULES)
WRONG = {"build": "faster", "example": "cars", "fuzz": "soon", "lint": "--fixx", "page": "--output"}
WRONG |= {"report": "sped", "run": "m=-5", "setup": "tests", "study": "--varies", "test": "slow", "view": "no_file.csv"}


@pytest.mark.parametrize("name", SCRIPTS)
def test_every_command_explains_itself_and_rejects_a_typing_error_before_anything_is_installed(checkout, name) -> None:
    before = {*checkout.rglob("*")}
    shown = run(str(checkout / "scripts" / name), "--help")
    assert shown.returncode == 0 and not shown.stderr and len(shown.stdout.split()) >= 10
    assert name == "help" or f"./scripts/{name}" in shown.stdout  # as it is typed
    if name in WRONG:
        done = run(str(checkout / "scripts" / name), *WRONG[name].split())
        assert done.returncode in (1, 2) and not done.stdout and done.stderr.strip()
    assert {*checkout.rglob("*")} == before


ITEM = re.compile(r"^- ((?:\(\d+\)(?:, |–)?)+) ([^\n]*)$", re.MULTILINE)  # noqa: RUF001


def test_the_list_of_equations_has_each_of_the_paper_once_with_a_function_and_a_test() -> None:
    numbers = []
    for equations, rest in ITEM.findall(TEXTS["docs/equations.md"]):
        first, *others = (int(number) for number in re.findall(r"\d+", equations))
        numbers += range(first, others[0] + 1) if "–" in equations else [first, *others]  # noqa: RUF001
        assert re.search(r"`\w+`.*, `test_\w+`$", rest), equations
    assert numbers == list(range(1, 34))


# Read as the equations of motion give them, without an equation of their own.
PLAIN = {*STATES, *DERIVATIVES, "Z_O", "Z_O_dot", "phi_ddot", "lambda_1", "lambda_2", "lambda_3", "tau"}


def outputs_in(page: str) -> set[str]:
    """In the first column of the table of outputs."""
    table = page.partition("| output |")[2].partition("\n\n")[0]
    cells = re.findall(r"^\| ([^|]*) \|", table, re.MULTILINE)
    return {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}


def test_the_equations_have_a_row_for_every_output_that_is_not_read_off_the_motion() -> None:
    outputs = {row.name for row in described().values() if row.causality == "output"}
    page = TEXTS["docs/equations.md"]
    assert outputs - PLAIN == outputs_in(page) - {"mu_required"} != outputs_in(page.replace("`X_C`, ", ""))


def test_a_test_of_physics_names_every_parameter_and_input() -> None:
    given = {row.name for row in described().values() if row.causality in ("parameter", "input")}
    named = words("tests/physics/*.py")
    assert given <= named and "J_hub" not in named


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
REASON = re.compile(rf"(?:\breturn|\bfailure_ =|\bconst char\* \w+ =)\s+({PIECE})")


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
    reasons = texts(REASON, code_of("solver"))
    _, _, tables = TEXTS["docs/messages.md"].partition("\n## ")
    rows = re.findall(r"^\| ((?:`[^`]+`(?:, )?)+) \|", tables, re.MULTILINE)
    listed = {message for row in rows for message in re.findall("`([^`]+)`", row)}
    assert len(whole(literals)) > 50 and len(reasons) > 4
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


EXTRA = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref"


def watched(page: str) -> set[str]:
    """Variables in the last column of the table of assumptions."""
    _, _, table = page.partition("| assumption |")
    rows = re.findall(r"^\|.*\| ([^|]*) \|$", table.partition("\n\n")[0], re.MULTILINE)
    return {name for cell in rows for name in re.findall(r"`(\w+)`", cell)} - {"mu_max"}


def test_the_credibility_in_the_fmu_watches_what_its_page_does_and_names_every_parameter_set() -> None:
    data = etree.parse(EXTRA / "credibility.srmd").getroot()
    (found,) = data.xpath("//*[@keyword='to-watch']/text()")
    page = PAGES["docs/credibility.md"]
    assert watched(page) == {*found.split()} != watched(page.replace("`slip_x`", ""))
    said = (ROOT / "fmu-src" / "archive" / "documentation" / "fmi-ls-ref.txt").read_text(encoding="utf-8")
    sets = tomllib.loads((ROOT / "tools" / "wheelfmu" / "release" / "parameter_sets.toml").read_text(encoding="utf-8"))
    assert re.search(r"parameter sets: (.*)", said)[1].split(", ") == sorted(sets, key=said.find) and len(sets) > 5


def signals(page: str) -> list[str]:
    """Variables in the first column of the tables of signals; `_dot` stands for the rates of those before it."""
    found = []
    for cell in re.findall(r"^\| (`[^|]+) \|", page, re.MULTILINE):
        names = re.findall(r"`(\w+)`", cell)
        found += [n for n in names if n != "_dot"] + [f"{n}_dot" for n in names[:-1] if names[-1] == "_dot"]
    return found


def test_the_terminal_of_the_hub_joins_the_signals_of_the_vehicles_page_and_no_others(fmu: str) -> None:
    page = PAGES["docs/vehicle.md"].partition("## Signals")[2].partition("### Angles")[0]
    (hub,) = etree.parse(Path(fmu) / "terminalsAndIcons" / "terminalsAndIcons.xml").getroot().iter("Terminal")
    members = [member.get("variableName") for member in hub]
    assert sorted(signals(page)) == sorted(members)
    assert sorted(signals(page.replace("| `omega_z`", "| "))) != sorted(members)  # the partner
