"""./scripts/example NAME [parameter=value ...]: builds the FMUs, runs the example, draws it, packs it.

All that is written goes to results/examples/NAME/: the table, the figure, the FMUs and the SSP package.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
from fmpy import read_model_description
from tqdm import tqdm

from . import axle, axle_study, build, car, driven, figures, ssp, suspended
from .component import Ended
from .drawing import Errors, Line, draw
from .master import EXCHANGES
from .options import Asked, Refused, read

RESULTS = build.ROOT / "results" / "examples"
STEPS = (0.002, 0.001, 0.0005)  # s, for the error against the step
Table = dict[str, np.ndarray]


def parameters(fmu: Path) -> set[str]:
    """Names of an FMU's parameters."""
    return {
        v.name for v in read_model_description(str(fmu), validate=False).modelVariables if v.causality == "parameter"
    }


def write_table(table: Table, path: Path) -> None:
    """CSV with one column per signal."""
    np.savetxt(
        path, np.column_stack(list(table.values())), delimiter=",", header=",".join(table), comments="", fmt="%.9g"
    )


def errors(run: Callable[[float, str], Table], compared: tuple[str, ...]) -> Errors:
    """Error of each master against the run with rollback at half the smallest step."""
    truth = run(STEPS[-1] / 2, "rollback")
    ranges = {n: max(float(np.ptp(truth[n])), 0.01) for n in compared}
    found: dict[str, list[float]] = {exchange: [] for exchange in EXCHANGES}
    for exchange, h in tqdm([(e, h) for e in EXCHANGES for h in STEPS], leave=False, unit=" runs"):
        try:
            table = run(h, exchange)
        except Ended:
            found[exchange].append(float("nan"))
            continue
        found[exchange].append(max(float(np.abs(table[n] - truth[n]).max()) / ranges[n] for n in compared))
    return Errors(STEPS, found)


def run_axle(fmus: dict[str, Path], arguments: list[str], folder: Path) -> list[str]:
    """The axle: a scene of axle_study.SCENES, with any field of axle.Scene or parameter of axle.fmu changed."""
    own = {f.name for f in fields(axle.Scene)} - {"more"}
    words = {"scene": tuple(axle_study.SCENES), "exchange": EXCHANGES}
    given = read(arguments, words, own | parameters(fmus["axle"]) | {"h"})
    scene = axle_study.SCENES[given.pop("scene", "trailing")]
    exchange, h = given.pop("exchange", "derivatives"), given.pop("h", 0.001)
    more = {name: value for name, value in given.items() if name not in own}
    scene = replace(scene, more=more, **{name: value for name, value in given.items() if name in own})
    table = axle.coupled(fmus, scene, h, exchange, round(0.02 / h) * h, progress=True)
    exact = axle.rigid(scene, table["time"])
    off = axle_study.distance(table, exact)
    short = replace(scene, stop=min(scene.stop, 2.0))
    found = errors(lambda step, how: axle.coupled(fmus, short, step, how, 0.02), axle.COMPARED)
    lines = [Line("speed [m/s]", table["v"]), Line("yaw rate [rad/s]", table["omega"])]
    wheels = {w: w for w in axle.WHEELS}
    draw(table, wheels, ("middle of the axle", lines), found, folder / "axle.png", (exact["X"], exact["Y"]))
    write_table(table, folder / "axle.csv")
    ssp.build(axle.system(fmus, scene, min(h, 0.0005)), folder)
    return [f"Largest departure from the rigid axle in closed form: {100 * off:.2g} % of the range."]


def run_car(fmus: dict[str, Path], arguments: list[str], folder: Path) -> list[str]:
    """The car: a manoeuvre, with v, s, stop or any parameter of chassis.fmu and driver.fmu changed."""
    chassis, driver = parameters(fmus["chassis"]), parameters(fmus["driver"])
    words = {"manoeuvre": tuple(car.MANOEUVRES), "exchange": EXCHANGES}
    given = read(arguments, words, chassis | driver | {"h", "v", "stop"})
    manoeuvre = car.MANOEUVRES[given.pop("manoeuvre", "lane")]
    exchange, h = given.pop("exchange", "derivatives"), given.pop("h", 0.001)
    own = {name: given.pop(name) for name in ("v", "s", "stop") if name in given}
    manoeuvre = replace(
        manoeuvre,
        chassis={**manoeuvre.chassis, **{n: x for n, x in given.items() if n in chassis}},
        driver={**manoeuvre.driver, **{n: x for n, x in given.items() if n in driver}},
        **own,
    )
    run = car.drive(fmus, manoeuvre, h, exchange, round(0.02 / h) * h, progress=True)
    found = None if run.ending else errors(_in_c(fmus, manoeuvre), car.COMPARED)
    degrees = [Line(name, np.degrees(run.table[name])) for name in ("delta", "roll", "pitch")]
    names = {w: str(wheel["name"]) for w, wheel in car.WHEELS.items()}
    draw(run.table, names, ("angle [deg]", degrees), found, folder / "car.png")
    write_table(run.table, folder / "car.csv")
    ssp.build(car.system(fmus, manoeuvre, min(h, 0.0005)), folder)
    return [*([run.ending] if run.ending else []), *car.report(run.table, manoeuvre)]


