"""A run drawn as its manoeuvre declares it: the path from above with the wheels, and panels over time."""

from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from wheelfmu.diagrams import style

from .options import Manoeuvre, file
from .vehicle import Table, Vehicle

COLOURS = (style.BLUE, style.VERMILLION, style.SKY, style.ORANGE, style.PURPLE, style.GREY)
DASHES = ("-", "--", ":", "-.")  # a curve that has the values of the one before is seen through its gaps
SCALES = {"deg": 180 / np.pi, "deg/s": 180 / np.pi, "km/h": 3.6, "kN": 1e-3, "mm": 1e3}  # of a label's unit
LEAST = 1e-3  # of a label's unit: what differs by less is a line, not its rounding
ABOVE = {"loc": "lower left", "bbox_to_anchor": (0, 0.98)}  # the axes


def draw(vehicle: Vehicle, manoeuvre: Manoeuvre, table: Table, path: Path, remark: str = "") -> Path:
    """The manoeuvre's plot: "path", and panels [label [unit], column...]; *.NAME is a column per wheel, %.NAME per
    axle, "NAME: TEXT" a column with its text."""
    style.use_style()
    panels = {n: panel for n, panel in enumerate(manoeuvre.plot) if panel != "path"}
    cells = [*panels, "."]
    rows = [*([["path"] * 2] if len(panels) < len(manoeuvre.plot) else []), *zip(cells[::2], cells[1::2], strict=False)]
    fig = style.figure_mm(style.PAGE, 6 + 50 * len(rows))
    fig.set_layout_engine("constrained", h_pad=0.06, wspace=0.06)
    title = f"{manoeuvre.vehicle.capitalize()}: {manoeuvre.called}{vehicle.subtitle(manoeuvre)}{remark}"
    fig.suptitle(title, fontsize=9)
    for cell, ax in fig.subplot_mosaic([list(row) for row in rows]).items():
        if cell == "path":
            draw_path(ax, table, vehicle.wheels, file(vehicle.name).get("tracks", {}))
        else:
            draw_panel(ax, table, *panels[cell], names=vehicle.wheels)
    return style.save_png(fig, path)


def draw_panel(ax: Axes, table: Table, label: str, *wanted: str, names: dict[str, str]) -> None:
    """Curves over time; the unit at the label's end scales them."""
    scale = SCALES.get(label.split("[")[-1].rstrip("]"), 1.0)
    axles = [name.removesuffix(".mu") for name in table if name.endswith(".mu")]
    known, curves = {"*": names, "%": {axle: f"{axle} axle" for axle in axles}}, {}
    for column, _, text in (entry.partition(": ") for entry in wanted):
        first, _, name = column.partition(".")
        curves |= {f"{key}.{name}": of for key, of in known.get(first, {}).items()} or {column: text or column}
    for (column, text), colour, dashes in zip(curves.items(), cycle(COLOURS), cycle(DASHES), strict=False):
        if column in table:
            ax.plot(table["time"], scale * table[column], color=colour, linestyle=dashes, label=text)
    if len(ax.lines) > 1:
        ax.legend(**ABOVE, ncols=4, borderaxespad=0.2, columnspacing=0.8, handlelength=1.5)
    ax.ticklabel_format(axis="y", useOffset=False, style="plain")  # else a power of ten stands over the legend
    low, high = ax.dataLim.intervaly
    if high - low < LEAST:
        ax.set_ylim((low + high) / 2 - LEAST, (low + high) / 2 + LEAST)
    ax.set(xlabel="time [s]", ylabel=label)


def draw_path(ax: Axes, table: Table, names: dict[str, str], tracks: dict[str, tuple[str, ...]]) -> None:
    """Tracks of the wheels' centres, and the wheels themselves a few times, 0.7 m long, along their headings. A path
    that would be a thin strip is stretched across, and the label names the factor."""
    at = np.unique(np.linspace(0, len(table["time"]) - 1, 9).astype(int))
    for wheel in names:
        x, y, psi = (table[f"{wheel}.{name}"][at] for name in ("X_O", "Y_O", "psi"))
        centre, half = np.stack([x, y]), 0.35 * np.stack([np.cos(psi), np.sin(psi)])
        ends = np.stack([centre - half, centre + half])  # (end, axis, instant)
        ax.plot(ends[:, 0], ends[:, 1], color=style.INK, linewidth=1.6, alpha=0.45, zorder=1, solid_capstyle="round")
    columns = {text: (f"{wheel}.X_O", f"{wheel}.Y_O") for wheel, text in names.items()} | tracks
    paths = {text: (table[x], table[y]) for text, (x, y) in columns.items() if x in table}
    for (text, (x, y)), colour, dashes in zip(paths.items(), cycle(COLOURS), cycle(DASHES[:2]), strict=False):
        ax.plot(x, y, color=colour, linewidth=0.9, linestyle=dashes, label=text, zorder=2)
    along, across = (max(float(np.nanmax(v) - np.nanmin(v)), 0.1) for v in np.hstack(list(paths.values())))
    stretch = (42 / across) / (162 / along)
    if stretch > 2.5:
        ax.margins(0.02, 0.08)
    else:
        ax.set_aspect("equal", adjustable="datalim")
    ax.legend(**ABOVE, ncols=6, borderaxespad=0.2)
    ax.set(xlabel="X [m]", ylabel=f"Y [m], stretched {stretch:.0f} times" if stretch > 2.5 else "Y [m]")
