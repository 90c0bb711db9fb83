"""The picture of any study: a curve for one name that varies, a map for two, else a column of marginals for each name.

A panel for each measure; angles in degrees. Runs that ended early have the colours of `drawing.FATES`.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from wheelfmu.diagrams import style

from .dataset import in_degrees, study_of
from .drawing import FATES
from .plan import POINT

MOST = 4  # measures, and names in marginals, that are drawn
HUES = 6  # values of a name that are drawn as curves, not as a side of a map
TONES = (style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY)
WIDTH, HEIGHT = 86.0, 62.0  # mm of a panel


def draw(results: xr.Dataset, stem: Path) -> Path | None:
    """Writes stem.png; None where nothing varies or is measured."""
    table = in_degrees(results.load())
    names = [name for name in results.attrs["varied"] if table[name].size > 1][:MOST]
    measures = [name for name in [*study_of(results).measures][:MOST] if np.isfinite(table[name]).any()]
    if not names or not measures:
        return None
    for values in table.variables.values():
        if values.attrs.get("units") == "1":
            del values.attrs["units"]
    style.use_style()
    listed, table = POINT in table.sizes, table.squeeze(drop=True)
    if len(names) > 2 or listed:
        return marginals(table, measures, names, listed, stem)
    x, other = [*sorted(names, key=lambda name: -table[name].size), None][:2]
    if other and table[other].size > HUES:
        return one_row(table, measures, partial(mapped, table, *names), stem)
    return one_row(table, measures, partial(curves, table, x, other), stem)


def one_row(table: xr.Dataset, measures: list[str], fill: Callable[[Axes, str], None], stem: Path) -> Path:
    """A panel for each measure, two in a row."""
    columns = min(2, len(measures))
    rows = -(-len(measures) // columns)
    fig = sheet(WIDTH * max(columns, 1.3), HEIGHT * rows + 8)
    axes = fig.subplots(rows, columns, squeeze=False)
    for ax, name in zip(axes.flat, measures, strict=False):
        fill(ax, name)
    for ax in axes.flat[len(measures) :]:
        ax.remove()
    return finished(fig, table, stem)


def sheet(width: float, height: float) -> Figure:
    fig = style.figure_mm(width, height)
    fig.set_layout_engine("constrained")
    return fig


def finished(fig: Figure, table: xr.Dataset, stem: Path) -> Path:
    """With a legend of the ends that occur."""
    if handles := [Patch(color=tone, label=word) for _, tone, word in ends(table)]:
        fig.legend(handles=handles, loc="outside lower center", ncols=len(handles), title="the run ends: the wheel")
    return style.save_png(fig, stem.with_suffix(".png"))


def ends(table: xr.Dataset) -> list[tuple[xr.DataArray, str, str]]:
    """The ends that occur: whether a wheel has each, its colour and word."""
    found = [(table["status"] == code, tone, word) for code, (tone, word) in FATES.items()]
    return [end for end in found if end[0].any()]


def curves(table: xr.Dataset, x: str, hue: str | None, ax: Axes, measure: str) -> None:
    """A measure over one name, a curve for each value of another."""
    ax.set_prop_cycle(color=TONES)
    dots = {"marker": "." if table[x].size < 40 else "", "markersize": 3}
    table[measure].plot.line(ax=ax, x=x, hue=hue, **dots)
    for there, tone, _ in ends(table):
        crosses = {"linestyle": "", "marker": "x", "markersize": 3.5, "color": tone, "zorder": 3}
        table[measure].where(there).plot.line(ax=ax, x=x, hue=hue, add_legend=False, **crosses)


def mapped(table: xr.Dataset, x: str, y: str, ax: Axes, measure: str) -> None:
    """A measure over two names, in steps whose boundaries run between the wheels."""
    table[measure].plot.contourf(ax=ax, x=x, y=y, levels=11, cmap="viridis")
    for there, tone, _ in ends(table):
        flat = {"levels": [0.5, 1.5], "colors": [tone], "add_colorbar": False, "add_labels": False}
        (there * 1.0).plot.contourf(ax=ax, x=x, y=y, **flat)


def marginals(table: xr.Dataset, measures: list[str], names: list[str], listed: bool, stem: Path) -> Path:
    """Each measure over each of many names: of a list its wheels, of a grid the median of all others and their middle
    four fifths."""
    fig = sheet(8 + 50 * max(len(names), 2), 12 + 45 * len(measures))
    axes = fig.subplots(len(measures), len(names), squeeze=False, sharex="col", sharey="row")
    for row, measure in zip(axes, measures, strict=True):
        for ax, name in zip(row, names, strict=True):
            if listed:
                spread(ax, table, measure, name)
            else:
                band(ax, table[measure], name)
            ax.label_outer()
    return finished(fig, table, stem)


def spread(ax: Axes, table: xr.Dataset, measure: str, name: str) -> None:
    """A dot for each wheel."""
    dots = {"ax": ax, "x": name, "linestyle": "", "marker": "."}
    table[measure].plot.line(**dots, color=style.BLUE, markersize=2.5)
    for there, tone, _ in ends(table):
        table[measure].where(there).plot.line(**dots, color=tone, markersize=3.5)


def band(ax: Axes, values: xr.DataArray, name: str) -> None:
    others = [other for other in values.dims if other != name]
    low, middle, high = (values.quantile(q, others).drop_vars("quantile") for q in (0.1, 0.5, 0.9))
    ax.fill_between(middle[name], low, high, color=style.BLUE, alpha=0.2, linewidth=0)
    middle.plot.line(ax=ax, x=name, color=style.BLUE, marker="." if middle.size < 40 else "", markersize=3)
