"""Vehicles of examples/vehicles: a balanced and a suspended wheel, and a car, as tables and pictures."""

from __future__ import annotations

import runpy
import time
from itertools import product

import numpy as np
import pandas as pd

from lab.vehicles import balance, car_judges, planar, suspended
from lab.vehicles.car import CAR
from lab.vehicles.car_judges import CURVE, LANE, MANOEUVRES, SPLIT, STEP, STRAIGHT, TOO_FAST, WHEELS
from lab.vehicles.drawing import draw
from lab.vehicles.options import EXCHANGES, Manoeuvre
from lab.vehicles.suspended import SUSPENDED
from lab.vehicles.vehicle import STEPS, Table, Vehicle, orders
from wheelfmu.diagrams import style
from wheelfmu.fmu.paths import ROOT

from . import plots
from .page import Report, Row, Tables, part

GRID = 0.2  # s, where runs of the car are compared; every step divides it
COMPARED = tuple(name for name in MANOEUVRES if name not in (TOO_FAST.name, SPLIT.name))
HALTS = ("straight", "hill", "curve")  # in which wheels stop inside a step
IN_PLANE = {"step": STEP.changed(**planar.LEVEL), "curve": CURVE.changed(stop=7.0, **planar.LEVEL)}  # until it stands
COURSE = ("X", "Y", "psi", "v", "omega")
CASE = ["inputs over the step", "step [ms]"]
STOPS = (  # closed form, and the words for the brake
    (suspended.LOCKED, suspended.sliding_way, "locked wheel"),
    (suspended.IDEAL, suspended.gripping_way, "ideal brake"),
    (suspended.ABS, suspended.shortest, "anti-lock; closed form: the shortest"),
)
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
    launch = SUSPENDED.drive(report.fmus, suspended.LAUNCH, 0.000625, grid=0.005).whole
    draw(SUSPENDED, suspended.LAUNCH, launch, report.folder / "vehicles_suspended.png")
    late = truth["time"] > 2.5  # s
    slope = np.polyfit(truth["time"][late], truth["X_B_dot"][late], 1)[0]
    figures = {"order": 2 - min(orders(found["derivatives"]))}
    return {"suspended": table, "launch": abs(slope / suspended.acceleration(150.0) - 1)} | figures


@part(60)
def sliding(report: Report) -> pd.DataFrame:
    """wheels that slide: three stops of the suspended wheel; a car on a road that is slippery on the right"""
    rows: list[tuple[str, str, float, float | None]] = []
    tables = {run.name: SUSPENDED.drive(report.fmus, run).whole for run, *_ in STOPS}
    for run, form, name in STOPS:
        way = suspended.way(tables[run.name], run)
        rows.append((f"stopping distance, {name}", "m", way, form(tables[run.name], run)))
    brakes(report, tables)
    found = car_judges.judge(CAR.drive(report.fmus, SPLIT, 0.001).whole, SPLIT)
    rows += [(f"car: {f.what}", f.unit, f.measured, f.exact) for f in found]
    judged = pd.DataFrame(rows, columns=["quantity", "unit", "measured", "closed form"])
    return judged.assign(**{"relative difference": (judged["measured"] / judged["closed form"] - 1).abs()})


def brakes(report: Report, tables: dict[str, Table]) -> None:
    """The three stops in one picture."""
    sheet, (speed, capacity) = plots.sheet("ab")
    for (run, _, words), colour in zip(STOPS, plots.COLOURS, strict=False):
        table, how = tables[run.name], {"label": words.partition(";")[0], "color": colour}
        speed.plot(table["time"], 3.6 * table["X_B_dot"], **how)
        capacity.plot(table["time"], table["M_brake"], **how)
    plots.label(speed, "time [s]", "speed of the sprung mass [km/h]")
    plots.label(capacity, "time [s]", "capacity of the brake [N m]")
    plots.legend_below(sheet, [speed])
    style.save_png(sheet, report.folder / "vehicles_brakes.png", plots.DPI)


@part(120)
def car_runs(report: Report) -> dict[str, object]:
    """the car: closed forms and characteristic values, two pictures"""
    judged = []
    for name in ("step",) if report.quick else COMPARED:
        manoeuvre = MANOEUVRES[name]
        table = CAR.drive(report.fmus, manoeuvre).table
        draw(CAR, manoeuvre, table, report.folder / f"vehicles_{name}.png") if name in ("lane", "curve") else None
        found = car_judges.judge(table, manoeuvre)
        judged += [(name, f.what, f.unit, f.measured, f.exact) for f in found]
    forms = ["manoeuvre", "quantity", "unit", "measured", "closed form"]
    return {"car_values": pd.DataFrame(judged, columns=forms)}


def ten_seconds(name: str) -> Manoeuvre:
    return MANOEUVRES[name].changed(stop=min(MANOEUVRES[name].stop, 10.0))


@part(300, {"manoeuvre": lambda report: ("step",) if report.quick else COMPARED})
def car_errors(report: Report, name: str) -> list[Row]:
    """the car, ten seconds at most: error against rollback at half of the least step, by master, step and output"""
    run = ten_seconds(name)
    truth = CAR.drive(report.fmus, run, STEPS[-1] / 2, "rollback", GRID).whole
    rows: list[Row] = []
    for exchange, h in [*product(EXCHANGES, STEPS), (run.exchange, run.h)]:
        begin = time.process_time()
        found = CAR.apart(CAR.drive(report.fmus, run, h, exchange, GRID).whole, truth)
        took = (time.process_time() - begin) / run.stop
        head = {"inputs over the step": exchange, "step [ms]": 1000 * h}
        course = max(found[n] for n in COURSE[:4])
        rows.append(head | found | {"largest": max(found.values()), "course": course, "computing time": took})
    return rows


