"""The table of masters and checkers on docs/interoperability.md is that of its data, and its errors are small.

The runs themselves are made by hand, with programs that are not part of this project.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

from support.paths import ROOT

sys.path.insert(0, str(ROOT))
from publishing.documents import DATA, with_figures

RUNS = DATA / "interoperability.csv"


def read_runs() -> list[dict[str, str]]:
    """One row per tool; the errors are relative, empty where the tool does not simulate."""
    with RUNS.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


# By the tolerance that the master gives the wheel.
ALLOWED = {"0.1": 1e-4}


def too_large(runs: list[dict[str, str]]) -> list[str]:
    """Tools whose error exceeds the tolerance of the wheel in their run."""
    scenes = ("default scene", "friction")
    errors = [(run["tool"], run["tolerance passed"], run[scene]) for run in runs for scene in scenes]
    return [tool for tool, tolerance, error in errors if error and not 0 < float(error) < ALLOWED.get(tolerance, 1e-8)]


def test_the_table_of_the_page_is_that_of_the_data_and_would_show_another_figure(tmp_path: Path) -> None:
    page, data = (ROOT / "docs" / "interoperability.md").read_text(encoding="utf-8"), RUNS.read_text(encoding="utf-8")
    assert with_figures(page, {}) == page, "run ./scripts/documents: the page is not that of the data"
    (tmp_path / RUNS.name).write_text(data.replace("4.13e-5", "7e-3", 1), encoding="utf-8")
    assert with_figures(page, {}, folder=tmp_path) != page


def test_every_master_agrees_with_the_trusted_tables_within_the_tolerance() -> None:
    runs = read_runs()
    assert sum(bool(run["friction"]) for run in runs) >= 15
    assert too_large(runs) == []
    assert too_large([run | {"tolerance passed": "1e-8"} for run in runs]) == ["Maestro", "Maestro"]


def test_every_run_says_what_happened_at_the_early_end() -> None:
    runs = [run for run in read_runs() if run["friction"]]
    assert {run["early end"].split(",")[0] for run in runs} == {"told", "silent"}, RUNS
    assert all(run["version"] and run["rollback"] or "Checker" in run["tool"] for run in runs)
