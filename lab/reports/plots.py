"""The look of the reports' pictures: diagrams/style.py, a page wide (1080 pixels), PNG."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Sheet
from matplotlib.figure import FigureBase

from wheelfmu.diagrams import style

DPI = 150
COLOURS = (style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY, style.GREY, style.INK)


def sheet(layout: str, height: float = 70.0) -> tuple[Sheet, list[Axes]]:
    """A figure of the page's width: a letter for each axes, rows parted by semicolons, `height` mm each."""
    style.use_style()
    figure = style.figure_mm(style.PAGE, height * (layout.count(";") + 1))
    figure.set_layout_engine("constrained")
    axes = figure.subplot_mosaic(layout)
    for ax in axes.values():
        ax.grid(alpha=0.3, linewidth=0.4)
    return figure, list(axes.values())


def label(
    ax: Axes, x: str, y: str, title: str = "", log: str = "", legend: Any = None, columns: int = 1, **limits: Any
) -> None:
    """log: the axes that are logarithmic, out of "xy"; legend: where it stands."""
    ax.set(xlabel=x, ylabel=y, **{f"{axis}scale": "log" for axis in log}, **limits)
    ax.set_title(title, fontsize=9, loc="left")
    if legend:
        ax.legend(loc=legend, ncols=columns)


def legend_below(figure: FigureBase, axes: list[Axes], columns: int = 4) -> None:
    """Each label once."""
    both = [ax.get_legend_handles_labels() for ax in axes]
    once = {label: handle for handles, labels in both for handle, label in zip(handles, labels, strict=True)}
    figure.legend(once.values(), once.keys(), loc="outside lower center", ncols=columns)
