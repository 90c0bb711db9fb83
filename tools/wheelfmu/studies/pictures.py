"""The picture of any study: a curve for one name that varies, a map for two, else a column of marginals for each name.

A panel for each measure; angles in degrees. Runs that ended early have the colours of `drawing.FATES`.
"""

import json
from pathlib import Path
from textwrap import wrap

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from wheelfmu.diagrams import style

from .dataset import in_degrees
from .drawing import FATES
from .plan import POINT

MOST = 4  # measures, and names in marginals, that are drawn
HUES = 6  # values of a name that are drawn as curves, not as a side of a map
TONES = (style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY)
WIDTH, HEIGHT = 86.0, 62.0  # mm of a panel


def draw(results: xr.Dataset, stem: Path) -> Path | None:
    """Writes stem.png; None where nothing varies or is measured."""
    table, measures = in_degrees(results.load()), [*json.loads(results.attrs["study"])["measures"]][:MOST]
    names = [name for name in results.attrs["varied"] if table[name].size > 1][:MOST]
    measures = [name for name in measures if np.isfinite(table[name]).any()]
    if not names or not measures:
        return None
    style.use_style()
    listed = POINT in table.sizes
    single = {name: 0 for name in table[measures[0]].dims if table.sizes[name] == 1}
    table, small = table.isel(single), min((table[name].size for name in names), default=0) <= HUES
    if len(names) == 1 and not listed:
        return one_row(table, measures, lambda ax, name: curves(ax, table, name, names[0]), stem)
    if len(names) == 2 and not listed:
        x, other = sorted(names, key=lambda name: -table[name].size)
        if small:
            return one_row(table, measures, lambda ax, name: curves(ax, table, name, x, other), stem)
        return one_row(table, measures, lambda ax, name: mapped(ax, table, name, *names), stem)
    fig = sheet(8 + 50 * max(len(names), 2), 12 + 45 * len(measures))
    axes = fig.subplots(len(measures), len(names), squeeze=False, sharex="col", sharey="row")
    for row, measure in zip(axes, measures, strict=True):
        for ax, name in zip(row, names, strict=True):
            marginal(ax, table, measure, name, listed)
            ax.tick_params(labelbottom=measure == measures[-1])
        row[0].set_ylabel("\n".join(wrap(said(table, measure), 26)))
    for ax, name in zip(axes[-1], names, strict=True):
        ax.set_xlabel(said(table, name))
    return finished(fig, table, stem)


def one_row(table: xr.Dataset, measures: list[str], fill, stem: Path) -> Path:  # noqa: ANN001
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
    found = [FATES[code] for code in FATES if (table["status"] == code).any()]
    if found:
        handles = [Patch(color=tone, label=word) for tone, word in found]
        fig.legend(handles=handles, loc="outside lower center", ncols=len(handles), title="the run ends: the wheel")
    return style.save_png(fig, stem.with_suffix(".png"))


def said(table: xr.Dataset, name: str) -> str:
    """`initial θ [deg]`."""
    about = table[name].attrs
    unit = about.get("units", "1")
    return about.get("long_name", name) + (f" [{unit}]" if unit != "1" else "")


def curves(ax: Axes, table: xr.Dataset, measure: str, x: str, hue: str | None = None) -> None:
    """A measure over one name, a curve for each value of another."""
    values = [None] if hue is None else table[hue].values.tolist()
    for tone, value in zip(TONES, values, strict=False):
        one = table if hue is None else table.sel({hue: value})
        label = None if hue is None else f"{value:.4g}"
        ax.plot(one[x], one[measure], color=tone, label=label, marker="." if one[x].size < 40 else "", markersize=3)
        for code, (dot, _) in FATES.items():
            ends = one["status"] == code
            ax.plot(one[x][ends], one[measure][ends], "x", color=dot, markersize=3.5, zorder=3)
    ax.set(xlabel=said(table, x), ylabel=said(table, measure))
    if hue is not None:
        ax.legend(title=said(table, hue), title_fontsize=7.5)


def mapped(ax: Axes, table: xr.Dataset, measure: str, x: str, y: str) -> None:
    """A measure over two names, in steps whose boundaries run between the wheels."""
    one = table.transpose(y, x, ...)
    values, ended = one[measure].values, one["status"].values
    shades = ax.contourf(one[x], one[y], values, 8, cmap="viridis")
    for code, (tone, _) in FATES.items():
        if (ended == code).any():
            ax.contourf(one[x], one[y], (ended == code) * 1.0, [0.5, 1.5], colors=[tone])
    ax.set(xlabel=said(table, x), ylabel=said(table, y))
    ax.figure.colorbar(shades, ax=ax, label=said(table, measure))


def marginal(ax: Axes, table: xr.Dataset, measure: str, name: str, listed: bool) -> None:
    """A measure over one of many names: of a list its wheels, of a grid the median of all others and their middle four
    fifths."""
    values, at = table[measure], table[name]
    if listed:
        ax.plot(at, values, ".", color=style.BLUE, markersize=2.5)
        for code, (tone, _) in FATES.items():
            ends = table["status"] == code
            ax.plot(at[ends], values[ends], ".", color=tone, markersize=3.5)
        return
    others = [other for other in values.dims if other != name]
    low, middle, high = (values.quantile(q, others) for q in (0.1, 0.5, 0.9))
    ax.fill_between(at, low, high, color=style.BLUE, alpha=0.2, linewidth=0)
    ax.plot(at, middle, color=style.BLUE, marker="." if at.size < 40 else "", markersize=3)
