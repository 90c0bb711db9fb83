"""./scripts/example NAME [parameter=value ...]: builds the FMUs, runs the example, draws it, packs it.

All that is written goes to results/examples/NAME/: the table, the figure, the FMUs and the SSP package. What the
command line may say is in options.py, which is asked first.
"""

from __future__ import annotations

import shutil
import signal
import sys
from dataclasses import fields, replace
from pathlib import Path


def interrupted(*_: object) -> None:
    """Ctrl-C: nothing has been written yet, or all of it."""
    print("\nInterrupted.", file=sys.stderr)
    sys.exit(130)


if __name__ == "__main__":  # also while the packages below are loaded
    signal.signal(signal.SIGINT, interrupted)

import numpy as np  # noqa: E402

from . import axle, axle_study, build, car, driven, errors, figures, options, ssp, suspended  # noqa: E402
from .component import Ended  # noqa: E402
from .drawing import Line, draw  # noqa: E402

RESULTS = build.ROOT / "results" / "examples"
Table = dict[str, np.ndarray]
Values = options.Values


def write_table(table: Table, path: Path) -> None:
    """CSV with one column per signal."""
    np.savetxt(
        path, np.column_stack(list(table.values())), delimiter=",", header=",".join(table), comments="", fmt="%.9g"
    )


def multiple(h: float, grid: float) -> float:
    """The multiple of the step nearest to a grid."""
    return max(1, round(grid / h)) * h


def run_axle(fmus: dict[str, Path], given: Values, folder: Path) -> list[str]:
    """The axle: a scene of axle_study.SCENES, with numbers of axle.Scene or parameters of axle.fmu changed."""
    own = {f.name for f in fields(axle.Scene)} - {"more"}
    name = given.pop("scene", "trailing")
    scene, exchange, h = axle_study.SCENES[name], given.pop("exchange", "derivatives"), given.pop("h", 0.001)
    more = {name: value for name, value in given.items() if name not in own}
    scene = replace(scene, more=more, **{name: value for name, value in given.items() if name in own})
    table = axle.coupled(fmus, scene, h, exchange, multiple(h, 0.02), progress=True)
    short = replace(scene, stop=min(scene.stop, 2.0))
    found = errors.of_masters(lambda step, how: axle.coupled(fmus, short, step, how, 0.02), axle.COMPARED)
    exact = None if axle.without_closed_form(scene) else axle.rigid(scene, table["time"])
    draw_axle(table, exact, found, folder / "axle.png", f"Axle: {name}, step {1000 * h:g} ms")
    write_table(table, folder / "axle.csv")
    ssp.build(axle.system(fmus, scene, min(h, 0.0005)), folder)
    if not exact:
        return [f"No closed form to compare with: {axle.without_closed_form(scene)}."]
    off = axle_study.distance(table, exact)
    return [f"Largest departure from the rigid axle in closed form: {100 * off:.2g} % of the range."]


def draw_axle(table: Table, exact: Table | None, found: errors.Errors | None, path: Path, title: str) -> None:
    lines = [Line("speed [m/s]", table["v"]), Line("yaw rate [rad/s]", table["omega"])]
    closed = (exact["X"], exact["Y"]) if exact else None
    draw(table, {w: w for w in axle.WHEELS}, ("middle of the axle", lines), found, path, title, closed)


def run_car(fmus: dict[str, Path], given: Values, folder: Path) -> list[str]:
    """The car: a manoeuvre, with v, s, stop or any parameter of chassis.fmu and driver.fmu changed."""
    manoeuvre = car.MANOEUVRES[given.pop("manoeuvre", "lane")]
    exchange, h = given.pop("exchange", "derivatives"), given.pop("h", 0.001)
    own = {name: given.pop(name) for name in ("v", "s", "stop", "slope", "slope_direction") if name in given}
    of_driver = {n: x for n, x in given.items() if n in options.parameters("driver")}
    of_chassis = {n: x for n, x in given.items() if n not in of_driver}
    manoeuvre = replace(
        manoeuvre,
        chassis={**manoeuvre.chassis, **of_chassis},
        driver={**manoeuvre.driver, **of_driver},
        **own,
    )
    run = car.drive(fmus, manoeuvre, h, exchange, multiple(h, 0.02), progress=True)
    found = None
    if not run.ending:
        found = errors.of_masters(lambda step, how: car.whole(fmus, manoeuvre, step, how, 0.05), car.COMPARED)
    draw_car(run, manoeuvre, found, folder / "car.png")
    write_table(run.table, folder / "car.csv")
    ssp.build(car.system(fmus, manoeuvre, min(h, 0.0005)), folder)
    return car.verdict(run, manoeuvre)


def draw_car(run: car.Run, manoeuvre: car.Manoeuvre, found: errors.Errors | None, path: Path) -> None:
    degrees = [Line(name, np.degrees(run.table[name])) for name in ("delta", "roll", "pitch")]
    draw(run.table, car.NAMES, ("angle [deg]", degrees), found, path, car.title(run, manoeuvre))


def run_suspended(fmus: dict[str, Path], given: Values, folder: Path) -> list[str]:
    """The suspended wheel, with any parameter of quarter_car.fmu changed; k and c are those along X and Y."""
    exchange, h, stop = given.pop("exchange", "derivatives"), given.pop("h", 0.001), given.pop("stop", suspended.STOP)
    given = {{"k": "k_h", "c": "c_h"}.get(name, name): value for name, value in given.items()}
    table = suspended.coupled(fmus, h, exchange, stop, multiple(h, 0.01), given, progress=True)
    found = suspended.convergence(fmus, suspended.together(), suspended.STEPS[:3])
    figures.draw_launch(table, found, folder / "suspended.png")
    write_table(table, folder / "suspended.csv")
    ssp.build(suspended.system(fmus, given, h), folder)
    lines = [f"Speed at the end: {-0.35 * table['omega_z'][-1]:.4f} m/s; smallest N: {table['lambda_3'].min():.1f} N."]
    return [*lines, "The errors in the figure are those for the default parameters."] if given else lines


def run_balance(fmus: dict[str, Path], given: Values, folder: Path) -> list[str]:
    """The balanced wheel, with any parameter of balance.fmu changed."""
    drive = driven.run(fmus, given)
    figures.draw_drive(drive, folder / "balance.png")
    write_table({n: drive.controlled[n] for n in drive.controlled.dtype.names}, folder / "balance.csv")
    ssp.build(driven.system(fmus, given), folder)
    return driven.verdict(drive, given.get("R", driven.RADIUS))


RUNS = {"axle": run_axle, "car": run_car, "suspended": run_suspended, "balance": run_balance}


def main() -> int:
    """One example."""
    try:
        name, given = options.asked(sys.argv[1:])
        fmus, folder = build.build_all(build.ROOT / "build" / "examples"), RESULTS / name
        shutil.rmtree(folder, ignore_errors=True)  # what an earlier run left
        folder.mkdir(parents=True)
        said = RUNS[name](fmus, given, folder)
    except (options.Refused, ValueError) as reason:
        print(reason, file=sys.stderr)
        return 1
    except Ended as ending:
        print(f"The run ended at t = {ending.time:.3f} s, by {ending.component}: {ending.sentence}", file=sys.stderr)
        return 1
    for part in ("wheel", *options.LIST[name].models):
        shutil.copyfile(fmus[part], folder / f"{part}.fmu")
    for sentence in said:
        print(sentence)
    print(f"In {folder.relative_to(build.ROOT)}: {', '.join(sorted(p.name for p in folder.iterdir()))}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
