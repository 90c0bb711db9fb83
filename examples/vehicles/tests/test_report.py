"""What the data of the report on axle and car say is what is claimed."""

from __future__ import annotations

import csv

import pytest
from support.bounds import absolute_error, beyond, within
from support.paths import ROOT
from vehicles.errors import STEPS
from vehicles.master import EXCHANGES
from vehicles.monolithic_car import NAMES

RESULTS = ROOT / "docs" / "results"


def rows(name: str) -> list[dict[str, str]]:
    with (RESULTS / "data" / f"{name}.csv").open() as file:
        return list(csv.DictReader(file))


def test_every_manoeuvre_is_there_with_every_master() -> None:
    found = {
        (row["manoeuvre"], row["inputs over the step"], float(row["step [ms]"])) for row in rows("vehicles_car_errors")
    }
    steps = [1000 * h for h in STEPS]
    assert found == {(n, e, h) for n in NAMES for e in EXCHANGES for h in steps}


@pytest.mark.parametrize("package", ["axle.ssp", "car.ssp"])
def test_omsimulator_has_the_values_of_the_master_of_the_examples(package: str) -> None:
    ends = {
        row["tool"]: [float(row[f"{axis} at the end, m"]) for axis in "XY"]
        for row in rows("vehicles_packages")
        if row["package"] == package
    }
    within(absolute_error(ends["OMSimulator"], ends["master.py, held"]), 2e-8, "at the end, m")  # the table's digits
    beyond(absolute_error(ends["OMSimulator"], ends["fmpy.ssp"]), 1e-3, "fmpy.ssp, which begins later, m")
