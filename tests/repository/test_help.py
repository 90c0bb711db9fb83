"""Every command under scripts/ answers --help and a typing error at once, in a checkout where nothing is installed."""

import re
import subprocess
from itertools import dropwhile
from pathlib import Path

import pytest
from support.paths import ROOT

# Commands of folders that can be deleted whole.
PARTS = {"page": "tools/page", "view": "tools/page", "study": "examples/studies", "example": "examples/vehicles"}
COMMANDS = sorted(p.name for p in (ROOT / "scripts").iterdir() if (ROOT / PARTS.get(p.name, ".")).exists())
WRONG = {"build": "faster", "example": "m_B=-1", "fuzz": "soon", "lint": "--fixx", "page": "--output", "report": "sped"}
WRONG |= {"run": "m=-5", "setup": "tests", "study": "--varies", "test": "slow", "view": "there_is_no_such_file.csv"}


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A checkout without anything that is built or installed."""
    place = tmp_path_factory.mktemp("checkout")
    copy = f"git ls-files -coz --exclude-standard | xargs -0 cp --parents -t '{place}'"
    subprocess.run(["bash", "-c", copy], cwd=ROOT, check=False)  # a file may be deleted
    return place


def call(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """The command's answer; it must leave no file behind."""
    before = {*folder.rglob("*")}
    done = subprocess.run([folder / "scripts" / words[0], *words[1:]], cwd=folder, capture_output=True, text=True)
    assert {*folder.rglob("*")} == before
    return done


@pytest.mark.parametrize("name", COMMANDS)
def test_help_explains_a_command_and_does_nothing(bare: Path, name: str) -> None:
    done = call(bare, name, "--help")
    assert done.returncode == 0 and not done.stderr and len(done.stdout.split()) >= 10


SYNTAX = re.compile(r"\$[({\"@*\w]|=\$|^\s*(?:fi|done|esac|exit|exec)\b|2>&1")


def shell_in(help_text: str, script: str) -> list[str]:
    """Lines of a help text that are, or end, a line below the script's first comment, or that look like shell."""
    _, *lines = script.splitlines()
    body = [line for line in dropwhile(lambda line: line.startswith("#"), lines) if line.strip()]
    said = [line for line in help_text.splitlines() if len(line.strip()) > 3]
    return [line for line in said if SYNTAX.search(line) or any(one.endswith(line.strip()) for one in body)]


@pytest.mark.parametrize("name", COMMANDS)
def test_no_line_of_a_scripts_body_is_in_its_help(bare: Path, name: str) -> None:
    script = (ROOT / "scripts" / name).read_text()
    assert shell_in(call(bare, name, "--help").stdout, script) == []
    cut = [line[2:] for line in script.splitlines()[1:]]  # the partner: the whole file, two letters short
    assert len(shell_in("\n".join(cut), script)) > 1


@pytest.mark.parametrize("name", [name for name in WRONG if name in COMMANDS])
def test_a_typing_error_is_rejected_before_anything_is_installed(bare: Path, name: str) -> None:
    done = call(bare, name, *["car"] * (name == "example"), WRONG[name])
    assert done.returncode in (1, 2) and not done.stdout and done.stderr.strip()


def test_help_lists_every_command(bare: Path) -> None:
    listed = call(bare, "help").stdout.splitlines()
    assert [line.split()[0] for line in listed] == COMMANDS
    assert all(len(line.split()) > 3 and line.endswith(".") for line in listed)
