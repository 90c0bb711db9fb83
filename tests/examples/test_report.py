"""docs/results/vehicles.md is the page of its data, and what the data say of the car is what is claimed."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import pytest
from support.paths import ROOT
from vehicles import car_study, car_table, vehicle_report

RESULTS = ROOT / "docs" / "results"


def rows(name: str) -> list[dict[str, str]]:
    with (RESULTS / "data" / f"{name}.csv").open() as file:
        return list(csv.DictReader(file))


def test_the_page_is_that_of_its_data(tmp_path: Path) -> None:
    (tmp_path / "data").mkdir()
    for name in vehicle_report.TABLES:
        shutil.copy(RESULTS / "data" / f"{name}.csv", tmp_path / "data")
    assert vehicle_report.page(tmp_path).read_text() == (RESULTS / "vehicles.md").read_text()


def test_every_manoeuvre_is_there_with_every_master() -> None:
    found = {(row["manoeuvre"], row["inputs over the step"], float(row["step [ms]"])) for row in rows("car_errors")}
    steps = [1000 * h for h in car_study.STEPS]
    assert found == {(n, e, h) for n in car_table.NAMES for e in ("held", "derivatives", "rollback") for h in steps}


def test_four_wheels_cost_at_most_what_is_asked() -> None:
    """In the C master at 1 ms; with rollback each step is taken twice."""
    cost = {row["inputs over the step"]: float(row["four wheels [us]"]) for row in rows("car_cost")}
    assert cost["held"] <= car_study.BUDGET
    assert cost["derivatives"] <= car_study.BUDGET


@pytest.mark.parametrize("package", ["axle.ssp", "car.ssp"])
def test_omsimulator_has_the_values_of_the_master_of_the_examples(package: str) -> None:
    ends = {
        row["tool"]: [float(row[f"{axis} at the end [m]"]) for axis in "XY"]
        for row in rows("vehicle_packages")
        if row["package"] == package
    }
    assert ends["OMSimulator"] == pytest.approx(ends["master.py, held"], abs=2e-8)  # what the table's digits tell
    assert ends["OMSimulator"] != pytest.approx(ends["fmpy.ssp"], abs=1e-5)  # partner
