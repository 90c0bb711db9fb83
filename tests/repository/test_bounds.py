"""The check of bounds itself: what `within` and `beyond` refuse, and what `pytest --bounds` prints."""

import os
import subprocess
import sys
from math import nan
from pathlib import Path

import pytest
from support.bounds import beyond, within
from support.paths import ROOT

TWO_TESTS = """
from support.bounds import beyond, within
def test_near():
    within(1e-3, 5e-3, "gap, m")
    within(2e-3, 5e-3, "gap, m")
def test_far():
    beyond(8, 2, "gap, m")
"""


@pytest.mark.parametrize(
    ("check", "good", "bad"), [(within, 1.4, 1.5), (within, -2.0, nan), (beyond, 1.6, 1.5), (beyond, 2.0, nan)]
)
def test_a_value_off_its_bound_fails_by_name(check, good: float, bad: float) -> None:
    check(good, 1.5, "gap")
    with pytest.raises(AssertionError, match=r"gap is .* and must be (below|above) 1.5"):
        check(bad, 1.5, "gap")


def test_bounds_prints_the_value_nearest_to_each_bound_if_asked(tmp_path: Path) -> None:
    (tmp_path / "test_two.py").write_text(TWO_TESTS, encoding="utf-8")

    def printed(*options: str) -> list[str]:
        command = [sys.executable, "-m", "pytest", "-p", "support.bounds", "-p", "xdist", *options]
        tests = os.environ | {"PYTHONPATH": str(ROOT / "tests"), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        done = subprocess.run(command, cwd=tmp_path, env=tests, capture_output=True, text=True, check=True)
        return [line for line in done.stdout.splitlines() if "slack" in line]

    assert printed() == []
    assert printed("--bounds", "-n", "2") == [
        "test_two.py::test_far, gap, m: 8 > 2, slack 4",
        "test_two.py::test_near, gap, m: 0.002 < 0.005, slack 2.5",
    ]
