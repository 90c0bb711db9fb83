"""./scripts/example NAME [parameter=value ...]: builds the FMUs, runs the example, draws it, packs it.

All output goes to results/examples/NAME/: the table, the picture, the FMUs and the SSP package. options.py checks the
command line before anything else. The exit status is 0 for a run that is the manoeuvre it was to be.
"""

import shutil
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from wheelfmu.fmu.outputs import new_folder

from . import balance, car, options, suspended
from .car_judges import demand, per_axle
from .drawing import draw
from .options import Manoeuvre
from .vehicle import DRY_ROAD, ROOT, Fmus, Run, build_all

RESULTS = ROOT / "results" / "examples"
VEHICLES = {of.name: of for of in (car.CAR, suspended.SUSPENDED, balance.BALANCE)}
PER_PICTURE = 600  # rows, about


def diverged(fmus: Fmus, asked: Manoeuvre, run: Run) -> str:
    """Whether an ending, or a friction that no road has, comes from the coupling: with a much shorter step it comes
    elsewhere, or not at all."""
    of, h = VEHICLES[asked.vehicle], min(asked.h / 4, max(asked.h / 16, 1e-4))  # s, which is short for every link here
    end = run.ending.time if run.ending else asked.stop
    again = of.drive(fmus, asked.changed(stop=min(asked.stop, 1.1 * end + 10 * asked.h)), h, asked.exchange, asked.h)
    other = again.ending.time if again.ending else asked.stop
    alike = bool(run.ending) == bool(again.ending) and abs(other - end) < 2 * asked.h + 0.02 * end
    if alike and (run.ending or of.grip(again.table) > DRY_ROAD):
        return ""
    instead = f"ends at t = {other:.3f} s" if again.ending else f"goes on and requires {of.grip(again.table):.2f}"
    cause = f"The likely cause is the communication step h = {1000 * asked.h:g} ms: the coupling diverges numerically"
    return f"{cause} (a run with {1000 * h:g} ms {instead}). Choose a shorter step: docs/vehicle.md."


def judged(fmus: Fmus, asked: Manoeuvre, run: Run) -> tuple[bool, list[str]]:
    """Whether the run is the manoeuvre, and why."""
    of = VEHICLES[asked.vehicle]
    if not run.ending:
        passed, lines = of.verdict(run.table, asked)
        cause = diverged(fmus, asked, run) if of.grip(run.table) > DRY_ROAD else ""
        return passed, [*lines, *filter(None, [cause])]
    how, cause = of.describe(run.ending), diverged(fmus, asked, run)
    if not cause and "lifts_off" in asked.ends and "lifted off" in how:
        return True, [f"As intended: {how}"]
    if not cause and asked["mu_max"] and of is car.CAR:
        cause = f"Until then the axles, their wheels together, required: {per_axle(demand(run.table))}."
    return False, [f"Failed: {how}", *filter(None, [cause])]


def example(fmus: Fmus, asked: Manoeuvre, folder: Path) -> bool:
    """One example: run, table, picture and package, verdict."""
    of, name = VEHICLES[asked.vehicle], asked.vehicle
    grid = asked.grid or max(1, round(asked.stop / PER_PICTURE / asked.h)) * asked.h
    run = of.drive(fmus, asked, asked.h, asked.exchange, grid, progress=True)
    if run.ending:  # early, perhaps within the first rows: more of them, the last where all FMUs reach one instant
        before = asked.changed(stop=run.ending.time * (1 - 1e-9))
        again = of.drive(fmus, before, asked.h, asked.exchange, before.stop / PER_PICTURE)
        run = replace(run, table=again.table)
    passed, lines = judged(fmus, asked, run)
    print(f"{asked.called[0].upper()}{asked.called[1:]}.", *lines, sep="\n")
    table = {n: x for n, x in run.table.items() if not n.startswith("alone.")}
    rows, head = np.column_stack(list(table.values())), ",".join(table)
    np.savetxt(folder / f"{name}.csv", rows, "%.9g", delimiter=",", header=head, comments="")
    if len(rows):
        draw(of, asked, run.table, folder / f"{name}.png", of.remark(run.ending))
    of.package(fmus, asked, min(asked.h, 0.0005) if "waits" in options.file(name) else asked.h, folder)
    for part in ("wheel", *options.file(name)["models"]):
        shutil.copyfile(fmus[part], folder / f"{part}.fmu")
    return passed


def main(words: list[str]) -> int:
    """One example."""
    try:
        asked = options.asked(*words)
        fmus, folder = build_all(), RESULTS / asked.vehicle
        folder.mkdir(parents=True, exist_ok=True)
        with new_folder(folder) as new:
            passed = example(fmus, asked, new)
            (folder / f"{asked.vehicle}.png").unlink(missing_ok=True)  # a run without rows has none
            for file in new.iterdir():
                file.replace(folder / file.name)
    except ValueError as reason:
        print(reason, file=sys.stderr)
        return 1
    print(f"In results/examples/{folder.name}: {', '.join(sorted(p.name for p in folder.iterdir()))}.")
    return not passed
