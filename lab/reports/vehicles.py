"""Vehicles of examples/: the bicycle, the quarter car and the car, as tables and pictures."""

from __future__ import annotations

import runpy
import time
from contextlib import chdir
from itertools import product

import numpy as np
import pandas as pd

from lab.vehicles import judges, planar
from lab.vehicles.example import draw
from lab.vehicles.options import EXCHANGES, Manoeuvre, manoeuvres
from lab.vehicles.vehicle import STEPS, apart, drive, error
from wheelfmu.fmu.paths import ROOT, build_folder

from .page import Report, Row, Tables, part

PYTHON = ROOT / "examples" / "python"
GRID = 0.2  # s, where runs of the car are compared; every step divides it
STRAIGHT, CIRCLE, STEP, LANE, HILL = manoeuvres("car").values()
LAUNCH, BRAKE = manoeuvres("suspended").values()
IN_PLANE = STEP.changed(k_v=0.0, k_i=0.0, B_0=1500.0, t_brake=2.0, **planar.LEVEL)
HELD_STEPS = (0.005, 0.0025, 0.00125)  # s, of the quarter car
KINDS = {
    "positions held": ("held", 0.0),
    "positions that follow": ("held", 1.0),
    "first derivatives": ("derivatives", 1.0),
}
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
        speeds = [of["speed"](*between) for between in ((4, 5), (5.5, 6.5))]
    published = EIGENVALUES | SPEEDS
    measured = [weave.real, weave.imag, capsize.real, castering.real, *speeds]
    table = pd.DataFrame({"quantity": [*published], "measured": measured, "published": [*published.values()]})
    table["relative difference"] = (table["measured"] / table["published"] - 1).abs()
    return {"rides": pd.DataFrame(rides), "published": table}


@part(60)
def quarter_car(report: Report) -> dict[str, object]:
    """the quarter car: error against the step"""
    truth = drive(report.fmus, LAUNCH, HELD_STEPS[-1] / 8, "derivatives", 0.05).whole
    found = {
        name: [error(report.fmus, LAUNCH.changed(follow=follow), truth, h, exchange) for h in HELD_STEPS]
        for name, (exchange, follow) in KINDS.items()
    }
    coarse, fine = found["first derivatives"][-2:]
    table = pd.DataFrame({"step, ms": 1000 * np.array(HELD_STEPS)} | found)
    return {"quarter_car": table, "order": abs(2 - np.log2(coarse / fine))}


@part(60)
def forms(report: Report) -> pd.DataFrame:
    """both cars beside closed forms, at 1 ms; the picture of the lane change"""
    rows = []
    for run in (STEP,) if report.quick else (LAUNCH, BRAKE, STRAIGHT, CIRCLE, STEP, HILL):
        table = drive(report.fmus, run, 0.001).whole
        name = run.name if run.vehicle == "car" else "quarter car"
        rows += [(name, f.what, f.unit, f.measured, f.exact) for f in judges.judge(table, run)]
    draw(LANE, drive(report.fmus, LANE).whole, report.folder / "vehicles_lane.png")
    table = pd.DataFrame(rows, columns=["manoeuvre", "quantity", "unit", "measured", "closed form"])
    return table.assign(**{"relative difference": (table["measured"] / table["closed form"] - 1).abs()})


@part(300)
def steps(report: Report) -> list[Row]:
    """the car by master and step: the lane change against rollback at half of the least step; in the plane against one
    system of equations"""
    truth = drive(report.fmus, LANE, STEPS[-1] / 2, "rollback", GRID).whole
    plane = planar.solved(IN_PLANE, np.arange(0, IN_PLANE.stop + GRID / 2, GRID))
    rows: list[Row] = []
    for exchange, h in product(EXCHANGES, STEPS[:2] if report.quick else STEPS):
        begin = time.process_time()
        found = apart("car", drive(report.fmus, LANE, h, exchange, GRID).whole, truth)
        took = (time.process_time() - begin) / LANE.stop
        row = {"inputs over the step": exchange, "step [ms]": 1000 * h, "lane change": max(found.values())}
        row["in the plane"] = error(report.fmus, IN_PLANE, plane, h, exchange)
        rows.append(row | {"computing time over simulated time": took})
    return rows


@part(60)
def limits(report: Report) -> pd.DataFrame:
    """the largest stable step: by the rule, and where the coupled FMUs begin to diverge"""
    of = runpy.run_path(str(PYTHON / "step_limit.py"))
    step_limit, Wheel = of["step_limit"], of["Wheel"]
    rolls = LAUNCH.changed(v=10.0, v_start=10.01, M_drive=0.0, s=0.0)
    link = [(rolls["k_h"], rolls["c_h"], ("wheel", "X"), "body")]
    rule = step_limit({"wheel": Wheel()}, {"body": rolls["m_B"]}, link)
    rows = [{"coupling": "quarter car"} | bounds(report, rolls, "F_X", rule)]
    run = STRAIGHT.changed(v=10.0, v_start=10.01, M_0=0.0, B_0=0.0, s=0.0)
    wheels = {w: Wheel(guided=True, v=run["v"], follows="yaw") for w in judges.WHEELS}
    along = [(run["k_h"], run["c_h"], (w, "X"), {"X": 1.0, "yaw": -run[f"y_{w}"]}) for w in wheels]
    across = [(run["k_h"], run["c_h"], (w, "Y"), {"Y": 1.0, "yaw": run[f"x_{w}"]}) for w in wheels]
    bodies = {"X": run["m_B"], "Y": run["m_B"], "yaw": run["J_3"]}
    rule = step_limit(wheels, bodies, [*along, *across])
    return pd.DataFrame([*rows, {"coupling": "car"} | bounds(report, run, "fl.lambda_1", rule)])


def bounds(report: Report, run: Manoeuvre, signal: str, rule: float) -> Row:
    """Between which steps the coupling begins to diverge, by bisection from 30 % below the rule to 30 % above."""
    stable, diverges = 0.7 * rule, 1.3 * rule
    while diverges - stable > 0.01 * rule:
        h = (stable + diverges) / 2
        stable, diverges = (stable, h) if grows(report, run, signal, h) else (h, diverges)
    off = abs((stable + diverges) / 2 / rule - 1)
    return {"rule, ms": 1e3 * rule, "stable, ms": 1e3 * stable, "diverges, ms": 1e3 * diverges, "off the rule": off}


def grows(report: Report, run: Manoeuvre, signal: str, h: float) -> bool:
    """Whether a signal swings wider at the end of 400 steps with held values than near their start."""
    driven = drive(report.fmus, run.changed(stop=400 * h), h, "held", h)
    return bool(driven.ending) or np.ptp(driven.table[signal][-40:]) > np.ptp(driven.table[signal][10:50])


def figures(tables: Tables) -> Row:
    """Those that follow from the tables: orders, and the step of the package."""
    found: Row = {"step": 1000 * LANE.h}
    if "steps" in tables:
        every = tables["steps"].set_index(CASE)
        for exchange, order in zip(EXCHANGES, (1, 2, 4), strict=True):
            coarse, fine = (every.loc[(exchange, 1000 * h), "in the plane"] for h in STEPS[:2])
            found[f"order_{exchange}"] = abs(np.log2(coarse / fine) - order)
        found["plane"] = every["in the plane"].min()
    return found
