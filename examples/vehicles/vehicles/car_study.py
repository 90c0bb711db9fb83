"""What the report says of the car: tables as (head, rows), each from runs of the C master.

Errors are those against the car as one set of equations over the full length of each manoeuvre (car_table.py).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from . import car, car_iso, car_judges, car_table, monolithic_car
from .car import MANOEUVRES, TOO_FAST, WHEELS
from .master import EXCHANGES

Fmus = dict[str, Path]
Table = tuple[tuple[str, ...], list[list[object]]]
STEPS = (0.002, 0.001, 0.0005)  # s
LIMITS = (0.001, 0.00125, 0.002, 0.0025, 0.003125, 0.004, 0.005)  # s; each divides the grid of the tables
BUDGET = 10.0  # us per step of 1 ms for four wheels
NAMES = {w: str(wheel["name"]) for w, wheel in WHEELS.items()}


def closed_forms(fmus: Fmus, names: tuple[str, ...] = car_table.NAMES) -> Table:
    """What follows from rigid links and wheels that never slip."""
    rows = []
    for name in names:
        run = car.drive(fmus, MANOEUVRES[name])
        rows += [[name, f.what, f.unit, f.measured, f.exact] for f in car_judges.judge(run.table, MANOEUVRES[name])]
    return ("manoeuvre", "quantity", "unit", "measured", "closed form"), rows


def demand(fmus: Fmus, names: tuple[str, ...] = car_table.NAMES) -> Table:
    """The road that each manoeuvre needs, and where it needs it most."""
    rows = []
    for name in names:
        table = car.drive(fmus, MANOEUVRES[name]).table
        most = car_judges.demand(table)
        worst = max(most, key=most.get)
        at = int(np.nanargmax(table[f"{worst}.mu_required"]))
        where = [round(float(table[n][at]), 6) for n in ("time", "X_R", "Y_R")]
        rows.append([MANOEUVRES[name].title, *most.values(), *where])
    return ("manoeuvre", *NAMES.values(), "most at t [s]", "X [m]", "Y [m]"), rows


def endings(fmus: Fmus) -> Table:
    """The manoeuvre that is too fast: what ends it, and the same of one set of equations."""
    run = car.drive(fmus, TOO_FAST, exchange="rollback")
    wheel, time = car_table.lift_off(TOO_FAST)
    whole = f"The {NAMES[wheel]} wheel's normal force is zero at t = {time:.7f} s."
    return ("system", "how it ended"), [["coupled FMUs", car.sentence(run.ending)], ["one set of equations", whole]]


def errors(fmus: Fmus, names: tuple[str, ...] = car_table.NAMES) -> Table:
    """By manoeuvre, master, step and output, relative to the output's range; the largest, and its order."""
    rows: list[list[object]] = []
    for name in names:
        truth = car_table.read(name)
        for exchange in EXCHANGES:
            before = np.nan
            for h in STEPS:
                run = car.drive(fmus, MANOEUVRES[name], h, exchange, car_table.GRID)
                found = car_table.apart(run.table, truth)
                worst = max(found.values())
                order = float(np.log2(before / worst))
                rows.append([name, exchange, 1000 * h, *found.values(), worst, order if before == before else ""])
                before = worst
    return ("manoeuvre", "inputs over the step", "step [ms]", *car.COMPARED, "largest", "order"), rows


def figures(fmus: Fmus) -> Table:
    """The figures of car_iso, of the coupled car and of one set of equations on the same grid."""
    rows = []
    for name, grid in (("circle", 0.01), ("step", 0.001), ("lane", 0.005)):
        manoeuvre = MANOEUVRES[name]
        coupled = car_iso.complete(car.drive(fmus, manoeuvre, grid=grid).table)
        whole = monolithic_car.solve(manoeuvre, np.arange(round(manoeuvre.stop / grid) + 1) * grid, 1e-9)
        both = (car_iso.FIGURES[name](table) for table in (coupled, whole))
        for one, other in zip(*both, strict=True):
            theory = "" if one.theory is None else one.theory
            rows.append([name, one.what, one.unit, one.value, other.value, theory])
    return ("manoeuvre", "quantity", "unit", "coupled FMUs", "one set of equations", "rigid links"), rows


def longest(fmus: Fmus, names: tuple[str, ...] = car_table.NAMES) -> Table:
    """The longest step with which a manoeuvre runs to its end with errors below 10 % of the ranges, ms."""
    rows = []
    for exchange in EXCHANGES:
        rows.append([exchange, *(1000 * _longest(fmus, name, exchange) for name in names)])
    return ("inputs over the step", *(f"{name} [ms]" for name in names)), rows


def _longest(fmus: Fmus, name: str, exchange: str) -> float:
    truth, found = car_table.read(name), 0.0
    for h in LIMITS:
        run = car.drive(fmus, MANOEUVRES[name], h, exchange, car_table.GRID)
        if run.ending or not max(car_table.apart(run.table, truth).values()) < 0.1:
            break
        found = h
    return found


def cost(fmus: Fmus, repeats: int = 5) -> Table:
    """Microseconds per communication step of 1 ms: medians over the steps of the change of lanes, and over runs."""
    rows = []
    for exchange in EXCHANGES:
        runs = [car.drive(fmus, car.LANE, exchange=exchange, grid=1.0).cost for _ in range(repeats)]
        wheels = float(np.median([sum(run[w] for w in WHEELS) for run in runs]))
        bodies = float(np.median([run["chassis"] + run["driver"] for run in runs]))
        passed, whole = (float(np.median([run[n] for run in runs])) for n in ("exchange", "total"))
        rows.append([exchange, wheels, "yes" if wheels <= BUDGET else "no", bodies, passed, whole, 1000 / whole])
    head = ("inputs over the step", "four wheels [us]", f"within {BUDGET:g} us", "chassis, driver [us]")
    return (*head, "exchange [us]", "all [us]", "times real time"), rows
