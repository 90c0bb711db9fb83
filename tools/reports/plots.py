"""The look of the reports' pictures: diagrams/style.py, a page wide (1080 pixels), PNG."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Sheet

from diagrams import style

DPI = 150
COLOURS = (style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY, style.GREY, style.INK)


def sheet(columns: int = 1, rows: int = 1, height: float = 70.0) -> tuple[Sheet, list[Axes]]:
    """A figure of the page's width, `height` mm for each row of axes."""
    style.use_style()
    figure = style.figure_mm(style.PAGE, height * rows)
    figure.set_layout_engine("constrained")
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for ax in axes:
        ax.grid(alpha=0.3, linewidth=0.4)
    return figure, list(axes)


def label(ax: Axes, x: str, y: str, title: str = "", log: str = "") -> None:
    """log: the axes that are logarithmic, out of "xy"."""
    ax.set(xlabel=x, ylabel=y)
    ax.set_title(title, fontsize=9, loc="left")
    if "x" in log:
        ax.set_xscale("log")
    if "y" in log:
        ax.set_yscale("log")


def legend_below(figure: Sheet, ax: Axes, columns: int = 4) -> None:
    """Each label once."""
    handles, labels = ax.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    figure.legend(once.values(), once.keys(), loc="outside lower center", ncols=columns)
