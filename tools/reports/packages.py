"""The packages of axle and car in other tools, beside the master of the examples, for `vehicles`."""

from __future__ import annotations

import shutil
import subprocess
import sys
from importlib.metadata import version

import pandas as pd
from support.paths import ROOT
from vehicles import axle_study, build, ssp
from vehicles.axle import AXLE
from vehicles.car import CAR
from vehicles.layout import LANE

from .page import Report, Row, part, read_tables

GRID = 0.05  # s


@part(120)
def packages(report: Report) -> list[Row]:
    """the packages in other tools, beside the master of the examples"""
    units, h = report.fmus, 0.0005
    folder, scene, wait = units["chassis"].parent, axle_study.TRAILING.changed(stop=2.0), {"t_couple": 3 * h}
    waiting, later = LANE.changed(**wait), scene.changed(**wait)
    axles = [AXLE.drive(units, s, h, e, GRID).whole for s, e in ((scene, "rollback"), (later, "held"))]
    cars = [CAR.drive(units, m, h, e, GRID).table for m, e in ((LANE, "rollback"), (waiting, "held"))]
    cases = (
        (AXLE.package(units, scene, h, folder), scene.stop, ("axle.X", "axle.Y"), axles),
        (CAR.package(units, LANE, h, folder), LANE.stop, ("chassis.X_R", "chassis.Y_R"), cars),
    )
    rows: list[Row] = []
    for package, stop, wanted, own in cases:
        names = [name.split(".")[1] for name in wanted]
        ends = [(f"master.py, {e}", "", run, names) for e, run in zip(("rollback", "held"), own, strict=True)]
        ends.append(("fmpy.ssp", f"FMPy {version('fmpy')}", ssp.run(package, h, stop, GRID), wanted))
        found = [(tool, number, [run[name][-1] for name in names]) for tool, number, run, names in ends]
        for tool, number, command in tools_at_hand(report.options["tools"]):
            said = subprocess.run([*command, package, repr(h), repr(stop), *wanted], capture_output=True, check=True)
            values = dict(line.split() for line in said.stdout.decode().splitlines() if line.startswith(wanted))
            found.append((tool, number, [float(values[name]) for name in wanted]))
        new = [
            {"package": package.name, "tool": tool, "version": number}
            | {f"{axis} at the end, m": f"{x:.8f}" for axis, x in zip("XY", values, strict=True)}
            for tool, number, values in found
        ]
        rows += new + of_other_tools(new)
    return rows


def of_other_tools(new: list[Row]) -> list[Row]:
    """Published rows of tools that are not at hand now, if all that is at hand has the values that it had then."""
    old = read_tables("vehicles", dtype=str).get("packages", pd.DataFrame({"package": []})).fillna("")
    old = {row["tool"]: row for row in old[old["package"] == new[0]["package"]].to_dict("records")}
    same = all(old.get(row["tool"]) == row for row in new)
    return [row for tool, row in old.items() if same and tool not in [row["tool"] for row in new]]


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