@part(60, {"manoeuvre": lambda report: ("step",) if report.quick else tuple(IN_PLANE)})
def in_plane(report: Report, name: str) -> list[Row]:
    """the car in the plane: error against one system of equations, integrated by SciPy"""
    run = IN_PLANE[name]
    truth = planar.solved(run, np.arange(0, run.stop + GRID / 2, GRID))
    found = {(x, h): CAR.drive(report.fmus, run, h, x, GRID).whole for x, h in product(EXCHANGES, STEPS)}
    far = {case: max(CAR.apart(table, truth)[n] for n in COURSE) for case, table in found.items()}
    return [{"inputs over the step": x, "step [ms]": 1000 * h, "largest": error} for (x, h), error in far.items()]


@part(60)
def limits(report: Report) -> pd.DataFrame:
    """the largest stable step: by the rule, and where the coupled FMUs begin to diverge"""
    of = runpy.run_path(str(ROOT / "examples" / "python" / "step_limit.py"))
    step_limit, Wheel = of["step_limit"], of["Wheel"]
    rows: list[Row] = []
    rolls = suspended.LAUNCH.changed(v=10.0, v_start=10.01, M_drive=0.0, s=0.0)
    skids = suspended.LOCKED.changed(v=80.0, t_brake=0.0, s=0.0)
    for name, run, wheel in (("rolls", rolls, Wheel()), ("slides", skids, Wheel(slides=True))):
        rule = step_limit({"wheel": wheel}, {"body": run["m_B"]}, [(run["k"], run["c"], ("wheel", "X"), "body")])
        rows.append({"coupling": f"suspended wheel, which {name}"} | bounds(report, SUSPENDED, run, "F_X", rule))
    run = STRAIGHT.changed(v=10.0, v_start=10.01, M_0=0.0, B_0=0.0, s=0.0)
    wheels = {w: Wheel(guided=True, v=run["v"], follows="yaw") for w in WHEELS}
    along = [(run["k_h"], run["c_h"], (w, "X"), {"X": 1.0, "yaw": -run[f"y_{w}"]}) for w in WHEELS]
    across = [(run["k_h"], run["c_h"], (w, "Y"), {"Y": 1.0, "yaw": run[f"x_{w}"]}) for w in WHEELS]
    bodies = {"X": run["m_B"], "Y": run["m_B"], "yaw": run["J_3"]}
    rule = step_limit(wheels, bodies, [*along, *across])
    return pd.DataFrame([*rows, {"coupling": "car, whose wheels roll"} | bounds(report, CAR, run, "fl.lambda_1", rule)])


def bounds(report: Report, of: Vehicle, run: Manoeuvre, signal: str, rule: float) -> Row:
    """Between which steps the coupling begins to diverge, by bisection from 30 % below the rule to 30 % above."""
    stable, diverges = 0.7 * rule, 1.3 * rule
    while diverges - stable > 0.01 * rule:
        h = (stable + diverges) / 2
        stable, diverges = (stable, h) if grows(report, of, run, signal, h) else (h, diverges)
    off = abs((stable + diverges) / 2 / rule - 1)
    return {"rule, ms": 1e3 * rule, "stable, ms": 1e3 * stable, "diverges, ms": 1e3 * diverges, "off the rule": off}


def grows(report: Report, of: Vehicle, run: Manoeuvre, signal: str, h: float) -> bool:
    """Whether a signal swings wider at the end of 400 steps with held values than near their start."""
    driven = of.drive(report.fmus, run.changed(stop=400 * h), h, "held", h)
    return bool(driven.ending) or np.ptp(driven.table[signal][-40:]) > np.ptp(driven.table[signal][10:50])


def figures(tables: Tables) -> dict[str, float]:
    """Of the car: orders, and the step that a command takes."""
    every, plane = tables["car_errors"], largest(tables["in_plane"])
    order = {x: np.log2(plane[x, 1000 * STEPS[0]] / plane[x, 1000 * STEPS[1]]) for x in EXCHANGES}
    off = {f"order_{x}": abs(order[x] - p) for x, p in zip(EXCHANGES, (1, 2, 4), strict=True)}
    taken = every[np.isclose(every["step [ms]"], 1000 * LANE.h)]
    return off | {
        "plane": plane["rollback", 1000 * STEPS[-1]],
        "rollback": moving(every)["rollback", 1000 * STEPS[-1]],
        "step": 1000 * LANE.h,
        "step_course": taken["course"].max(),
    }


def largest(errors: pd.DataFrame) -> pd.Series:
    """The largest error, by exchange and step."""
    return errors.groupby(CASE)["largest"].max()


def moving(errors: pd.DataFrame) -> pd.Series:
    """That of a car whose wheels never stop."""
    return largest(errors[~errors["manoeuvre"].isin(HALTS)])


def views(tables: Tables) -> Tables:
    """The errors by exchange and step: of the whole car, in the plane; with the computing time."""
    every = tables["car_errors"]
    found = {
        "whole car, against rollback at half the least step": moving(every),
        "in the plane, against one system of equations": largest(tables["in_plane"]),
        "computing time over simulated time": every.groupby(CASE)["computing time"].median(),
    }
    rows = pd.DataFrame(found).dropna().sort_index(ascending=[True, False]).loc[list(EXCHANGES)]
    return tables | {"steps": rows.reset_index()}
