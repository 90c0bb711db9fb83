"""The masters and checkers on docs/interoperability.md: their errors are small, and each run says what happened.

The runs themselves are made by hand, with programs that are not part of this project.
"""

import csv
import sys

from support.paths import ROOT

sys.path.insert(0, str(ROOT))
from publishing.documents import DATA

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


def test_every_master_agrees_with_the_trusted_tables_within_the_tolerance() -> None:
    runs = read_runs()
    assert sum(bool(run["friction"]) for run in runs) >= 15
    assert too_large(runs) == []
    assert too_large([run | {"tolerance passed": "1e-8"} for run in runs]) == ["Maestro", "Maestro"]


def test_every_run_says_what_happened_at_the_early_end() -> None:
    runs = [run for run in read_runs() if run["friction"]]
    assert {run["early end"].split(",")[0] for run in runs} == {"told", "silent"}, RUNS
    assert all(run["version"] and run["rollback"] or "Checker" in run["tool"] for run in runs)


def far_off(runs: list[dict[str, str]]) -> list[str]:
    """Of the solvers that control their error: those with more than ten thousand tolerances of error, or another number
    of transitions than the reference. Euler's step is too coarse for all transitions."""
    controlled = [run for run in runs if run["friction"] and run["tolerance"].startswith("1e-")]
    return [
        run["solver"]
        for run in controlled
        if max(float(run["default scene"]), float(run["friction"])) > 1e4 * float(run["tolerance"])
        or run["transitions"] != "37"
    ]


def test_every_solver_with_a_tolerance_finds_the_37_transitions_in_model_exchange() -> None:
    with (DATA / "interoperability_exchange.csv").open(newline="", encoding="utf-8") as file:
        runs = list(csv.DictReader(file))
    assert len({run["tool"] for run in runs}) >= 5
    assert far_off([]) == far_off(runs) == []
    assert len(far_off([run | {"transitions": "36"} for run in runs])) >= 8
    assert len(far_off([run | {"friction": "1e-3"} if run["friction"] else run for run in runs])) >= 8
