"""./scripts/example NAME: drives the car through a manoeuvre, prints its closed forms and draws."""

import shutil
import sys

import numpy as np
from matplotlib.figure import Figure

from wheelfmu.diagrams import style
from wheelfmu.fmu.paths import ROOT

from . import judges
from .car import BUILT, Table, build_all, drive
from .manoeuvres import MANOEUVRES, WHEELS
from .master import Ended

RESULTS = ROOT / "results" / "examples" / "car"
GRID = 0.012  # s, of the table
STYLES = list(zip((style.BLUE, style.VERMILLION, style.SKY, style.ORANGE), ("-", "--", ":", "-."), strict=True))
PANELS = {  # label: factor, columns
    "speed [km/h]": (3.6, ["v"]),
    "angle [deg]": (180 / np.pi, ["delta", "roll", "pitch"]),
    "yaw rate [deg/s]": (180 / np.pi, ["omega"]),
    "torque [N m]": (1, ["M_drive", "M_brake"]),
    "normal force [kN]": (1e-3, [f"{wheel}.lambda_3" for wheel in WHEELS]),
    "lateral force [kN]": (1e-3, [f"{wheel}.lambda_y" for wheel in WHEELS]),
}


def draw(title: str, table: Table) -> Figure:
    """Tracks of the wheels from above, and the panels over time."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 186)
    fig.set_layout_engine("constrained", h_pad=0.06, wspace=0.06)
    fig.suptitle(f"Car: {title}", fontsize=9)
    grid = fig.add_gridspec(4, 2)
    track = fig.add_subplot(grid[0, :])
    for wheel, (colour, dashes) in zip(WHEELS, STYLES, strict=True):
        track.plot(table[f"{wheel}.X_O"], table[f"{wheel}.Y_O"], color=colour, linestyle=dashes, label=wheel)
    track.set(xlabel="X [m]", ylabel="Y [m]")
    panels = [fig.add_subplot(grid[1 + k // 2, k % 2]) for k in range(len(PANELS))]
    for panel, (label, (factor, columns)) in zip(panels, PANELS.items(), strict=True):
        for name, (colour, dashes) in zip(columns, STYLES, strict=False):
            panel.plot(table["time"], factor * table[name], color=colour, linestyle=dashes, label=name.split(".")[0])
        panel.ticklabel_format(axis="y", useOffset=False, style="plain")
        panel.set(xlabel="time [s]", ylabel=label)
    for panel in (track, *(panel for panel in panels if len(panel.lines) > 1)):
        panel.legend(loc="lower left", bbox_to_anchor=(0, 0.98), ncols=4, borderaxespad=0.2)
    return fig


def main(name: str) -> int:
    """Exit status 1: an FMU ended the run."""
    run = MANOEUVRES[name]
    try:
        table = drive(build_all(), run, grid=GRID, progress=True)
    except Ended as end:
        print(f"{end.component} ended the run at t = {end.time:.3f} s: {end.message}", file=sys.stderr)
        return 1
    print(f"{run.title.capitalize()}.", *judges.judge(name, table, run), sep="\n")
    RESULTS.mkdir(parents=True, exist_ok=True)
    rows, head = np.column_stack(list(table.values())), ",".join(table)
    np.savetxt(RESULTS / f"{name}.csv", rows, "%.9g", delimiter=",", header=head, comments="")
    style.save_png(draw(run.title, table), RESULTS / f"{name}.png")
    shutil.copyfile(BUILT / "car.ssp", RESULTS / "car.ssp")
    print(f"In results/examples/car: {name}.csv, {name}.png, car.ssp.")
    return 0
