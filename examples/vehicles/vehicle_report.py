"""The study of axle and car: docs/results/vehicles.md, its figures, and its numbers under docs/results/data/."""

from __future__ import annotations

import argparse
import csv
import io
import shutil
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np

from . import axle, axle_study, build, car, car_study, ssp
from .component import Ended
from .drawing import Errors, Line, draw, draw_orders
from .master import EXCHANGES
from .report import RESULTS, made, table

STEPS = (0.002, 0.001, 0.0005)  # s
GRID = 0.05  # s
Rows = list[list[object]]
Fmus = dict[str, Path]


def save(results: Path, name: str, head: Iterable[str], rows: Rows) -> None:
    """data/NAME.csv."""
    path = results / "data" / f"{name}.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([list(head), *rows])


def as_table(results: Path, name: str) -> str:
    """data/NAME.csv as a Markdown table, numbers to four digits, those of vehicle_* as they are; errors at 1 ms."""
    with (results / "data" / f"{name}.csv").open() as file:
        head, *rows = csv.reader(file)
    if name == "car_errors":
        rows = [row for row in rows if row[2] == "1.0"]
    return table(head, rows if name.startswith("vehicle_") else [[short(cell) for cell in row] for row in rows])


def short(cell: str) -> str:
    """Four digits if it is a number."""
    try:
        return f"{float(cell):.4g}"
    except ValueError:
        return cell


def axle_steps(fmus: Fmus, results: Path) -> None:
    """Error against h."""
    scene = replace(axle_study.TRAILING, stop=2.0)
    kinds = {"held, positions lag": ("held", {"follow": 0.0}), **{e: (e, {}) for e in EXCHANGES}}
    rows = []
    for label, (exchange, more) in kinds.items():
        errors = axle_study.step_errors(fmus, replace(scene, more=more), exchange, STEPS)
        rows += [[label, 1000 * h, e] for h, e in zip(STEPS, errors, strict=True)]
    save(results, "axle_steps", ("inputs over the step", "step [ms]", "error / range"), rows)


def axle_stiffness(fmus: Fmus, results: Path) -> None:
    """Error against k."""
    factors, rows = (1.0, 2.0, 4.0), []
    for name, scene in axle_study.SCENES.items():
        errors = axle_study.stiffness_errors(fmus, replace(scene, stop=2.0), factors)
        order = float(-axle_study.orders(factors, errors)[-1])
        rows.append([name, *errors, order])
    head = ("scene", *(f"stiffness x {f:g}" for f in factors), "order in 1/k")
    save(results, "axle_stiffness", head, rows)


def axle_limits(fmus: Fmus, results: Path) -> None:
    """The longest step for each stiffness, beside 2 J_x / c_a."""
    rows = []
    for factor in (0.5, 1.0, 2.0, 4.0):
        scene = replace(axle_study.CLOTHOID, stop=1.0, stiffness=factor)
        found = [1000 * axle_study.longest_step(fmus, scene, exchange) for exchange in EXCHANGES]
        rows.append([factor, *found, 1000 * 2 * scene.J_x / (500.0 * factor)])
    save(results, "axle_limits", ("stiffness x", *(f"{e} [ms]" for e in EXCHANGES), "2 J_x / c_a [ms]"), rows)


def axle_energy(fmus: Fmus, results: Path) -> None:
    """Energy added per bond and second."""
    rows = []
    for exchange, follow in (("held", 0.0), ("held", 1.0), ("derivatives", 1.0)):
        scene = replace(axle_study.TRAILING, stop=2.0, more={"follow": follow})
        found = axle_study.energy(fmus, scene, 0.001, exchange)
        label = exchange if follow else f"{exchange}, positions lag"
        sums = sum(found.bonds.values())
        rows.append([label, *(float(x) for x in sums), float(sums.sum()), found.drift])
    head = ("inputs over the step", *(f"{n} [J]" for n in ("F_X", "F_Y", "F_Z", "M_1", "M_2")), "sum [J]", "gain [J]")
    save(results, "axle_energy", head, rows)


