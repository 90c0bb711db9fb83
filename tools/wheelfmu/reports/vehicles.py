"""Vehicles of examples/vehicles: a balanced and a suspended wheel, and a car, as tables and pictures."""

from __future__ import annotations

from itertools import product

import numpy as np
import pandas as pd

from wheelfmu.vehicles import balance, car_judges, suspended
from wheelfmu.vehicles.car import CAR
from wheelfmu.vehicles.car_judges import MANOEUVRES
from wheelfmu.vehicles.drawing import draw
from wheelfmu.vehicles.options import EXCHANGES, manoeuvres
from wheelfmu.vehicles.vehicle import STEPS, orders

from .page import Report, Row, Tables, part

GRID = 0.25  # s, where runs of the car are compared
COMPARED = tuple(name for name in MANOEUVRES if name not in (car_judges.TOO_FAST.name, car_judges.SPLIT.name))
WAYS = {"locked": "locked wheel", "ideal": "ideal brake", "abs": "anti-lock; closed form: the shortest"}
KINDS = {"positions held": "values held", "held": "positions that follow", "derivatives": "first derivatives"}


@part(20)
def balanced(report: Report) -> dict[str, float]:
    """the balanced wheel"""
    drive = balance.drive(report.fmus)
    draw(balance.BALANCE, balance.CIRCLE, drive, report.folder / "vehicles_balance.png")
    found = balance.judge(drive)
    radius = abs(found["circle_radius"] - balance.RADIUS)
    of_line = {"tilt": found["line_tilt"], "circle": radius}
    return of_line | {"scatter": found["circle_scatter"], "spin": found["speed_error"]}


@part(60)
def suspended_wheel(report: Report) -> dict[str, object]:
    """the suspended wheel: error against the step; its acceleration beside the closed form"""
    steps = suspended.STEPS[:3] if report.quick else suspended.STEPS
    truth = suspended.fine(report.fmus, steps[-1] / 4)
    found = suspended.convergence(report.fmus, truth, steps)
    table = pd.DataFrame(found).reset_index(drop=True).rename(columns=KINDS)
    table.insert(0, "step, ms", 1000 * np.array(steps))
    table["share lost to the lag of a held position"] = [suspended.drag_share(h) for h in steps]
    launch = suspended.SUSPENDED.drive(report.fmus, suspended.LAUNCH, 0.000625, grid=0.005).whole
    draw(suspended.SUSPENDED, suspended.LAUNCH, launch, report.folder / "vehicles_suspended.png")
    late = truth["time"] > 2.5  # s
    slope = np.polyfit(truth["time"][late], truth["X_B_dot"][late], 1)[0]
    figures = {"order": 2 - min(orders(found["derivatives"]))}
    return {"suspended": table, "launch": abs(slope / suspended.acceleration(150.0) - 1)} | figures


@part(60)
def sliding(report: Report) -> pd.DataFrame:
    """wheels that slide: three stops of the suspended wheel; a car on a road that is slippery on the right"""
    run, split = manoeuvres("suspended")["abs"], car_judges.SPLIT
    table = suspended.SUSPENDED.drive(report.fmus, run, run.h, run.exchange, run.grid).whole
    forms = {"locked": suspended.sliding_way, "ideal": suspended.gripping_way, "abs": suspended.shortest}
    rows: list[tuple[str, str, float, float | None]] = []
    for name, form in forms.items():
        rows.append((f"stopping distance, {WAYS[name]}", "m", suspended.way(table, run, name), form(table, run)))
    found = car_judges.judge(CAR.drive(report.fmus, split).whole, split)
    rows += [(f"car: {f.what}", f.unit, f.measured, f.exact) for f in found]
    judged = pd.DataFrame(rows, columns=["quantity", "unit", "measured", "closed form"])
    return judged.assign(**{"relative difference": (judged["measured"] / judged["closed form"] - 1).abs()})


@part(120)
def car_runs(report: Report) -> dict[str, object]:
    """the car: closed forms and characteristic values, two pictures"""
    judged = []
    for name in ("step",) if report.quick else COMPARED:
        manoeuvre = MANOEUVRES[name]
        table = CAR.drive(report.fmus, manoeuvre).table
        draw(CAR, manoeuvre, table, report.folder / f"vehicles_{name}.png") if name in ("lane", "hill") else None
        found = car_judges.judge(table, manoeuvre)
        judged += [(name, f.what, f.unit, f.measured, f.exact) for f in found]
    forms = ["manoeuvre", "quantity", "unit", "measured", "closed form"]
    return {"car_values": pd.DataFrame(judged, columns=forms)}


@part(600, {"manoeuvre": lambda report: ("step",) if report.quick else COMPARED})
def car_errors(report: Report, name: str) -> list[Row]:
    """the car, ten seconds at most: error against rollback at half of the least step, by master, step and output"""
    run = MANOEUVRES[name].changed(stop=min(MANOEUVRES[name].stop, 10.0))
    truth = CAR.drive(report.fmus, run, STEPS[-1] / 2, "rollback", GRID).whole
    rows: list[Row] = []
    for exchange, h in product(EXCHANGES, STEPS):
        found = CAR.apart(CAR.drive(report.fmus, run, h, exchange, GRID).whole, truth)
        head = {"inputs over the step": exchange, "step [ms]": 1000 * h}
        rows.append(head | found | {"largest": max(found.values())})
    return rows


def largest(tables: Tables) -> pd.DataFrame:
    """The car's largest error by manoeuvre, over the exchange and the step."""
    found = tables["car_errors"]
    by = found.pivot(index="manoeuvre", columns=["inputs over the step", "step [ms]"], values="largest")
    return by.loc[found["manoeuvre"].unique()]


@part(1)
def rollback(report: Report) -> dict[str, float]:
    """the car: the largest error where no wheel stops"""
    moving = largest(report.tables).drop(["straight", "hill"], errors="ignore")
    return {"rollback": moving["rollback", 1000 * STEPS[0]].max()}
