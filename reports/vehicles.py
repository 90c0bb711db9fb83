"""Axle and car: the studies of examples/vehicles, as tables and pictures."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from importlib.metadata import version

import pandas as pd
from support.paths import ROOT
from vehicles import axle, axle_study, build, car, car_study, ssp
from vehicles.drawing import Errors, draw_orders
from vehicles.example import draw_axle, draw_car
from vehicles.master import EXCHANGES

from .page import Report, Tables
from .partners import fmus

STEPS = (0.002, 0.001, 0.0005)  # s
GRID = 0.05  # s
BONDS = ("F_X", "F_Y", "F_Z", "M_1", "M_2")


def axle_steps(report: Report) -> None:
    """the axle: error against the step"""
    scene = replace(axle_study.TRAILING, stop=2.0)
    kinds = {"held, positions lag": ("held", {"follow": 0.0}), **{e: (e, {}) for e in EXCHANGES}}
    rows = []
    for label, (exchange, more) in kinds.items():
        errors = axle_study.step_errors(fmus(report), replace(scene, more=more), exchange, STEPS)
        rows += [
            {"inputs over the step": label, "step, ms": 1000 * h, "error / range": e}
            for h, e in zip(STEPS, errors, strict=True)
        ]
    report.table("axle_steps", rows)
    run = axle.coupled(fmus(report), axle_study.TRAILING, 0.0005, "derivatives", 0.02)
    exact = axle.rigid(axle_study.TRAILING, run["time"])
    draw_axle(run, exact, None, report.folder / "vehicles_axle.png", "Axle: trailing, step 0.5 ms")


def axle_stiffness(report: Report) -> None:
    """the axle: error against the stiffness"""
    factors, rows = (1.0, 2.0, 4.0), []
    for name, scene in axle_study.SCENES.items():
        errors = axle_study.stiffness_errors(fmus(report), replace(scene, stop=2.0), factors)
        order = float(-axle_study.orders(factors, errors)[-1])
        of_factors = {f"stiffness x {f:g}": e for f, e in zip(factors, errors, strict=True)}
        rows.append({"scene": name, **of_factors, "order in 1/k": order})
    report.table("axle_stiffness", rows)


def axle_limits(report: Report) -> None:
    """the axle: the longest step for each stiffness, beside 2 J_x / c_a"""
    rows = []
    for factor in (0.5, 1.0, 2.0, 4.0):
        scene = replace(axle_study.CLOTHOID, stop=1.0, stiffness=factor)
        found = {f"{e}, ms": 1000 * axle_study.longest_step(fmus(report), scene, e) for e in EXCHANGES}
        rows.append({"stiffness x": factor, **found, "2 J_x / c_a, ms": 1000 * 2 * scene.J_x / (500.0 * factor)})
    report.table("axle_limits", rows)


def axle_energy(report: Report) -> None:
    """the axle: energy added per bond"""
    rows = []
    for exchange, follow in (("held", 0.0), ("held", 1.0), ("derivatives", 1.0)):
        scene = replace(axle_study.TRAILING, stop=2.0, more={"follow": follow})
        found = axle_study.energy(fmus(report), scene, 0.001, exchange)
        label, sums = exchange if follow else f"{exchange}, positions lag", sum(found.bonds.values())
        of_bonds = {f"{n}, J": float(x) for n, x in zip(BONDS, sums, strict=True)}
        rows.append({"inputs over the step": label, **of_bonds, "sum, J": float(sums.sum()), "gain, J": found.drift})
    report.table("axle_energy", rows)


def manoeuvres(report: Report, table: str) -> list[tuple[str, ...]]:
    """Which ones a table is made of, where it is made of all."""
    return [("step",)] if report.quick and table not in ("endings", "figures") else []


def of_car(name: str) -> Callable[[Report], None]:
    def table(report: Report) -> None:
        head, rows = getattr(car_study, name)(fmus(report), *manoeuvres(report, name))
        report.table(f"car_{name}", pd.DataFrame(rows, columns=head))

    table.__doc__ = f"the car: {name.replace('_', ' ')}"
    return table


def car_errors(report: Report) -> None:
    """the car: error against the step"""
    head, rows = car_study.errors(fmus(report), *manoeuvres(report, "errors"))
    report.table("car_errors", pd.DataFrame(rows, columns=head))
    at = {(name, exchange, h): error for name, exchange, h, *_, error, _ in rows}
    largest = max(at[name, "rollback", 2.0] for name, *_ in rows if name not in ("straight", "hill"))
    report.figure("rollback", "car, rollback at 2 ms, but for standstills: error / range", largest, "", 1e-5)
    of: dict[str, dict[str, list[float]]] = {}
    for name, exchange, *_, error, _ in rows:
        of.setdefault(name, {}).setdefault(exchange, []).append(error)
    draw_orders({n: Errors(STEPS, e) for n, e in of.items()}, report.folder / "vehicles_orders.png")
    for name, manoeuvre in car.MANOEUVRES.items():
        draw_car(car.drive(fmus(report), manoeuvre), manoeuvre, None, report.folder / f"vehicles_{name}.png")


def car_cost(report: Report) -> None:
    """the car: computing times"""
    head, rows = car_study.cost(fmus(report))
    report.table("car_cost", pd.DataFrame(rows, columns=head))
    for exchange, wheels, *_ in rows[:2]:
        what = f"four wheels, a step of 1 ms, {exchange}"
        report.figure(f"cost_{exchange}", what, wheels, "µs", car_study.BUDGET)


def packages(report: Report) -> None:
    """the packages in other tools, beside the master of the examples"""
    units, h = fmus(report), 0.0005
    folder, scene, wait = units["chassis"].parent, replace(axle_study.TRAILING, stop=2.0), {"t_couple": 3 * h}
    waiting = replace(car.LANE, chassis={**car.LANE.chassis, **wait})
    later = replace(scene, more=wait)
    axles = [axle.coupled(units, s, h, e, GRID) for s, e in ((scene, "rollback"), (later, "held"))]
    cars = [car.drive(units, m, h, e, GRID).table for m, e in ((car.LANE, "rollback"), (waiting, "held"))]
    cases = (
        (ssp.build(axle.system(units, scene, h), folder), scene.stop, ("axle.X", "axle.Y"), axles),
        (ssp.build(car.system(units, car.LANE, h), folder), car.LANE.stop, ("chassis.X_R", "chassis.Y_R"), cars),
    )
    rows: list[dict[str, object]] = []
    for package, stop, wanted, own in cases:
        ends = [
            (f"master.py, {e}", "", [run[n.split(".")[1]][-1] for n in wanted])
            for e, run in zip(("rollback", "held"), own, strict=True)
        ]
        columns = ssp.run(package, h, stop, GRID)
        ends.append(("fmpy.ssp", f"FMPy {version('fmpy')}", [columns[n][-1] for n in wanted]))
        for tool, number, command in tools_at_hand(report.options["tools"]):
            said = subprocess.run([*command, package, repr(h), repr(stop), *wanted], capture_output=True, check=True)
            found = dict(line.split() for line in said.stdout.decode().splitlines() if line.startswith(wanted))
            ends.append((tool, number, [float(found[n]) for n in wanted]))
        new = [
            {"package": package.name, "tool": tool, "version": number}
            | {f"{axis} at the end, m": f"{x:.8f}" for axis, x in zip("XY", values, strict=True)}
            for tool, number, values in ends
        ]
        rows += new + of_other_tools(new)
    report.table("packages", rows)


def of_other_tools(new: list[dict[str, object]]) -> list[dict[str, object]]:
    """Published rows of tools that are not at hand now, if all that is at hand has the values that it had then."""
    path = ROOT / "docs" / "results" / "data" / "vehicles_packages.csv"
    old = pd.read_csv(path, dtype=str, keep_default_na=False).to_dict("records") if path.exists() else []
    old = {row["tool"]: row for row in old if row["package"] == new[0]["package"]}
    same = all(old.get(row["tool"]) == row for row in new)
    return [row for tool, row in old.items() if same and tool not in [row["tool"] for row in new]]


def tools_at_hand(python: str | None) -> list[tuple[str, str, list[str]]]:
    """Name, version and command: the interpreter `python` has two of them, OMSimulator may be on the PATH."""
    scripts, found = build.EXAMPLES / "tools", []
    for tool, package in (("libcosim", "libcosimpy"), ("ecos", "ecospy")) if python else ():
        ask = f"import importlib.metadata as m; print(m.version({package!r}))"
        number = subprocess.run([python, "-c", ask], capture_output=True, text=True, check=True).stdout.strip()
        found.append((tool, f"{package} {number}", [python, str(scripts / f"by_{tool}.py")]))
    if program := shutil.which("OMSimulator"):
        tried = pd.read_csv(ROOT / "docs" / "results" / "data" / "interoperability.csv", dtype=str)
        number = tried.loc[tried.iloc[:, 0] == "OMSimulator"].iloc[0, 1]
        found.append(("OMSimulator", number, [sys.executable, str(scripts / "by_omsimulator.py"), program]))
    return found


def views(tables: Tables) -> Tables:
    """Of the errors of the car, the largest of each run by step, and all of those at 1 ms."""
    errors = tables["car_errors"]
    keys, steps = ["manoeuvre", "inputs over the step"], [f"error at {1000 * h:g} ms" for h in STEPS]
    of_steps = errors.pivot(index=keys, columns="step [ms]", values="largest")[[1000 * h for h in STEPS]]
    order = errors.pivot(index=keys, columns="step [ms]", values="order")[[1000 * h for h in STEPS[1:]]]
    of_steps.columns, order.columns = steps, [f"order to {1000 * h:g} ms" for h in STEPS[1:]]
    at_1_ms = errors[errors["step [ms]"] == 1].drop(columns=["step [ms]", "order"])
    given = list(dict.fromkeys(map(tuple, errors[keys].to_numpy())))
    return {**tables, "car_orders": of_steps.join(order).loc[given].reset_index(), "car_at_1_ms": at_1_ms}


PARTS: dict[Callable[[Report], None], float] = {
    **{axle_steps: 30, axle_stiffness: 30, axle_limits: 30, axle_energy: 10, car_errors: 120, car_cost: 20},
    **{of_car(name): 40 for name in ("closed_forms", "demand", "endings", "figures", "longest")},
    packages: 120,
}