def car_tables(fmus: Fmus, results: Path) -> None:
    """All of the car but what it costs."""
    for name in ("closed_forms", "demand", "endings", "figures", "longest"):
        save(results, f"car_{name}", *getattr(car_study, name)(fmus))
    found = car_study.errors(fmus)
    save(results, "car_errors", *found)
    save(results, "car_orders", *car_study.orders(found))


def car_cost(fmus: Fmus, results: Path) -> None:
    """Computing times: on a machine that does nothing else."""
    save(results, "car_cost", *car_study.cost(fmus))


def car_figures(fmus: Fmus, results: Path) -> None:
    """A figure of each manoeuvre, and the one of car_orders."""
    with (results / "data" / "car_orders.csv").open() as file:
        _, *rows = csv.reader(file)
    of: dict[str, dict[str, list[float]]] = {}
    for name, exchange, *errors in rows:
        of.setdefault(name, {})[exchange] = [float(e) for e in errors[: len(car_study.STEPS)]]
    draw_orders({name: Errors(car_study.STEPS, e) for name, e in of.items()}, results / "vehicles_orders.png")
    for name, manoeuvre in car.MANOEUVRES.items():
        run, _ = car.drive_in_c(fmus, manoeuvre)
        degrees = [Line(n, np.degrees(run.table[n])) for n in ("delta", "roll", "pitch")]
        draw(run.table, car_study.NAMES, ("angle [deg]", degrees), None, results / f"vehicles_{name}.png")


def packages(fmus: Fmus, results: Path, tools: str | None = None) -> None:
    """The ends of both packages in each tool, beside the master of the examples."""
    folder, h = fmus["chassis"].parent, 0.0005
    scene, wait = replace(axle_study.TRAILING, stop=2.0), {"t_couple": 3 * h}
    waiting = replace(car.LANE, chassis={**car.LANE.chassis, **wait})
    later = replace(scene, more=wait)
    axles = [axle.coupled(fmus, s, h, e, GRID) for s, e in ((scene, "rollback"), (later, "held"))]
    cars = [car.drive_in_c(fmus, m, h, e, GRID)[0].table for m, e in ((car.LANE, "rollback"), (waiting, "held"))]
    cases = (
        (ssp.build(axle.system(fmus, scene, h), folder), scene.stop, ("axle.X", "axle.Y"), axles),
        (ssp.build(car.system(fmus, car.LANE, h), folder), car.LANE.stop, ("chassis.X_R", "chassis.Y_R"), cars),
    )
    rows: Rows = []
    for package, stop, wanted, own in cases:
        ends = [("master.py, rollback", "", [own[0][n.split(".")[1]][-1] for n in wanted])]
        ends.append(("master.py, held", "", [own[1][n.split(".")[1]][-1] for n in wanted]))
        columns = ssp.run(package, h, stop, GRID)
        ends.append(("fmpy.ssp", f"FMPy {version('fmpy')}", [columns[n][-1] for n in wanted]))
        for tool, number, command in _tools(tools):
            said = subprocess.run([*command, package, repr(h), repr(stop), *wanted], capture_output=True, check=True)
            found = dict(line.split() for line in said.stdout.decode().splitlines() if line.startswith(wanted))
            ends.append((tool, number, [float(found[n]) for n in wanted]))
        new = [[package.name, tool, number, *(f"{x:.8f}" for x in values)] for tool, number, values in ends]
        rows += new + _kept(results, new)
    save(results, "vehicle_packages", ("package", "tool", "version", "X at the end [m]", "Y at the end [m]"), rows)


