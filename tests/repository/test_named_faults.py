"""The named faults of tests/mutants/named.toml can all be put in, and the tests that are meant to notice them exist."""

import tomllib

import pytest
from support.paths import ROOT

FAULTS = tomllib.loads((ROOT / "tests" / "mutants" / "named.toml").read_text(encoding="utf-8"))["mutant"]


@pytest.mark.parametrize("fault", FAULTS, ids=[fault["name"] for fault in FAULTS])
def test_a_named_fault_finds_its_line_once_and_its_tests(fault: dict) -> None:
    text = (ROOT / "fmu-src" / fault["file"]).read_text(encoding="utf-8")
    assert text.count(fault["old"]) == 1 and fault["new"] != fault["old"]
    for name in fault["tests"]:
        assert (ROOT / "tests" / name.split("::")[0]).exists(), name
