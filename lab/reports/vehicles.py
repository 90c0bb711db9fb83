"""Vehicles of examples/: the bicycle and the car, as tables and pictures."""

from __future__ import annotations

import runpy
import time
from contextlib import chdir
from itertools import product

import numpy as np
import pandas as pd

from lab.vehicles import judges, planar
from lab.vehicles.car import drive, error
from lab.vehicles.example import draw
from lab.vehicles.manoeuvres import MANOEUVRES, WHEELS, system
from lab.vehicles.master import ORDERS
from wheelfmu.diagrams import style
from wheelfmu.fmu.paths import ROOT, build_folder

from .page import Report, Row, Tables, part

PYTHON = ROOT / "examples" / "python"
GRID = 0.2  # s, where runs of the car are compared; every step divides it
STEPS = (0.01, 0.005, 0.0025)  # s, of which errors show orders
LANE, STEP = MANOEUVRES["lane"], MANOEUVRES["step"]
IN_PLANE = STEP.changed(k_v=0.0, k_i=0.0, B_0=1500.0, t_brake=2.0, **planar.LEVEL)
CASE = ["inputs over the step", "step [ms]"]
EIGENVALUES = {  # 1/s, at 5 m/s, and speeds, m/s: Meijaard et al. 2007
    "eigenvalue of the weave, real": -0.77534188219585,
    "eigenvalue of the weave, imaginary": 4.46486771378823,
    "eigenvalue of the capsize": -0.32286642900409,
    "eigenvalue of the castering": -14.07838969279822,
}
SPEEDS = {"weave speed": 4.29238253634111, "capsize speed": 6.02426201538837}


@part(90)
def bicycle(report: Report) -> dict[str, object]:
    """the bicycle against the published linear equations: rides, eigenvalues, weave and capsize speed"""
    with chdir(build_folder()):
        of = runpy.run_path(str(PYTHON / "bicycle.py"))
        of["draw"](str(report.folder / "vehicles_bicycle.png"))
        rides = []
        for v, stop in of["RIDES"].items():
            t = np.linspace(0, stop, 301)
            found, exact = (ride(v, of["SMALL"], t)[:2] for ride in (of["ride"], of["linear"]))
            lean, steer = np.abs(found - exact).max(1) / np.abs(exact).max(1)
            rides.append({"speed, m/s": v, "lean": lean, "steer": steer})
        castering, _, weave, capsize = of["eigenvalues"](5.0)
        speeds = of["limits"]()
    published = EIGENVALUES | SPEEDS
    measured = [weave.real, weave.imag, capsize.real, castering.real, *speeds]
    table = pd.DataFrame({"quantity": [*published], "measured": measured, "published": [*published.values()]})
    table["relative difference"] = (table["measured"] / table["published"] - 1).abs()
    return {"rides": pd.DataFrame(rides), "published": table}


@part(60)
def forms(report: Report) -> pd.DataFrame:
    """the car beside closed forms, at 1 ms; the picture of the lane change"""
    rows = []
    for name in ("step",) if report.quick else judges.JUDGES:
        run = MANOEUVRES[name]
        rows += [(name, *finding) for finding in judges.judge(name, drive(report.fmus, run, 0.001), run)]
    style.save_png(draw(LANE.title, drive(report.fmus, LANE)), report.folder / "vehicles_lane.png")
    table = pd.DataFrame(rows, columns=["manoeuvre", "quantity", "unit", "measured", "closed form"])
    return table.assign(**{"relative difference": (table["measured"] / table["closed form"] - 1).abs()})


@part(300)
def steps(report: Report) -> list[Row]:
    """the car by master and step: the lane change against rollback at half of the least step; in the plane against one
    system of equations"""
    truth = drive(report.fmus, LANE, STEPS[-1] / 2, "rollback", GRID)
    plane = planar.solved(IN_PLANE, np.arange(0, IN_PLANE.stop + GRID / 2, GRID))
    rows: list[Row] = []
    for exchange, h in product(ORDERS, STEPS[:2] if report.quick else STEPS):
        begin = time.process_time()
        lane = error(drive(report.fmus, LANE, h, exchange, GRID), truth)
        took = (time.process_time() - begin) / LANE.stop
        row = {"inputs over the step": exchange, "step [ms]": 1000 * h, "lane change": lane}
        row["in the plane"] = error(drive(report.fmus, IN_PLANE, h, exchange, GRID), plane)
        rows.append(row | {"computing time over simulated time": took})
    return rows


def limit() -> float:
    """The largest step at which the straight car is stable with held values, by the rule, s."""
    of = runpy.run_path(str(PYTHON / "step_limit.py"))
    wheels = {w: of["Wheel"](guided=True, v=LANE["v_start"], follows="yaw") for w in WHEELS}
    k, c = LANE["k_h"], LANE["c_h"]
    along = [(k, c, (w, "X"), {"X": 1.0, "yaw": -LANE[f"y_{w}"]}) for w in wheels]
    across = [(k, c, (w, "Y"), {"Y": 1.0, "yaw": LANE[f"x_{w}"]}) for w in wheels]
    bodies = {"X": LANE["m_B"], "Y": LANE["m_B"], "yaw": LANE["J_3"]}
    return of["step_limit"](wheels, bodies, [*along, *across])


def figures(tables: Tables) -> Row:
    """Those that follow from the tables: orders; the step of the package, and its limit."""
    found: Row = {"step": 1000 * system()["step"], "limit_car": 1000 * limit()}
    if "steps" in tables:
        every = tables["steps"].set_index(CASE)
        for exchange, order in zip(ORDERS, (1, 2, 4), strict=True):
            coarse, fine = (every.loc[(exchange, 1000 * h), "in the plane"] for h in STEPS[:2])
            found[f"order_{exchange}"] = abs(np.log2(coarse / fine) - order)
        found["plane"] = every["in the plane"].min()
    return found
