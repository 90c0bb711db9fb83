"""./scripts/example: drives the car through a manoeuvre, or the quarter car, prints closed forms and draws."""

import shutil
import sys
from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wheelfmu.diagrams import style
from wheelfmu.fmu.paths import ROOT

from . import judges
from .car import BUILT, Table, build_all, drive, recorded
from .manoeuvres import J_Z, M_WHEEL, MANOEUVRES, WHEELS, G, R, presets, system
from .master import Ended

RESULTS = ROOT / "results" / "examples"
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
# Of the quarter car.
RECORD = {"wheel": ("X_O_dot", "omega_z", "lambda_3", "mu_required"), "quarter_car": ("X_B_dot", "Z_B", "F_X", "M_3")}
PANELS_OF_ONE = {
    "speed [m/s]": (1, ["X_O_dot", "X_B_dot"]),
    "force [kN]": (1e-3, ["F_X", "lambda_3"]),
    "torque [N m]": (1, ["M_3"]),
    "friction required": (1, ["mu_required"]),
}


def draw(title: str, table: Table) -> Figure:
    """Tracks of the car's wheels from above, and the panels over time."""
    fig = figure(f"Car: {title}", 186)
    grid = fig.add_gridspec(4, 2)
    track = fig.add_subplot(grid[0, :])
    for wheel, (colour, dashes) in zip(WHEELS, STYLES, strict=True):
        track.plot(table[f"{wheel}.X_O"], table[f"{wheel}.Y_O"], color=colour, linestyle=dashes, label=wheel)
    track.set(xlabel="X [m]", ylabel="Y [m]")
    legend(track)
    draw_panels([fig.add_subplot(grid[1 + k // 2, k % 2]) for k in range(len(PANELS))], PANELS, table)
    return fig


def figure(title: str, height: float) -> Figure:
    """Height in mm."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, height)
    fig.set_layout_engine("constrained", h_pad=0.06, wspace=0.06)
    fig.suptitle(title, fontsize=9)
    return fig


def legend(ax: Axes) -> None:
    ax.legend(loc="lower left", bbox_to_anchor=(0, 0.98), ncols=4, borderaxespad=0.2)


def draw_panels(axes: Iterable[Axes], panels: dict[str, tuple[float, list[str]]], table: Table) -> None:
    for ax, (label, (factor, columns)) in zip(axes, panels.items(), strict=True):
        for name, (colour, dashes) in zip(columns, STYLES, strict=False):
            ax.plot(table["time"], factor * table[name], color=colour, linestyle=dashes, label=name.split(".")[0])
        ax.ticklabel_format(axis="y", useOffset=False, style="plain")
        ax.set(xlabel="time [s]", ylabel=label)
        if len(columns) > 1:
            legend(ax)


def leave(name: str, of: str, table: Table, fig: Figure) -> None:
    """Table, picture, package and FMUs in results/examples/."""
    folder, model = RESULTS / name, system(of)["fmus"]
    folder.mkdir(parents=True, exist_ok=True)
    rows, head = np.column_stack(list(table.values())), ",".join(table)
    np.savetxt(folder / f"{name}.csv", rows, "%.9g", delimiter=",", header=head, comments="")
    style.save_png(fig, folder / f"{name}.png")
    shutil.copyfile(BUILT / f"{of}.ssp", folder / f"{of}.ssp")
    for one in {*model.values()} - {"wheel"}:
        shutil.copyfile(BUILT / f"{one}.fmu", folder / f"{one}.fmu")
    print(f"In results/examples/{name}: {', '.join(sorted(path.name for path in folder.iterdir()))}.")


def drive_car(manoeuvre: str) -> None:
    """A manoeuvre of the car."""
    run = MANOEUVRES[manoeuvre]
    table = drive(build_all(), run, grid=GRID, progress=True)
    print(f"{run.title.capitalize()}.", *judges.judge(manoeuvre, table, run), sep="\n")
    leave("car", "car", table, draw(run.title, table))


def launch_quarter_car() -> None:
    """The quarter car's launch from rest by its hub motor: (m + J_z / R^2) a = (M_drive - s m g) / R."""
    of = system("quarter_car")
    table = recorded(build_all(), of, RECORD, "derivatives", 0.0, progress=True)
    late, m = table["time"] > of["stop"] - 0.5, presets("quarter_car")["m_B"] + M_WHEEL
    measured = float(np.polyfit(table["time"][late], table["X_B_dot"][late], 1)[0])
    a = (-of["start"]["quarter_car"]["M_drive"] - of["start"]["wheel"]["s"] * m * G) / R / (m + J_Z / R**2)
    title = "launch from rest by the hub motor"
    print(f"{title.capitalize()}.", judges.Finding("acceleration of the launch", "m/s2", measured, a), sep="\n")
    fig = figure(f"Quarter car: {title}", 96)
    draw_panels(fig.subplots(2, 2).flat, PANELS_OF_ONE, table)
    leave("suspended", "quarter_car", table, fig)


def main(name: str, manoeuvre: str = "") -> int:
    """Exit status 1: an FMU ended the run."""
    try:
        if name == "suspended":
            launch_quarter_car()
        else:
            drive_car(manoeuvre)
    except Ended as end:
        print(f"{end.component} ended the run at t = {end.time:.3f} s: {end.message}", file=sys.stderr)
        return 1
    return 0
