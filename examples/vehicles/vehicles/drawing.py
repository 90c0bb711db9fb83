"""A vehicle's run drawn: path from above with its wheels, loads, angles, slip demand, error against the step."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from diagrams import style

from .errors import Errors

COLOURS = (style.BLUE, style.SKY, style.VERMILLION, style.ORANGE, style.PURPLE, style.GREY)
MARKS = {
    "positions held": ("d-", style.ORANGE),
    "held": ("o-", style.VERMILLION),
    "derivatives": ("s-", style.BLUE),
    "rollback": ("^-", style.GREEN),
}
BESIDE = {"loc": "center right", "bbox_to_anchor": (-0.3, 0.5), "borderaxespad": 0}
ABOVE = {"loc": "lower left", "bbox_to_anchor": (0, 0.98), "labelspacing": 0.2, "borderaxespad": 0.2}
DASHES = ("-", "--", "-", "--", "-", "--")  # a wheel that has the values of the one before is seen through its gaps
GUIDES = {1: (0, (4, 2)), 2: (0, (1, 1))}  # lines of an order
ORDERS = {"positions held": 1, "held": 1, "derivatives": 2, "rollback": None}


@dataclass(frozen=True)
class Line:
    """One curve beside the path: label, values, unit."""

    label: str
    values: np.ndarray


def draw(
    table: dict[str, np.ndarray],
    wheels: dict[str, str],
    lines: tuple[str, list[Line]],
    errors: Errors | None,
    path: Path,
    title: str,
    exact: tuple[np.ndarray, np.ndarray] | None = None,
) -> Path:
    """`wheels`: component and what it is called; `lines`: axis label and curves; `exact`: a path in closed form."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 158)
    fig.suptitle(title, fontsize=9, y=0.995)
    _path(style.axes_mm(fig, 16, 104, 162, 40), table, wheels, exact)
    t = table["time"]
    load, demand = style.axes_mm(fig, 16, 58, 70, 36), style.axes_mm(fig, 108, 58, 70, 36)
    for (name, label), colour, dashes in zip(wheels.items(), COLOURS, DASHES, strict=False):
        load.plot(t, table[f"{name}.lambda_3"] / 1000, color=colour, linestyle=dashes, label=label)
        demand.plot(t, table[f"{name}.mu_required"], color=colour, linestyle=dashes)
    load.set_ylim(0, None)
    load.set(ylabel="normal force [kN]")
    demand.set_ylim(0, None)
    demand.set(ylabel="friction coefficient\nrequired")
    handles, labels = load.get_legend_handles_labels()
    fig.legend(handles, labels, loc="center", bbox_to_anchor=(0.53, 149 / 158), ncols=len(wheels))
    curves = style.axes_mm(fig, 16, 12, 70 if errors else 162, 36)
    _lines(curves, t, *lines)
    if errors:
        draw_errors(style.axes_mm(fig, 124, 12, 54, 30), errors, BESIDE)
    return style.save_png(fig, path)


def draw_orders(errors: dict[str, Errors], path: Path) -> Path:
    """The errors of several runs, one panel each."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 62)
    width = (style.PAGE - 16) / len(errors)
    for i, (name, of) in enumerate(errors.items()):
        ax = style.axes_mm(fig, 16 + i * width, 12, width - 5, 34)
        draw_errors(ax, of, None)
        ax.set_title(name, fontsize=9)
        ax.set_ylim(1e-10, 0.1)
        if i:
            ax.set_ylabel("")
            ax.set_yticklabels([])
    fig.legend(*ax.get_legend_handles_labels(), loc="upper center", ncols=5)
    return style.save_png(fig, path)


def _path(
    ax: Axes, table: dict[str, np.ndarray], wheels: dict[str, str], exact: tuple[np.ndarray, np.ndarray] | None
) -> None:
    """Tracks of the wheels' centres, and the wheels themselves a few times, 0.7 m long, along their headings. A path
    that would be a thin strip is stretched across, and says so."""
    count, tracks = len(table["time"]), [(table[f"{w}.X_O"], table[f"{w}.Y_O"]) for w in wheels]
    if exact:
        ax.plot(table["X"], table["Y"], color=style.GREEN, label="middle of the axle")
        ax.plot(*exact, color=style.INK, linestyle=(0, (2, 2)), label="of the rigid axle, in closed form")
    for (name, (x, y)), colour in zip(zip(wheels, tracks, strict=True), COLOURS, strict=False):
        for i in np.unique(np.linspace(0, count - 1, 9).astype(int)):
            psi = table[f"{name}.psi"][i]
            along = 0.35 * np.array([np.cos(psi), np.sin(psi)])
            ends = (x[i] + along[0] * np.array([-1, 1]), y[i] + along[1] * np.array([-1, 1]))
            ax.plot(*ends, color=style.INK, linewidth=1.6, alpha=0.45, zorder=1, solid_capstyle="round")
        ax.plot(x, y, color=colour, linewidth=0.9, zorder=2)
    wide, high = (max(float(np.ptp(np.concatenate([t[k] for t in tracks]))), 0.1) for k in (0, 1))
    stretch, across = (40 / high) / (162 / wide), "Y [m]"
    if stretch > 2.5:
        ax.margins(0.02, 0.08)
        across = f"Y [m], stretched {stretch:.0f} times"
    else:
        ax.set_aspect("equal", adjustable="datalim")
    if exact:
        ax.legend(loc="upper right")
    ax.set(xlabel="X [m]", ylabel=across)


def _lines(ax: Axes, t: np.ndarray, label: str, lines: list[Line]) -> None:
    for line, colour, dashes in zip(lines, (style.INK, style.GREEN, style.PURPLE), DASHES, strict=False):
        ax.plot(t, line.values, color=colour, linestyle=dashes, label=line.label)
    ax.legend(**{**ABOVE, "ncols": len(lines)})
    ax.set(xlabel="time [s]", ylabel=label)


def draw_errors(ax: Axes, errors: Errors, legend: dict | None) -> None:
    """Error against the step, with a line of each order that is expected; `legend`: its place, if there is one."""
    h, drawn = 1000 * np.array(errors.steps), set()
    for exchange, values in errors.of.items():
        mark, colour = MARKS[exchange]
        ax.loglog(h, values, mark, color=colour, markersize=3, label=exchange)
    for exchange, values in errors.of.items():
        order = ORDERS[exchange]
        if order and np.isfinite(values[-1]):
            label = {"label": f"order {order}"} if order not in drawn else {}
            drawn.add(order)
            ax.loglog(h, values[-1] * (h / h[-1]) ** order, color=style.GREY, linestyle=GUIDES[order], **label)
    ax.set_xticks(h, [f"{x:g}" for x in h])
    ax.minorticks_off()
    if legend:
        ax.legend(**legend)
    ax.set(xlabel="step [ms]", ylabel="error / range")
