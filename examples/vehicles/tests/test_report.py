"""What the data of the report on axle and car say is what is claimed."""

from typing import Any

import pytest
from support.bounds import absolute_error, beyond, within
from vehicles.errors import STEPS
from vehicles.master import EXCHANGES
from vehicles.monolithic_car import NAMES

from reports.page import read_tables


def rows(name: str) -> list[dict[str, Any]]:
    return read_tables("vehicles")[name].to_dict("records")


def test_every_manoeuvre_is_there_with_every_master() -> None:
    found = {(row["manoeuvre"], row["inputs over the step"], float(row["step [ms]"])) for row in rows("car_errors")}
    steps = [1000 * h for h in STEPS]
    assert found == {(n, e, h) for n in NAMES for e in EXCHANGES for h in steps}


@pytest.mark.parametrize("package", ["axle.ssp", "car.ssp"])
def test_omsimulator_has_the_values_of_the_master_of_the_examples(package: str) -> None:
    ends = {
        row["tool"]: [float(row[f"{axis} at the end, m"]) for axis in "XY"]
        for row in rows("packages")
        if row["package"] == package
    }
    within(absolute_error(ends["OMSimulator"], ends["master.py, held"]), 2e-8, "at the end, m")  # the table's digits
    beyond(absolute_error(ends["OMSimulator"], ends["fmpy.ssp"]), 1e-3, "fmpy.ssp, which begins later, m")
