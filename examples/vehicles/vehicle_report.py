"""The study of axle and car: docs/results/vehicles.md, its figures, and its numbers under docs/results/data/.

`write(fmus, results)` is what a report command calls; `tools`, a Python interpreter with libcosimpy and ecospy,
adds those two to the table of packages.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from . import axle, axle_study, build, car, car_judges, monolithic_car, plan, ssp
from .component import Ended
from .drawing import Line, draw
from .master import EXCHANGES
from .report import RESULTS, footer, table

STEPS = (0.002, 0.001, 0.0005)  # s
LIMITS = (0.001, 0.0015, 0.002, 0.0025, 0.003, 0.004)  # s
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
    """data/NAME.csv as a Markdown table, numbers to four digits, those of the packages as they are."""
    with (results / "data" / f"{name}.csv").open() as file:
        head, *rows = csv.reader(file)
    return table(head, rows if name == "vehicle_packages" else [[short(cell) for cell in row] for row in rows])


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


def manoeuvres(fmus: Fmus, results: Path) -> None:
    """Every manoeuvre against its closed forms, what it asks of the road, and its figure."""
    found, demand, endings = [], [], []
    for name, manoeuvre in car.MANOEUVRES.items():
        run = car.drive(fmus, manoeuvre)
        degrees = [Line(n, np.degrees(run.table[n])) for n in ("delta", "roll", "pitch")]
        names = {w: str(wheel["name"]) for w, wheel in car.WHEELS.items()}
        draw(run.table, names, ("angle [deg]", degrees), None, results / f"vehicles_{name}.png")
        if run.ending:
            endings.append(run.ending)
            continue
        demand.append([manoeuvre.title, *car_judges.demand(run.table).values()])
        for f in car_judges.judge(run.table, manoeuvre):
            found.append([name, f.what, f.unit, float(f.measured), float(f.exact)])
    head = ("manoeuvre", "quantity", "unit", "measured", "closed form")
    save(results, "car_closed_forms", head, found)
    save(results, "car_demand", ("manoeuvre", *(str(w["name"]) for w in car.WHEELS.values())), demand)
    save(results, "car_endings", ("how it ended",), [[sentence] for sentence in endings])


def whole_car(fmus: Fmus, results: Path) -> None:
    """Error against the car as one set of equations, and real time over computing time in Python; the begin of each."""
    rows = []
    stop = replace(car.STRAIGHT, stop=4.0, driver={**car.STRAIGHT.driver, "t_off": 1.5, "t_brake": 1.8})
    for manoeuvre in (replace(car.STEP, stop=2.0), replace(car.LANE, stop=4.0), replace(car.EIGHT, stop=4.0), stop):
        truth = monolithic_car.solve(manoeuvre, np.arange(round(manoeuvre.stop / GRID) + 1) * GRID, 1e-9)
        ranges = {n: max(float(np.ptp(truth[n])), 0.01) for n in car.COMPARED}
        for exchange in EXCHANGES:
            for h in STEPS[:2]:
                begin = perf_counter()
                run = car.drive(fmus, manoeuvre, h, exchange, GRID)
                factor = manoeuvre.stop / (perf_counter() - begin)
                apart = max(float(np.abs(run.table[n] - truth[n]).max()) / ranges[n] for n in car.COMPARED)
                rows.append([manoeuvre.name, exchange, 1000 * h, apart, factor])
    head = ("manoeuvre", "inputs over the step", "step [ms]", "error / range", "times real time (Python)")
    save(results, "car_errors", head, rows)


def longest(fmus: Fmus, results: Path) -> None:
    """The longest step at which the lane change runs to its end."""
    rows = []
    for exchange in EXCHANGES:
        runs = [h for h in LIMITS if not car.drive(fmus, replace(car.LANE, stop=1.5), h, exchange, h).ending]
        rows.append([exchange, 1000 * max(runs, default=float("nan"))])
    save(results, "car_longest_step", ("inputs over the step", "longest step [ms]"), rows)


def cost(fmus: Fmus, results: Path, repeats: int = 5) -> None:
    """Microseconds per communication step of 1 ms in the C master: medians over the steps, of them over the runs."""
    rows = []
    for exchange in EXCHANGES[:2]:
        parts, program = car.components(fmus, car.LANE), fmus["chassis"].parent / "master"
        runs = [plan.run(program, parts, car.CONNECTIONS, [], 0.001, car.LANE.stop, exchange) for _ in range(repeats)]
        wheels = float(np.median([sum(run.steps[w] for w in car.WHEELS) for run in runs]))
        bodies = float(np.median([run.steps["chassis"] + run.steps["driver"] for run in runs]))
        passed, whole = (float(np.median([getattr(run, n) for run in runs])) for n in ("exchange", "total"))
        rows.append([exchange, wheels, bodies, passed, whole, 1000 / whole])
    head = ("inputs over the step", "four wheels [us]", "chassis, driver [us]", "exchange [us]", "all [us]")
    save(results, "car_cost", (*head, "times real time"), rows)


def packages(fmus: Fmus, results: Path, tools: str | None) -> None:
    """The ends of both packages in each tool, beside the run with rollback."""
    folder, h = fmus["chassis"].parent, 0.0005
    scene, manoeuvre = replace(axle_study.TRAILING, stop=2.0), replace(car.LANE, stop=4.0)
    rolled = axle.coupled(fmus, scene, h, "rollback", GRID), car.drive(fmus, manoeuvre, h, "rollback", GRID).table
    cases = (
        (ssp.build(axle.system(fmus, scene, h), folder), scene.stop, ("axle.X", "axle.Y"), rolled[0]),
        (ssp.build(car.system(fmus, manoeuvre, h), folder), manoeuvre.stop, ("chassis.X_R", "chassis.Y_R"), rolled[1]),
    )
    rows: Rows = []
    for package, stop, wanted, truth in cases:
        columns = ssp.run(package, h, stop, GRID)
        rows.append([package.name, "reference", *(f"{truth[n.split('.')[1]][-1]:.6f}" for n in wanted)])
        rows.append([package.name, "fmpy.ssp", *(f"{columns[n][-1]:.6f}" for n in wanted)])
        for tool in ("libcosim", "ecos") if tools else ():
            script = build.EXAMPLES / "tools" / f"by_{tool}.py"
            command = [tools, str(script), str(package), repr(h), repr(stop), *wanted]
            said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
            ends = dict(line.split() for line in said if line.startswith(wanted))
            rows.append([package.name, tool, *(f"{float(ends[n]):.6f}" for n in wanted)])
    save(results, "vehicle_packages", ("package", "tool", "X at the end [m]", "Y at the end [m]"), rows)


def axle_figure(fmus: Fmus, results: Path) -> None:
    """The trailing axle."""
    run = axle.coupled(fmus, axle_study.TRAILING, 0.0005, "derivatives", 0.02)
    exact = axle.rigid(axle_study.TRAILING, run["time"])
    lines = [Line("speed [m/s]", run["v"]), Line("yaw rate [rad/s]", run["omega"])]
    wheels = {w: w for w in axle.WHEELS}
    draw(run, wheels, ("middle of the axle", lines), None, results / "vehicles_axle.png", (exact["X"], exact["Y"]))


TABLES = (
    *("axle_steps", "axle_stiffness", "axle_limits", "axle_energy", "car_closed_forms", "car_demand", "car_endings"),
    *("car_errors", "car_longest_step", "car_cost", "vehicle_packages"),
)


def page(results: Path = RESULTS) -> Path:
    """docs/results/vehicles.md from the data."""
    path, template = results / "vehicles.md", (Path(__file__).parent / "vehicles.md.in").read_text()
    path.write_text(template.format(footer=footer(), step="0.5", **{name: as_table(results, name) for name in TABLES}))
    return path


def write(fmus: Fmus, results: Path = RESULTS, tools: str | None = None) -> Path:
    """All studies, and docs/results/vehicles.md."""
    axle_figure(fmus, results)
    for study in (axle_steps, axle_stiffness, axle_limits, axle_energy, whole_car, longest, cost, manoeuvres):
        study(fmus, results)
    packages(fmus, results, tools)
    return page(results)


if __name__ == "__main__":
    try:
        print(write(build.build_all(build.ROOT / "build" / "examples"), tools=(sys.argv[1:] or [None])[0]))
    except Ended as end:
        sys.exit(f"A run of the study ended early: {end}")
