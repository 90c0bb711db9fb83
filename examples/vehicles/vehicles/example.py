"""./scripts/example NAME [parameter=value ...]: builds the FMUs, runs the example, draws it, packs it.

All output goes to results/examples/NAME/: the table, the picture, the FMUs and the SSP package. options.py checks the
command line before anything else. The exit status is 0 for a run that is the manoeuvre it was to be.
"""

from __future__ import annotations

import shutil
import signal
import sys
from pathlib import Path


def interrupted(*_: object) -> None:
    """Ctrl-C: nothing has been written yet, or all of it."""
    print("\nInterrupted.", file=sys.stderr)
    sys.exit(130)


if __name__ == "__main__":  # also while the packages below are loaded
    signal.signal(signal.SIGINT, interrupted)

import numpy as np  # noqa: E402

from . import axle, build, car, car_iso, car_judges, driven, options, ssp, suspended  # noqa: E402
from .component import sentence  # noqa: E402
from .drawing import Errors, Table, draw  # noqa: E402
from .master import Run  # noqa: E402

RESULTS = build.ROOT / "results" / "examples"
VEHICLES = {"axle": axle, "car": car, "suspended": suspended, "balance": driven}
PER_PICTURE = 600  # rows, about
SHORT = 1e-4  # s, a step that is short for every link here


def write_table(table: Table, path: Path) -> None:
    """CSV with one column per signal."""
    np.savetxt(
        path, np.column_stack(list(table.values())), delimiter=",", header=",".join(table), comments="", fmt="%.9g"
    )


def picture(
    table: Table, manoeuvre: options.Manoeuvre, path: Path, remark: str = "", errors: Errors | None = None
) -> Path:
    """The run drawn as its manoeuvre declares it."""
    vehicle = manoeuvre.vehicle
    of = VEHICLES[vehicle]
    names = getattr(of, "NAMES", of.WHEELS)
    title = car.title(manoeuvre) if vehicle == "car" else f"{vehicle.capitalize()}: {manoeuvre.title}"
    tracks = of.tracks(table) if "path" in manoeuvre.plot else {}
    return draw(manoeuvre, table, names, tracks, path, title + remark, errors)


def findings(table: Table, manoeuvre: options.Manoeuvre) -> list[str]:
    """Characteristic values of the car's manoeuvre, beside those of rigid links where these are known."""
    with np.errstate(all="ignore"):
        try:
            figures = car_iso.FIGURES[manoeuvre.figures](table) if manoeuvre.figures else []
            found = [*car_judges.judge(table, manoeuvre), *figures]
        except (ValueError, IndexError, TypeError, np.linalg.LinAlgError):
            return ["The closed forms do not apply to these parameters."]
    lines = []
    for f in found:
        unit, exact = f.unit if f.unit != "1" else "", "" if f.exact is None else f"(closed form: {f.exact:.4g})"
        lines.append("  " + " ".join(filter(None, (f"{f.what}: {f.measured:.4g}", unit, exact))))
    return lines


def diverged(fmus: dict[str, Path], asked: options.Asked, run: Run) -> str:
    """Whether an ending comes from the coupling: with a much shorter step it comes elsewhere, or not at all."""
    end, h = run.ending.time, min(asked.h / 4, max(asked.h / 16, SHORT))
    beyond = asked.manoeuvre.changed(stop=min(asked.manoeuvre.stop, 1.1 * end + 10 * asked.h))
    again = VEHICLES[asked.vehicle].run(fmus, beyond, h, asked.exchange, end).ending
    if again and abs(again.time - end) < 2 * asked.h + 0.02 * end:
        return ""
    instead = f"ends at t = {again.time:.3f} s" if again else "goes on"
    cause = f"The likely cause is the communication step h = {1000 * asked.h:g} ms: the coupling diverges numerically"
    return f"{cause} (a run with {1000 * h:g} ms {instead}). Choose a shorter step: docs/vehicle.md."


def judged(fmus: dict[str, Path], asked: options.Asked, run: Run) -> tuple[bool, list[str]]:
    """Whether the run is the manoeuvre, and why."""
    of, manoeuvre = VEHICLES[asked.vehicle], asked.manoeuvre
    if not run.ending:
        passed, lines = of.verdict(run.table, manoeuvre)
        return passed, [*lines, *(findings(run.table, manoeuvre) if passed and of is car else [])]
    said = sentence(run.ending, getattr(of, "NAMES", of.WHEELS))
    if cause := diverged(fmus, asked, run):
        return False, [f"Failed: {said}", cause]
    if "lifts_off" in manoeuvre.ends and "lifted off" in said:
        return True, [f"As intended: {said}"]
    lines = [f"Failed: {said}"]
    if manoeuvre["mu_max"] and of is car:
        each = ", ".join(f"{axle} {mu:.2f}" for axle, mu in car.demand(run.table).items())
        lines.append(f"Until then the axles, their wheels together, required: {each}.")
    return False, lines


def example(fmus: dict[str, Path], asked: options.Asked, folder: Path) -> bool:
    """One example: run, table, picture and package, verdict."""
    of, manoeuvre = VEHICLES[asked.vehicle], asked.manoeuvre
    grid = max(1, round(manoeuvre.stop / PER_PICTURE / asked.h)) * asked.h
    run = of.run(fmus, manoeuvre, asked.h, asked.exchange, grid, progress=True)
    if run.ending:  # early, perhaps within the first rows
        run = of.run(fmus, manoeuvre, asked.h, asked.exchange, run.ending.time / PER_PICTURE)
    complete = getattr(of, "complete", None)
    table = complete(run.table, manoeuvre) if complete else run.table
    run = Run(table, run.ending, run.cost)
    passed, lines = judged(fmus, asked, run)
    print(f"{manoeuvre.title[0].upper()}{manoeuvre.title[1:]}.", *lines, sep="\n")
    write_table({n: x for n, x in table.items() if not n.startswith("alone.")}, folder / f"{asked.vehicle}.csv")
    remark = f"; ended at {run.ending.time:.2f} s" if run.ending else ""
    if len(table["time"]):
        picture(table, manoeuvre, folder / f"{asked.vehicle}.png", remark)
    step = asked.h if of in (suspended, driven) else min(asked.h, 0.0005)
    ssp.build(of.package(fmus, manoeuvre, step), folder)
    for part in ("wheel", *options.file(asked.vehicle)["models"]):
        shutil.copyfile(fmus[part], folder / f"{part}.fmu")
    return passed


def main() -> int:
    """One example."""
    try:
        asked = options.asked(sys.argv[1:])
        fmus, folder = build.build_all(build.ROOT / "build" / "examples"), RESULTS / asked.vehicle
        shutil.rmtree(folder, ignore_errors=True)  # an earlier run's
        folder.mkdir(parents=True)
        passed = example(fmus, asked, folder)
    except ValueError as reason:
        print(reason, file=sys.stderr)
        return 1
    print(f"In {folder.relative_to(build.ROOT)}: {', '.join(sorted(p.name for p in folder.iterdir()))}.")
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
