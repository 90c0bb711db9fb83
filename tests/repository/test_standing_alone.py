"""The project stands alone: no tracked file names a place of some machine or above the root.

What a file does at run time is tried by .ci/run, in a clone with nothing beside it; links are checked where the site is
built, and imports of reports in tests by the linter.
"""

import re
import subprocess

import pytest
from support.paths import ROOT

OUTSIDE = re.compile(r"(?<![\w./])/(?:work|home|root|Users)/[\w.-]+|\bROOT\.parent\b|CMAKE_SOURCE_DIR\}/\.\.")


def test_no_file_names_a_place_outside_of_the_project() -> None:
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True)
    texts = {name: ROOT / name for name in listed.stdout.splitlines() if not name.startswith("tests/repository/")}
    found = {
        name: OUTSIDE.findall(path.read_bytes().decode("utf-8", "ignore"))
        for name, path in texts.items()
        if path.is_file()
    }
    assert len(found) > 200
    assert {name: places for name, places in found.items() if places} == {}


@pytest.mark.parametrize(
    "text", ["file(READ ${CMAKE_SOURCE_DIR}/../x)", 'ROOT.parent / "neighbour"', "cat /home/someone/table.csv"]
)
def test_a_place_outside_is_noticed(text: str) -> None:
    assert OUTSIDE.search(text) and not OUTSIDE.search("Path(__file__).resolve().parents[2]")
