"""A vehicle's run drawn: path from above with its wheels, loads, angles, slip demand, error against the step."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from diagrams import style

COLOURS = (style.BLUE, style.SKY, style.VERMILLION, style.ORANGE, style.PURPLE, style.GREY)
MARKS = {"held": ("o-", style.VERMILLION), "derivatives": ("s-", style.BLUE), "rollback": ("^-", style.GREEN)}
ABOVE = {"loc": "lower left", "bbox_to_anchor": (0, 0.98), "labelspacing": 0.2, "borderaxespad": 0.2}
ORDERS = {"held": 1, "derivatives": 2, "rollback": None}


@dataclass(frozen=True)
class Errors:
    """Errors relative to the range against the communication step, by exchange; nan where a run broke off."""

    steps: tuple[float, ...]
    of: dict[str, list[float]]


@dataclass(frozen=True)
class Line:
    """One curve beside the path: label, values, unit."""

    label: str
    values: np.ndarray


def save(fig: Figure, path: Path) -> Path:
    """As PNG, the same bytes for the same picture."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fig.savefig(path, dpi=200, metadata={"Software": None})
    return path


def draw(
    table: dict[str, np.ndarray],
    wheels: dict[str, str],
    lines: tuple[str, list[Line]],
    errors: Errors | None,
    path: Path,
    exact: tuple[np.ndarray, np.ndarray] | None = None,
) -> Path:
    """`wheels`: component and what it is called; `lines`: axis label and curves; `exact`: a path in closed form."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 132)
    _path(style.axes_mm(fig, 16, 76, 72, 50), table, wheels, exact)
    t = table["time"]
    load, demand = style.axes_mm(fig, 108, 76, 70, 50), style.axes_mm(fig, 108, 12, 70, 50)
    for (name, label), colour in zip(wheels.items(), COLOURS, strict=False):
        load.plot(t, table[f"{name}.lambda_3"] / 1000, color=colour, label=label)
        demand.plot(t, table[f"{name}.mu_required"], color=colour, label=label)
    load.legend(loc="best", ncols=2)
    load.set_ylim(0, None)
    load.set(xlabel="time [s]", ylabel="normal force [kN]")
    demand.set_ylim(0, None)
    demand.set(xlabel="time [s]", ylabel="friction coefficient required")
    if errors:
        _lines(style.axes_mm(fig, 16, 12, 30, 40), t, *lines)
        _errors(style.axes_mm(fig, 62, 12, 30, 40), errors)
    else:
        _lines(style.axes_mm(fig, 16, 12, 72, 40), t, *lines)
    return save(fig, path)


def draw_orders(errors: dict[str, Errors], path: Path) -> Path:
    """The errors of several runs, one panel each."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 62)
    width = (style.PAGE - 16) / len(errors)
    for i, (name, of) in enumerate(errors.items()):
        ax = style.axes_mm(fig, 16 + i * width, 12, width - 5, 34)
        _errors(ax, of, legend=False)
        ax.set_title(name, fontsize=9)
        ax.set_ylim(1e-10, 0.1)
        if i:
            ax.set_ylabel("")
            ax.set_yticklabels([])
    fig.legend(*ax.get_legend_handles_labels(), loc="upper center", ncols=3)
    return save(fig, path)


def _path(
    ax: Axes, table: dict[str, np.ndarray], wheels: dict[str, str], exact: tuple[np.ndarray, np.ndarray] | None
) -> None:
    """Tracks of the wheels' centres, and the wheels themselves a few times, 0.7 m long, along their headings."""
    count = len(table["time"])
    for (name, _), colour in zip(wheels.items(), COLOURS, strict=False):
        x, y = table[f"{name}.X_O"], table[f"{name}.Y_O"]
        ax.plot(x, y, color=colour, linewidth=0.7)
        for i in np.unique(np.linspace(0, count - 1, 9).astype(int)):
            psi = table[f"{name}.psi"][i]
            along = 0.35 * np.array([np.cos(psi), np.sin(psi)])
            ax.plot(
                x[i] + along[0] * np.array([-1, 1]), y[i] + along[1] * np.array([-1, 1]), color=style.INK, linewidth=2
            )
    if exact:
        ax.plot(*exact, color=style.GREY, linestyle="--", linewidth=0.8, label="rigid axle, closed form")
        ax.legend(loc="best")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="X [m]", ylabel="Y [m]")


def _lines(ax: Axes, t: np.ndarray, label: str, lines: list[Line]) -> None:
    for line, colour in zip(lines, (style.INK, style.GREEN, style.PURPLE), strict=False):
        ax.plot(t, line.values, color=colour, label=line.label)
    ax.legend(**ABOVE)
    ax.set(xlabel="time [s]", ylabel=label)


def _errors(ax: Axes, errors: Errors, legend: bool = True) -> None:
    h = 1000 * np.array(errors.steps)
    for exchange, values in errors.of.items():
        mark, colour = MARKS[exchange]
        ax.loglog(h, values, mark, color=colour, markersize=3, label=exchange)
        if ORDERS[exchange] and np.isfinite(values[-1]):
            ax.loglog(h, values[-1] * (h / h[-1]) ** ORDERS[exchange], color=style.GREY, linewidth=0.6, linestyle="--")
    ax.set_xticks(h, [f"{x:g}" for x in h])
    ax.minorticks_off()
    if legend:
        ax.legend(**ABOVE)
    ax.set(xlabel="step [ms]", ylabel="error / range")
