"""A run drawn as its manoeuvre declares it: the path from above with the wheels, and panels over time; errors over the
step, for the reports."""

from itertools import cycle
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from diagrams import style

from .options import Manoeuvre, file
from .vehicle import Errors, Table, Vehicle

COLOURS = (style.BLUE, style.VERMILLION, style.SKY, style.ORANGE, style.PURPLE, style.GREY)
MARKS = {
    "positions held": ("d-", style.ORANGE, 1),
    "held": ("o-", style.VERMILLION, 1),
    "derivatives": ("s-", style.BLUE, 2),
    "rollback": ("^-", style.GREEN, None),
}  # look, colour, order
DASHES = ("-", "--", ":", "-.")  # a curve that has the values of the one before is seen through its gaps
GUIDES = {1: (0, (4, 2)), 2: (0, (1, 1))}  # lines of an order
SCALES = {"deg": 180 / np.pi, "deg/s": 180 / np.pi, "km/h": 3.6, "kN": 1e-3, "mm": 1e3}  # of a label's unit
LEAST = 1e-3  # of a label's unit: what differs by less is a line, not its rounding
ABOVE = {"loc": "lower left", "bbox_to_anchor": (0, 0.98)}  # the axes


def draw(
    vehicle: Vehicle, manoeuvre: Manoeuvre, table: Table, path: Path, remark: str = "", errors: Errors | None = None
) -> Path:
    """The manoeuvre's plot: "path", and panels [label [unit], column...]; *.NAME is a column per wheel, %.NAME per
    axle, "NAME: TEXT" a column with its text."""
    style.use_style()
    panels = {n: panel for n, panel in enumerate(manoeuvre.plot) if panel != "path"}
    cells = [*panels, *(["errors"] if errors else []), "."]
    rows = [*([["path"] * 2] if len(panels) < len(manoeuvre.plot) else []), *zip(cells[::2], cells[1::2], strict=False)]
    fig = style.figure_mm(style.PAGE, 6 + 50 * len(rows))
    fig.set_layout_engine("constrained", h_pad=0.06, wspace=0.06)
    title = f"{manoeuvre.vehicle.capitalize()}: {manoeuvre.called}{vehicle.subtitle(manoeuvre)}{remark}"
    fig.suptitle(title, fontsize=9)
    for cell, ax in fig.subplot_mosaic([list(row) for row in rows]).items():
        if cell == "path":
            draw_path(ax, table, vehicle.wheels, file(vehicle.name).get("tracks", {}))
        elif cell == "errors":
            draw_errors(ax, errors)
            ax.legend(**ABOVE, ncols=3)
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


def draw_orders(errors: dict[str, Errors], path: Path) -> Path:
    """The errors of several runs, one panel each."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 62)
    fig.set_layout_engine("constrained")
    for ax, (name, of) in zip(fig.subplots(1, len(errors), sharey=True, squeeze=False)[0], errors.items(), strict=True):
        draw_errors(ax, of)
        ax.set(title=name, ylim=(1e-10, 0.1))
        ax.label_outer()
    fig.legend(*ax.get_legend_handles_labels(), loc="outside upper center", ncols=5)
    return style.save_png(fig, path)


def draw_errors(ax: Axes, errors: Errors) -> None:
    """Error against the step, with a line of each order that is expected."""
    for exchange, by_step in errors.items():
        h, values, (mark, colour, order) = 1000 * np.array([*by_step]), [*by_step.values()], MARKS[exchange]
        ax.loglog(h, values, mark, color=colour, markersize=3, label=exchange)
        if order and np.isfinite(values[-1]):
            known = f"order {order}" in ax.get_legend_handles_labels()[1]
            guide = {"color": style.GREY, "linestyle": GUIDES[order], "label": None if known else f"order {order}"}
            ax.loglog(h, values[-1] * (h / h[-1]) ** order, **guide)
    ax.set_xticks(h, [f"{x:g}" for x in h])
    ax.minorticks_off()
    ax.set(xlabel="step [ms]", ylabel="error / range")