def _in_c(fmus: dict[str, Path], manoeuvre: car.Manoeuvre) -> Callable[[float, str], Table]:
    def run(step: float, exchange: str) -> Table:
        done, _ = car.drive_in_c(fmus, manoeuvre, step, exchange, 0.05)
        if done.ending:
            raise Ended("car", float(done.table["time"][-1]), done.ending)
        return done.table

    return run


def run_suspended(fmus: dict[str, Path], arguments: list[str], folder: Path) -> list[str]:
    """The suspended wheel, with any parameter of quarter_car.fmu changed; k and c are those along X and Y."""
    given = read(arguments, {"exchange": EXCHANGES}, parameters(fmus["quarter_car"]) | {"h", "stop", "k", "c"})
    exchange, h, stop = given.pop("exchange", "derivatives"), given.pop("h", 0.001), given.pop("stop", suspended.STOP)
    given = {{"k": "k_h", "c": "c_h"}.get(name, name): value for name, value in given.items()}
    table = suspended.coupled(fmus, h, exchange, stop, round(0.01 / h) * h, given, progress=True)
    found = suspended.convergence(fmus, suspended.together(), suspended.STEPS[:3])
    figures.draw_launch(table, found, folder / "suspended.png")
    write_table(table, folder / "suspended.csv")
    ssp.build(suspended.system(fmus, given, h), folder)
    lines = [f"Speed at the end: {-0.35 * table['omega_z'][-1]:.4f} m/s; smallest N: {table['lambda_3'].min():.1f} N."]
    return [*lines, "The errors in the figure are those for the default parameters."] if given else lines


def run_balance(fmus: dict[str, Path], arguments: list[str], folder: Path) -> list[str]:
    """The balanced wheel, with any parameter of balance.fmu changed."""
    given = read(arguments, {}, parameters(fmus["balance"]))
    drive = driven.run(fmus, given)
    figures.draw_drive(drive, folder / "balance.png")
    write_table({n: drive.controlled[n] for n in drive.controlled.dtype.names}, folder / "balance.csv")
    ssp.build(driven.system(fmus, given), folder)
    verdict = driven.judge(drive)
    return [
        f"Alone it falls after {verdict.fall:.2f} s; controlled it drives a circle of {verdict.circle_radius:.4f} m."
    ]


EXAMPLES = {"axle": run_axle, "car": run_car, "suspended": run_suspended, "balance": run_balance}
PARTS = {
    "axle": ("wheel", "axle"),
    "car": ("wheel", "chassis", "driver"),
    "suspended": ("wheel", "quarter_car"),
    "balance": ("wheel", "balance"),
}


def main() -> int:
    """One example."""
    name, *arguments = sys.argv[1:] or [""]
    if name not in EXAMPLES:
        print(f"Usage: ./scripts/example {'|'.join(EXAMPLES)} [parameter=value ...]")
        print(*(f"  {run.__doc__}" for run in EXAMPLES.values()), sep="\n")
        print("./scripts/example NAME --help lists the parameters of one example.")
        return 0 if name in ("-h", "--help") else 2
    fmus, folder = build.build_all(build.ROOT / "build" / "examples"), RESULTS / name
    folder.mkdir(parents=True, exist_ok=True)
    try:
        said = EXAMPLES[name](fmus, arguments, folder)
    except Asked as options:
        print(EXAMPLES[name].__doc__, options, sep="\n")
        return 0
    except (Refused, Ended, ValueError) as reason:
        print(reason, file=sys.stderr)
        return 1
    for part in PARTS[name]:
        shutil.copyfile(fmus[part], folder / f"{part}.fmu")
    for sentence in said:
        print(sentence)
    print(f"In {folder.relative_to(build.ROOT)}: {', '.join(sorted(p.name for p in folder.iterdir()))}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
