"""Axle and car: the studies of examples/vehicles, as tables and pictures."""

from __future__ import annotations

from functools import cache

import numpy as np
import pandas as pd
from vehicles import axle, car_judges, layout, monolithic_car
from vehicles.car import CAR
from vehicles.drawing import draw, draw_orders
from vehicles.errors import STEPS, longest, orders
from vehicles.layout import MANOEUVRES
from vehicles.master import EXCHANGES
from vehicles.options import Manoeuvre

from . import packages
from .page import Report, Row, Tables, part

LIMITS = (0.001, 0.00125, 0.002, 0.0025, 0.003125, 0.00390625, 0.005)  # s; each divides the grid of the tables
BUDGET = 10.0  # us per step of 1 ms for four wheels
BONDS = ("F_X, J", "F_Y, J", "F_Z, J", "M_1, J", "M_2, J")
# How the inputs behave over a step: the exchange, and whether positions follow the velocities.
OVER = {"held, positions lag": ("held", {"follow": 0.0}), **{exchange: (exchange, {}) for exchange in EXCHANGES}}
GIVEN = {name: OVER[name] for name in ("held, positions lag", "held", "derivatives")}
STEPS_MS = [1000 * h for h in STEPS]


@part(30, {"inputs over the step": OVER})
def axle_steps(report: Report, over: tuple) -> list[Row]:
    """the axle: error against the step"""
    exchange, more = over
    errors = axle.step_errors(report.fmus, axle.TRAILING.changed(stop=2.0, **more), exchange, STEPS)
    return [{"step, ms": 1000 * h, "error / range": error} for h, error in errors.items()]


@part(30, {"scene": axle.SCENES})
def axle_stiffness(report: Report, scene: Manoeuvre) -> Row:
    """the axle: error against the stiffness"""
    factors = (1.0, 2.0, 4.0)
    errors = axle.stiffness_errors(report.fmus, scene.changed(stop=2.0), factors)
    found = {f"stiffness x {f:g}": e for f, e in errors.items()}
    return found | {"order in 1/k": float(-orders(errors)[-1])}


@part(30, {"stiffness x": (0.5, 1.0, 2.0, 4.0)})
def axle_limits(report: Report, factor: float) -> Row:
    """the axle: the longest step for each stiffness, beside 2 J_x / c_a"""
    scene = axle.CLOTHOID.changed(stop=1.0, stiffness=factor)
    found = {f"{e}, ms": 1000 * axle.longest_step(report.fmus, scene, e) for e in EXCHANGES}
    return found | {"2 J_x / c_a, ms": 1000 * 2 * axle.constants(scene).J_x / (500.0 * factor)}


@part(10, {"inputs over the step": GIVEN})
def axle_energy(report: Report, over: tuple) -> Row:
    """the axle: energy added per bond"""
    exchange, more = over
    scene = axle.TRAILING.changed(stop=2.0, **({"follow": 1.0} | more))
    bonds, gain = axle.energy(report.fmus, scene, 0.001, exchange)
    sums = bonds.sum(axis=0)
    return dict(zip(BONDS, sums, strict=True)) | {"sum, J": float(sums.sum()), "gain, J": gain}


def manoeuvres(report: Report) -> tuple[str, ...]:
    return ("step",) if report.quick else monolithic_car.NAMES


@part(70)
def car_runs(report: Report) -> dict[str, object]:
    """the car: closed forms of rigid links and wheels that never slip; the road that each manoeuvre needs"""
    judged, demands = [], []
    for name in manoeuvres(report):
        manoeuvre = MANOEUVRES[name]
        table = CAR.drive(report.fmus, manoeuvre).table
        found = car_judges.judge(table, manoeuvre, *manoeuvre.judges)
        judged += [(name, f.what, f.unit, f.measured, f.exact) for f in found]
        *_, at = car_judges.worst(table)
        where = [round(float(table[n][at]), 6) for n in ("time", "X_R", "Y_R")]
        demands.append((manoeuvre.title, *car_judges.demand(table).values(), *where))
    most = ["manoeuvre", *(f"{axle} axle" for axle in layout.AXLES), "most at t [s]", "X [m]", "Y [m]"]
    forms = ["manoeuvre", "quantity", "unit", "measured", "closed form"]
    return {"car_closed_forms": pd.DataFrame(judged, columns=forms), "car_demand": pd.DataFrame(demands, columns=most)}


@part(40)
def car_endings(report: Report) -> list[Row]:
    """the car: what ends the manoeuvre that is too fast, and the same of one set of equations"""
    run = CAR.drive(report.fmus, layout.TOO_FAST, exchange="rollback")
    wheel, time = monolithic_car.lift_off(layout.TOO_FAST)
    whole = f"The {layout.NAMES[wheel]} wheel's normal force is zero at t = {time:.7f} s."
    ends = {"coupled FMUs": CAR.describe(run.ending), "one set of equations": whole}
    return [{"system": system, "how it ended": end} for system, end in ends.items()]


