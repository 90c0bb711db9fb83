"""The packages of axle and car in other tools, beside the master of the examples, for `vehicles`."""

from __future__ import annotations

import shutil
import subprocess
import sys
from importlib.metadata import version

import pandas as pd
from support.paths import ROOT
from vehicles import axle, build, ssp
from vehicles.axle import AXLE
from vehicles.car import CAR
from vehicles.layout import LANE

from .page import Report, Row, part, read_tables

STEP, GRID = 0.0005, 0.05  # s
CASES = {
    "axle.ssp": (AXLE, axle.TRAILING.changed(stop=2.0), ("axle.X", "axle.Y")),
    "car.ssp": (CAR, LANE, ("chassis.X_R", "chassis.Y_R")),
}


@part(120, {"package": CASES})
def packages(report: Report, case: tuple) -> list[Row]:
    """the packages in other tools, beside the master of the examples"""
    (vehicle, scene, wanted), units, found = case, report.fmus, []
    package = vehicle.package(units, scene, STEP, units["chassis"].parent)
    for exchange, over in {"rollback": scene, "held": scene.changed(t_couple=3 * STEP)}.items():
        run = vehicle.drive(units, over, STEP, exchange, GRID).whole
        found.append((f"master.py, {exchange}", "", [run[name.split(".")[1]][-1] for name in wanted]))
    run = ssp.run(package, STEP, scene.stop, GRID)
    found.append(("fmpy.ssp", f"FMPy {version('fmpy')}", [run[name][-1] for name in wanted]))
    for tool, number, command in tools_at_hand(report.options["tools"]):
        arguments = [package, repr(STEP), repr(scene.stop), *wanted]
        said = subprocess.run([*command, *arguments], capture_output=True, check=True)
        values = dict(line.split() for line in said.stdout.decode().splitlines() if line.startswith(wanted))
        found.append((tool, number, [float(values[name]) for name in wanted]))
    head = ("tool", "version", "X at the end, m", "Y at the end, m")
    rows = [dict(zip(head, (tool, number, *(f"{x:.8f}" for x in ends)), strict=True)) for tool, number, ends in found]
    return rows + of_other_tools(package.name, rows)


def of_other_tools(package: str, new: list[Row]) -> list[Row]:
    """Published rows of tools that are not at hand now, if all that is at hand has the values that it had then."""
    old = read_tables("vehicles", dtype=str).get("packages", pd.DataFrame({"package": []})).fillna("")
    old = old[old["package"] == package].drop(columns="package").to_dict("records")
    same = all(row in old for row in new)
    return [row for row in old if same and row["tool"] not in [found["tool"] for found in new]]


def tools_at_hand(python: str | None) -> list[tuple[str, str, list[str]]]:
    """Name, version and command: the interpreter `python` has two of them, OMSimulator may be on the PATH."""
    script, found = str(build.EXAMPLES / "run_package.py"), []
    for tool, package in (("libcosim", "libcosimpy"), ("ecos", "ecospy")) if python else ():
        ask = f"import importlib.metadata as m; print(m.version({package!r}))"
        number = subprocess.run([python, "-c", ask], capture_output=True, text=True, check=True).stdout.strip()
        found.append((tool, f"{package} {number}", [python, script, tool]))
    if shutil.which("OMSimulator"):
        tried = pd.read_csv(ROOT / "docs" / "results" / "data" / "interoperability_remarks.csv", dtype=str)
        number = tried.loc[tried["tool"] == "OMSimulator", "version"].iloc[0]
        found.append(("OMSimulator", number, [sys.executable, script, "OMSimulator"]))
    return found
