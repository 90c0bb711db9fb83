"""The project stands alone: no tracked file names a place outside of it, and tests import no report.

What a file does at run time is tried by .ci/run, in a clone with nothing beside it.
"""

import ast
import re
import subprocess
from pathlib import Path, PurePosixPath

import pytest
from support.paths import ROOT

UPWARDS = re.compile(r"(?<![\w./])(?:\./)?(?:[\w-]+/)*(?:\.\./)+[\w./-]*")
ABOVE_THE_ROOT = re.compile(r"\bROOT\.parent\b|CMAKE_SOURCE_DIR\}/\.\.")
PARENTS = re.compile(r"__file__\)(?:\.resolve\(\))?(?:\.parents\[(\d+)\]|((?:\.parent\b)+))")
HOMES = re.compile(r"(?<![\w./])/(?:work|home|root|Users)/[\w.-]+")
REPORTS = {"reports", "diagrams"}


def leaves(folder: PurePosixPath, path: str) -> bool:
    """Whether the relative path leads from a folder of the project out of it."""
    depth = len(folder.parts)
    for part in PurePosixPath(path).parts:
        depth += -1 if part == ".." else 0 if part == "." else 1
        if depth < 0:
            return True
    return False


def outside(name: str, text: str) -> list[str]:
    """The places outside of the project that a file names. A path may be meant from the file's folder or the root."""
    folder = PurePosixPath(name).parent
    found = [path for path in UPWARDS.findall(text) if leaves(folder, path)]
    found += ABOVE_THE_ROOT.findall(text) + HOMES.findall(text)
    for match in PARENTS.finditer(text):
        climbed = int(match[1]) + 1 if match[1] else match[2].count(".parent")
        if climbed > len(PurePosixPath(name).parts):
            found.append(match[0])
    return found


@pytest.fixture(scope="module")
def tracked() -> dict[str, str]:
    """Text of every tracked or new file by its path."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    names = [name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()]
    texts = {name: (ROOT / name).read_bytes() for name in names if "/corpus/" not in name}
    return {name: text.decode("utf-8", "replace") for name, text in texts.items() if b"\0" not in text}


def test_no_file_names_a_place_outside_of_the_project(tracked: dict[str, str]) -> None:
    here = str(Path(__file__).resolve().relative_to(ROOT))
    found = {name: outside(name, text) for name, text in tracked.items() if name != here}
    assert len(found) > 200
    assert {name: places for name, places in found.items() if places} == {}


@pytest.mark.parametrize(
    ("name", "text", "count"),
    [
        ("README.md", "see `../shared/reference`", 1),
        ("docs/x.md", "[a](../README.md), [b](../../README.md)", 1),
        ("tests/contract/x.py", 'ROOT.parent / "neighbour"', 1),
        ("tests/contract/x.py", "Path(__file__).resolve().parents[2]", 0),
        ("tests/contract/x.py", "Path(__file__).resolve().parents[3]", 1),
        ("scripts/x.py", "Path(__file__).parent.parent.parent", 1),
        ("scripts/x", "cat /home/someone/table.csv", 1),
        ("scripts/x", 'cd "$(dirname "$0")/.."', 0),
    ],
)
def test_a_place_outside_is_noticed(name: str, text: str, count: int) -> None:
    assert len(outside(name, text)) == count


def imports(text: str) -> set[str]:
    """The first part of every module that a Python file imports."""
    nodes = list(ast.walk(ast.parse(text)))
    names = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    names += [node.module for node in nodes if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module]
    return {name.split(".")[0] for name in names}


def test_no_test_imports_a_report(tracked: dict[str, str]) -> None:
    tests = {name: text for name, text in tracked.items() if name.startswith("tests/") and name.endswith(".py")}
    assert len(tests) > 60
    assert {name: imports(text) & REPORTS for name, text in tests.items() if imports(text) & REPORTS} == {}
    assert imports("from reports.page import footer\nimport numpy") & REPORTS == {"reports"}
