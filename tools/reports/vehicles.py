"""Axle and car: the studies of examples/vehicles, as tables and pictures."""

from __future__ import annotations

import numpy as np
import pandas as pd
from vehicles import axle, axle_study, car, car_judges, layout, monolithic_car
from vehicles.drawing import draw, draw_orders
from vehicles.errors import STEPS, Errors, longest, orders
from vehicles.layout import MANOEUVRES
from vehicles.master import EXCHANGES

from .packages import packages
from .page import Report, Tables, part
from .partners import fmus

LIMITS = (0.001, 0.00125, 0.002, 0.0025, 0.003125, 0.00390625, 0.005)  # s; each divides the grid of the tables
BUDGET = 10.0  # us per step of 1 ms for four wheels
BONDS = ("F_X", "F_Y", "F_Z", "M_1", "M_2")


@part(30)
def axle_steps(report: Report) -> None:
    """the axle: error against the step"""
    scene = axle_study.TRAILING.changed(stop=2.0)
    kinds = {"held, positions lag": ("held", {"follow": 0.0}), **{e: (e, {}) for e in EXCHANGES}}
    rows = []
    for label, (exchange, more) in kinds.items():
        errors = axle_study.step_errors(fmus(report), scene.changed(**more), exchange, STEPS)
        rows += [
            {"inputs over the step": label, "step, ms": 1000 * h, "error / range": e}
            for h, e in zip(STEPS, errors, strict=True)
        ]
    report.table("axle_steps", rows)
    table = axle.coupled(fmus(report), axle_study.TRAILING, 0.0005, "derivatives", 0.02)
    draw(axle.AXLE, axle_study.TRAILING, table, report.folder / "vehicles_axle.png", ", step 0.5 ms")


@part(30)
def axle_stiffness(report: Report) -> None:
    """the axle: error against the stiffness"""
    factors, rows = (1.0, 2.0, 4.0), []
    for name, scene in axle_study.SCENES.items():
        errors = axle_study.stiffness_errors(fmus(report), scene.changed(stop=2.0), factors)
        order = float(-orders(factors, errors)[-1])
        of_factors = {f"stiffness x {f:g}": e for f, e in zip(factors, errors, strict=True)}
        rows.append({"scene": name, **of_factors, "order in 1/k": order})
    report.table("axle_stiffness", rows)


@part(30)
def axle_limits(report: Report) -> None:
    """the axle: the longest step for each stiffness, beside 2 J_x / c_a"""
    rows = []
    for factor in (0.5, 1.0, 2.0, 4.0):
        scene = axle_study.CLOTHOID.changed(stop=1.0, stiffness=factor)
        found = {f"{e}, ms": 1000 * axle_study.longest_step(fmus(report), scene, e) for e in EXCHANGES}
        rows.append(
            {"stiffness x": factor, **found, "2 J_x / c_a, ms": 1000 * 2 * axle.constants(scene).J_x / (500.0 * factor)}
        )
    report.table("axle_limits", rows)


@part(10)
def axle_energy(report: Report) -> None:
    """the axle: energy added per bond"""
    rows = []
    for exchange, follow in (("held", 0.0), ("held", 1.0), ("derivatives", 1.0)):
        scene = axle_study.TRAILING.changed(stop=2.0, follow=follow)
        found = axle_study.energy(fmus(report), scene, 0.001, exchange)
        label, sums = exchange if follow else f"{exchange}, positions lag", sum(found.bonds.values())
        of_bonds = {f"{n}, J": float(x) for n, x in zip(BONDS, sums, strict=True)}
        rows.append({"inputs over the step": label, **of_bonds, "sum, J": float(sums.sum()), "gain, J": found.drift})
    report.table("axle_energy", rows)


def manoeuvres(report: Report) -> tuple[str, ...]:
    return ("step",) if report.quick else monolithic_car.NAMES


@part(40)
def car_closed_forms(report: Report) -> None:
    """the car: what follows from rigid links and wheels that never slip"""
    rows = []
    for name in manoeuvres(report):
        run = car.drive(fmus(report), MANOEUVRES[name])
        rows += [(name, f.what, f.unit, f.measured, f.exact) for f in car_judges.judge(run.table, MANOEUVRES[name])]
    head = ["manoeuvre", "quantity", "unit", "measured", "closed form"]
    report.table("car_closed_forms", pd.DataFrame(rows, columns=head))


@part(40)
def car_demand(report: Report) -> None:
    """the car: the road that each manoeuvre needs, and where it needs it most"""
    rows = []
    for name in manoeuvres(report):
        table = car.drive(fmus(report), MANOEUVRES[name]).table
        at = car_judges.worst(table)[1]
        where = [round(float(table[n][at]), 6) for n in ("time", "X_R", "Y_R")]
        rows.append((MANOEUVRES[name].title, *car_judges.demand(table).values(), *where))
    head = ["manoeuvre", *(f"{axle} axle" for axle in layout.AXLES), "most at t [s]", "X [m]", "Y [m]"]
    report.table("car_demand", pd.DataFrame(rows, columns=head))


@part(40)
def car_endings(report: Report) -> None:
    """the car: what ends the manoeuvre that is too fast, and the same of one set of equations"""
    run = car.drive(fmus(report), layout.TOO_FAST, exchange="rollback")
    wheel, time = monolithic_car.lift_off(layout.TOO_FAST)
    whole = f"The {layout.NAMES[wheel]} wheel's normal force is zero at t = {time:.7f} s."
    rows = [("coupled FMUs", car.CAR.describe(run.ending)), ("one set of equations", whole)]
    report.table("car_endings", pd.DataFrame(rows, columns=["system", "how it ended"]))