@part(40, {"manoeuvre": ("circle", "step", "lane")})
def car_figures(report: Report, name: str) -> list[Row]:
    """the car: the figures of road tests, of the coupled car and of one set of equations on the same grid"""
    manoeuvre, grid = MANOEUVRES[name], {"circle": 0.01, "step": 0.001, "lane": 0.005}[name]  # s
    coupled = CAR.drive(report.fmus, manoeuvre, grid=grid).table
    whole = monolithic_car.solve(manoeuvre, grid, 1e-9)
    both = (car_judges.judge(table, manoeuvre, name) for table in (coupled, whole))
    head = ("quantity", "unit", "coupled FMUs", "one set of equations", "rigid links")
    rows = ((a.what, a.unit, a.measured, b.measured, a.exact) for a, b in zip(*both, strict=True))
    return [dict(zip(head, row, strict=True)) for row in rows]


truth = cache(monolithic_car.read)


@part(40, {"inputs over the step": EXCHANGES})
def car_longest(report: Report, exchange: str) -> Row:
    """the car: the longest step with which a manoeuvre runs to its end with errors below 10 % of the ranges"""

    def longest_step(name: str) -> float:
        return longest(LIMITS, lambda h: CAR.error(report.fmus, MANOEUVRES[name], truth(name), h, exchange))

    return {f"{name} [ms]": 1000 * longest_step(name) for name in manoeuvres(report)}


@part(120, {"manoeuvre": manoeuvres, "inputs over the step": EXCHANGES, "step [ms]": STEPS_MS})
def car_errors(report: Report, name: str, exchange: str, ms: float) -> Row:
    """the car: error against one set of equations, by manoeuvre, master, step and output"""
    run = CAR.drive(report.fmus, MANOEUVRES[name], ms / 1000, exchange, monolithic_car.GRID)
    found = CAR.apart(run.whole, truth(name))
    return found | {"largest": max(found.values())}


@part(30)
def pictures(report: Report) -> dict[str, float]:
    """pictures of the motions; the largest error where no wheel stops"""
    table = axle.AXLE.drive(report.fmus, axle.TRAILING, 0.0005, "derivatives", 0.02).whole
    draw(axle.AXLE, axle.TRAILING, table, report.folder / "vehicles_axle.png", ", step 0.5 ms")
    for name, manoeuvre in MANOEUVRES.items():
        draw(CAR, manoeuvre, CAR.drive(report.fmus, manoeuvre).table, report.folder / f"vehicles_{name}.png")
    found = report.tables["car_errors"].groupby(["manoeuvre", "inputs over the step"], sort=False)["largest"].agg(list)
    of = {
        name: {e: dict(zip(STEPS, errors, strict=True)) for e, errors in found[name].items()}
        for name in manoeuvres(report)
    }
    draw_orders(of, report.folder / "vehicles_orders.png")
    return {"rollback": max(of[name]["rollback"][STEPS[0]] for name in of if name not in ("straight", "hill"))}


@part(20, {"inputs over the step": EXCHANGES})
def car_cost(report: Report, exchange: str) -> Row:
    """the car: microseconds per step of 1 ms: medians over the steps of the change of lanes, and over runs"""
    runs = pd.DataFrame([CAR.drive(report.fmus, layout.LANE, exchange=exchange, grid=1.0).cost for _ in range(5)])
    wheels, bodies = (runs[list(names)].sum(axis=1).median() for names in (layout.WHEELS, ("chassis", "driver")))
    exchanged, whole = runs["exchange"].median(), runs["total"].median()
    row = {"four wheels [us]": wheels, f"within {BUDGET:g} us": "yes" if wheels <= BUDGET else "no"}
    row |= {"chassis, driver [us]": bodies, "exchange [us]": exchanged, "all [us]": whole}
    return row | {"times real time": 1000 / whole}


def views(tables: Tables) -> Tables:
    """Of the car the largest error and the order at 1 ms, by manoeuvre; of the axle the errors by step."""
    errors = tables["car_errors"]
    halved = np.log2(errors["largest"]).groupby([errors["manoeuvre"], errors["inputs over the step"]]).diff()
    errors = errors.assign(order=-halved)
    at_1_ms = errors[errors["step [ms]"] == 1].rename(columns={"largest": "error"})
    orders = at_1_ms.pivot(index="manoeuvre", columns="inputs over the step", values=["error", "order"])
    orders = orders[[(what, exchange) for exchange in EXCHANGES for what in ("error", "order")]]
    orders.columns = [f"{exchange}: {what}" for what, exchange in orders.columns]
    axle = tables["axle_steps"].pivot(index="step, ms", columns="inputs over the step", values="error / range")
    axle = axle[tables["axle_steps"]["inputs over the step"].unique()].sort_index(ascending=False)
    orders = orders.loc[errors["manoeuvre"].unique()]
    return tables | {"car_orders": orders.reset_index(), "axle_by_step": axle.reset_index()}


FURTHER = (packages,)