def _kept(results: Path, new: Rows) -> Rows:
    """Rows of tools that are not at hand now, from a table in which all that is at hand had the values of now."""
    path = results / "data" / "vehicle_packages.csv"
    with path.open() if path.exists() else io.StringIO() as file:
        old = {row[1]: row for row in csv.reader(file) if row[0] == new[0][0]}
    same = all(old.get(row[1]) == row for row in new)
    return [row for tool, row in old.items() if same and tool not in [row[1] for row in new]]


def _tools(python: str | None) -> list[tuple[str, str, list[str]]]:
    """Name, version and command of the tools at hand: `python` has two of them, OMSimulator may be on the PATH."""
    scripts, found = build.EXAMPLES / "tools", []
    for tool, package in (("libcosim", "libcosimpy"), ("ecos", "ecospy")) if python else ():
        ask = f"import importlib.metadata as m; print(m.version({package!r}))"
        number = subprocess.run([python, "-c", ask], capture_output=True, text=True, check=True).stdout.strip()
        found.append((tool, f"{package} {number}", [python, str(scripts / f"by_{tool}.py")]))
    if program := shutil.which("OMSimulator"):
        with (RESULTS / "data" / "interoperability.csv").open() as file:
            number = next(row[1] for row in csv.reader(file) if row[0] == "OMSimulator")
        found.append(("OMSimulator", number, [sys.executable, str(scripts / "by_omsimulator.py"), program]))
    return found


def axle_figure(fmus: Fmus, results: Path) -> None:
    """The trailing axle."""
    run = axle.coupled(fmus, axle_study.TRAILING, 0.0005, "derivatives", 0.02)
    exact = axle.rigid(axle_study.TRAILING, run["time"])
    lines = [Line("speed [m/s]", run["v"]), Line("yaw rate [rad/s]", run["omega"])]
    wheels = {w: w for w in axle.WHEELS}
    draw(run, wheels, ("middle of the axle", lines), None, results / "vehicles_axle.png", (exact["X"], exact["Y"]))


STUDIES = {
    study.__name__: study
    for study in (axle_steps, axle_stiffness, axle_limits, axle_energy, axle_figure, car_tables, car_figures, car_cost)
}
OF_CAR = ("closed_forms", "demand", "endings", "figures", "longest", "errors", "orders", "cost")
TABLES = (
    *("axle_steps", "axle_stiffness", "axle_limits", "axle_energy"),
    *(f"car_{name}" for name in OF_CAR),
    *("vehicle_packages", "vehicle_made"),
)


def page(results: Path = RESULTS) -> Path:
    """docs/results/vehicles.md from the data."""
    path, template = results / "vehicles.md", (Path(__file__).parent / "vehicles.md.in").read_text()
    path.write_text(template.format(**{name: as_table(results, name) for name in TABLES}))
    return path


def write(
    fmus: Fmus, results: Path = RESULTS, tools: str | None = None, parts: Iterable[str] = (*STUDIES, "packages")
) -> Path:
    """The studies named, and docs/results/vehicles.md.

    tools: a Python interpreter with libcosimpy and ecospy, for the packages; OMSimulator is taken from the PATH.
    """
    save(results, "vehicle_made", made(), [list(made().values())])
    for part in parts:
        STUDIES[part](fmus, results) if part in STUDIES else packages(fmus, results, tools)
    return page(results)


def main() -> None:
    """python -m vehicles.vehicle_report [--tools PYTHON] [PART...]"""
    parser = argparse.ArgumentParser(prog="vehicles.vehicle_report", description=__doc__)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join((*STUDIES, "packages")) + "; without: all")
    parser.add_argument("--tools", metavar="PYTHON", help="an interpreter with libcosimpy and ecospy")
    options = parser.parse_args()
    try:
        parts = options.parts or (*STUDIES, "packages")
        print(write(build.build_all(build.ROOT / "build" / "examples"), tools=options.tools, parts=parts))
    except Ended as end:
        sys.exit(f"A run of the study ended early: {end}")


if __name__ == "__main__":
    main()
