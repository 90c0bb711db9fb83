"""The picture of any study: its first measure over the one or two names with the most values, by xarray.

A curve, a family of curves, a map, or for a list a dot for each wheel; of a name beyond two the first value. Angles are
in degrees. A wheel whose run ended early is a dot, in maps too: between the wheels nothing is known of an end.
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from wheelfmu.diagrams import style

from .dataset import in_degrees, study_of
from .plan import POINT, Status

HUES = 6  # values of the second name that are drawn as curves, not as a side of a map
FATES = {  # ends of a run
    Status.flat: (style.INK, "lies flat"),
    Status.lifted_off: (style.VERMILLION, "lifts off"),
    Status.grip: (style.PURPLE, "needs more grip"),
    Status.jammed: (style.GREEN, "jams"),
    Status.refused: (style.GREY, "refused"),
    Status.failed: (style.GREY, "failed"),
}


def draw(results: xr.Dataset) -> Figure | None:
    """None where nothing varies or is measured."""
    table = in_degrees(results.load())
    names = sorted((n for n in results.attrs["varied"] if table[n].size > 1), key=lambda name: -table[name].size)
    measures = [name for name in study_of(results).measures if np.isfinite(table[name]).any()]
    if not names or not measures:
        return None
    for values in table.variables.values():
        if values.attrs.get("units") == "1":
            del values.attrs["units"]
    style.use_style()
    fig = style.figure_mm(120.0, 84.0)
    fig.set_layout_engine("constrained")
    ax, measure = fig.add_subplot(), measures[0]
    x, other = [*names, None][:2]
    table = table.isel({name: 0 for name in table[measure].dims if name not in (x, other, POINT)})
    if POINT in table.sizes:
        height = measure
        table.plot.scatter(ax=ax, x=x, y=measure, hue=other, add_legend=False, s=12)
    elif other and table[other].size > HUES:
        height = other
        table[measure].plot.contourf(ax=ax, x=x, y=other, levels=11, cmap="viridis")
    else:
        height = measure
        table[measure].plot.line(ax=ax, x=x, hue=other, marker="." if table[x].size < 40 else "")
    dots(ax, table, x, height)
    return fig


def dots(ax: Axes, table: xr.Dataset, x: str, y: str) -> None:
    """A dot for each wheel whose run ended early, with a legend of the ends that occur."""
    x_of, y_of, status = (values.values for values in xr.broadcast(table[x], table[y], table["status"]))
    for code, (tone, word) in FATES.items():
        if (there := status == code).any():
            ax.plot(x_of[there], y_of[there], ".", color=tone, markersize=4, label=word)
    handles, words = ax.get_legend_handles_labels()
    ends = {word for _, word in FATES.values()}
    shown = {word: handle for handle, word in zip(handles, words, strict=True) if word in ends}
    if shown:
        ax.figure.legend(shown.values(), shown.keys(), loc="outside lower center", ncols=len(shown))