@part(40)
def car_figures(report: Report) -> None:
    """the car: the figures of road tests, of the coupled car and of one set of equations on the same grid"""
    rows = []
    for name, grid in (("circle", 0.01), ("step", 0.001), ("lane", 0.005)):
        manoeuvre = MANOEUVRES[name]
        coupled = car.drive(fmus(report), manoeuvre, grid=grid).table
        whole = monolithic_car.solve(manoeuvre, np.arange(round(manoeuvre.stop / grid) + 1) * grid, 1e-9)
        both = (car_judges.FIGURES[name](table) for table in (coupled, whole))
        rows += [(name, a.what, a.unit, a.measured, b.measured, a.exact) for a, b in zip(*both, strict=True)]
    head = ["manoeuvre", "quantity", "unit", "coupled FMUs", "one set of equations", "rigid links"]
    report.table("car_figures", pd.DataFrame(rows, columns=head))


@part(40)
def car_longest(report: Report) -> None:
    """the car: the longest step with which a manoeuvre runs to its end with errors below 10 % of the ranges"""
    names = manoeuvres(report)
    rows = [(e, *(1000 * longest_step(report, name, e) for name in names)) for e in EXCHANGES]
    head = ["inputs over the step", *(f"{name} [ms]" for name in names)]
    report.table("car_longest", pd.DataFrame(rows, columns=head))


def longest_step(report: Report, name: str, exchange: str) -> float:
    def error(h: float) -> float:
        table = car.drive(fmus(report), MANOEUVRES[name], h, exchange, monolithic_car.GRID).whole
        return max(monolithic_car.apart(table, monolithic_car.read(name)).values())

    return longest(LIMITS, error)


@part(120)
def car_errors(report: Report) -> None:
    """the car: error against one set of equations, by manoeuvre, master, step and output"""
    rows, largest = [], {}
    for name in manoeuvres(report):
        truth, of = monolithic_car.read(name), largest.setdefault(name, {})
        for exchange in EXCHANGES:
            runs = [car.drive(fmus(report), MANOEUVRES[name], h, exchange, monolithic_car.GRID) for h in STEPS]
            found = [monolithic_car.apart(run.table, truth) for run in runs]
            of[exchange] = [max(errors.values()) for errors in found]
            order = [None, *-np.diff(np.log2(of[exchange]))]
            rows += [
                {"manoeuvre": name, "inputs over the step": exchange, "step [ms]": 1000 * h}
                | errors
                | {"largest": worst, "order": p}
                for h, errors, worst, p in zip(STEPS, found, of[exchange], order, strict=True)
            ]
    report.table("car_errors", rows)
    moving = [of["rollback"][0] for name, of in largest.items() if name not in ("straight", "hill")]
    report.figures(rollback=max(moving))
    draw_orders({n: Errors(STEPS, of) for n, of in largest.items()}, report.folder / "vehicles_orders.png")
    for name, manoeuvre in MANOEUVRES.items():
        draw(car.CAR, manoeuvre, car.drive(fmus(report), manoeuvre).table, report.folder / f"vehicles_{name}.png")


@part(20)
def car_cost(report: Report) -> None:
    """the car: microseconds per step of 1 ms: medians over the steps of the change of lanes, and over runs"""
    rows = []
    for exchange in EXCHANGES:
        runs = pd.DataFrame([car.drive(fmus(report), layout.LANE, exchange=exchange, grid=1.0).cost for _ in range(5)])
        wheels, bodies = (
            runs[list(layout.WHEELS)].sum(axis=1).median(),
            runs[["chassis", "driver"]].sum(axis=1).median(),
        )
        whole = runs["total"].median()
        row = {"inputs over the step": exchange, "four wheels [us]": wheels}
        row |= {f"within {BUDGET:g} us": "yes" if wheels <= BUDGET else "no", "chassis, driver [us]": bodies}
        rows.append(
            row | {"exchange [us]": runs["exchange"].median(), "all [us]": whole, "times real time": 1000 / whole}
        )
    report.table("car_cost", rows)
    report.figures(**{f"cost_{row['inputs over the step']}": row["four wheels [us]"] for row in rows[:2]})


def views(tables: Tables) -> Tables:
    """Of the car the largest error and the order at 1 ms, by manoeuvre; of the axle the errors by step."""
    errors = tables["car_errors"]
    at_1_ms = errors[errors["step [ms]"] == 1].rename(columns={"largest": "error"})
    orders = at_1_ms.pivot(index="manoeuvre", columns="inputs over the step", values=["error", "order"])
    orders = orders[[(what, exchange) for exchange in EXCHANGES for what in ("error", "order")]]
    orders.columns = [f"{exchange}: {what}" for what, exchange in orders.columns]
    axle = tables["axle_steps"].pivot(index="step, ms", columns="inputs over the step", values="error / range")
    axle = axle[tables["axle_steps"]["inputs over the step"].unique()].sort_index(ascending=False)
    orders = orders.loc[errors["manoeuvre"].unique()]
    return tables | {"car_orders": orders.reset_index(), "axle_by_step": axle.reset_index()}


FURTHER = (packages,)
