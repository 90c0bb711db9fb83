"""./scripts/example NAME [parameter=value ...]: builds the FMUs, runs a manoeuvre, compares it with closed forms, draws
and packs it into results/examples/NAME/. The exit status is 0 where the run reaches its end and each closed form holds.
"""

import runpy
import shutil
import sys
from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from wheelfmu.diagrams import style
from wheelfmu.fmu.outputs import new_folder
from wheelfmu.fmu.paths import ROOT

from . import judges, options
from .options import EXAMPLES, VEHICLES, Manoeuvre
from .vehicle import Fmus, Run, Table, build_all, drive, wheels

RESULTS = ROOT / "results" / "examples"
PER_PICTURE = 600  # rows, about
SCALES = {"deg": 180 / np.pi, "deg/s": 180 / np.pi, "km/h": 3.6, "kN": 1e-3}  # of a label's unit
COLOURS = (style.BLUE, style.VERMILLION, style.SKY, style.ORANGE)
DASHES = ("-", "--", ":", "-.")  # a curve that has the values of the one before is seen through its gaps


def draw(run: Manoeuvre, table: Table, path: Path) -> Path:
    """The path from above, where the run turns, and the panels of the vehicle over time."""
    style.use_style()
    panels, names = VEHICLES[run.vehicle]["plot"], wheels(run.vehicle)
    rows = (len(panels) + 1) // 2 + (turns := run.vehicle == "car" and bool(np.ptp(table["Y"]) > 0.1))
    fig = style.figure_mm(style.PAGE, 6 + 45 * rows)
    fig.set_layout_engine("constrained", h_pad=0.06, wspace=0.06)
    fig.suptitle(f"{run.vehicle.capitalize()}: {run.title}", fontsize=9)
    grid = fig.add_gridspec(rows, 2)
    if turns:
        draw_path(fig.add_subplot(grid[0, :]), table, names)
    for cell, (label, *columns) in enumerate(panels, 2 * turns):
        draw_panel(fig.add_subplot(grid[cell // 2, cell % 2]), table, label, columns, names)
    return style.save_png(fig, path)


def draw_panel(ax: Axes, table: Table, label: str, columns: list[str], names: list[str]) -> None:
    """Curves over time; the unit at the label's end scales them."""
    scale = SCALES.get(label.split("[")[-1].rstrip("]"), 1.0)
    every = [column.replace("*", name) for column in columns for name in (names if "*" in column else [""])]
    for column, colour, dashes in zip(every, cycle(COLOURS), cycle(DASHES), strict=False):
        ax.plot(table["time"], scale * table[column], color=colour, linestyle=dashes, label=column.partition(".")[0])
    if len(every) > 1:
        ax.legend(loc="lower left", bbox_to_anchor=(0, 0.98), ncols=4, borderaxespad=0.2, handlelength=1.5)
    ax.ticklabel_format(axis="y", useOffset=False, style="plain")
    ax.set(xlabel="time [s]", ylabel=label)


def draw_path(ax: Axes, table: Table, names: list[str]) -> None:
    """Tracks of the wheels' centres, and the wheels' headings a few times."""
    for name, colour, dashes in zip(names, cycle(COLOURS), cycle(DASHES[:2]), strict=False):
        x, y, psi = (table[f"{name}.{of}"] for of in ("X_O", "Y_O", "psi"))
        ax.plot(x, y, color=colour, linewidth=0.9, linestyle=dashes, label=name)
        at = slice(None, None, max(1, len(x) // 8))
        how = {"angles": "xy", "color": style.INK, "width": 0.002, "alpha": 0.5}
        ax.quiver(x[at], y[at], np.cos(psi[at]), np.sin(psi[at]), **how)
    ax.legend(loc="lower left", bbox_to_anchor=(0, 0.98), ncols=4, borderaxespad=0.2)
    ax.set(xlabel="X [m]", ylabel="Y [m]")


def judged(asked: Manoeuvre, run: Run) -> tuple[bool, list[str]]:
    """Whether the run reached its end and its closed forms hold, in words."""
    if run.ending:
        end = run.ending
        return False, [f"Failed: {end.component} ended the run at t = {end.time:.3f} s: {end.message}"]
    found = judges.judge(run.table, asked)
    lines = [str(finding) for finding in found]
    if asked.vehicle == "car":
        needs = ", ".join(f"{axle} {mu:.2f}" for axle, mu in judges.demand(run.table).items())
        lines.append(f"Friction coefficient required by the axles: {needs}.")
    holds = all(finding.holds for finding in found)
    return holds, [*lines, *["Failed: a closed form does not hold."] * (not holds)]


def example(fmus: Fmus, asked: Manoeuvre, folder: Path) -> bool:
    """One example: run, table, picture, FMUs and package, verdict."""
    system, name = options.system(asked.vehicle), asked.vehicle
    grid = max(1, round(asked.stop / PER_PICTURE / asked.h)) * asked.h
    run = drive(fmus, asked, grid=grid, progress=True)
    passed, lines = judged(asked, run)
    print(f"{asked.title[0].upper()}{asked.title[1:]}.", *lines, sep="\n")
    rows, head = np.column_stack(list(run.table.values())), ",".join(run.table)
    np.savetxt(folder / f"{name}.csv", rows, "%.9g", delimiter=",", header=head, comments="")
    if len(rows) > 1:
        draw(asked, run.table, folder / f"{name}.png")
    package = runpy.run_path(str(EXAMPLES / "package.py"))
    of = system | {"start": asked.start(), "step": asked.h, "stop": asked.stop}
    package["write"](folder / f"{Path(VEHICLES[name]['system']).stem}.ssp", of, fmus)
    for model in sorted(set(system["fmus"].values())):
        shutil.copyfile(fmus[model], folder / f"{model}.fmu")
    return passed


def main(words: list[str]) -> int:
    """One example."""
    try:
        asked = options.asked(*words)
        fmus, folder = build_all(), RESULTS / asked.vehicle
        folder.mkdir(parents=True, exist_ok=True)
        with new_folder(folder) as new:
            passed = example(fmus, asked, new)
            for old in folder.glob(f"{asked.vehicle}.png"):  # a run without rows has none
                old.unlink()
            for file in new.iterdir():
                file.replace(folder / file.name)
    except ValueError as reason:
        print(reason, file=sys.stderr)
        return 1
    print(f"In results/examples/{folder.name}: {', '.join(sorted(p.name for p in folder.iterdir()))}.")
    return not passed
