"""Error over run time, method by method: the look of all such races, and those of the scenes of ./scripts/run."""

import csv
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from diagrams import style

if TYPE_CHECKING:
    from diagrams.trust import Race

LEAST = 1e-14  # of the range: what is drawn for less
LOOKS = {  # colour, marker and line
    "automatic": (style.BLUE, "o-"),
    "adams": (style.GREEN, "v-"),
    "bdf": (style.SKY, "<--"),
    "runge_kutta": (style.ORANGE, ">:"),
    "formulation 3": (style.PURPLE, "s-."),
}
METHODS = {name: {"method": str(k)} for k, name in enumerate(LOOKS, 1)} | {"formulation 3": {"formulation": "3"}}
TOLERANCES = tuple(10.0**-k for k in range(4, 13))
TURNS, SLOW = 5, 0.3  # repetitions; s: what takes longer is measured once


def curve(ax: Axes, method: str, microseconds: Sequence[float], errors: Sequence[float]) -> None:
    """One method; automatic lies on top, half transparent, so that what it equals shows."""
    colour, mark = LOOKS[method]
    look = {"lw": 3.5, "alpha": 0.55, "ms": 5} if method == "automatic" else {"lw": 1, "ms": 3}
    ax.plot(microseconds, np.clip(errors, LEAST, None), mark, color=colour, label=method, **look)


def dress(ax: Axes, title: str, time: str = "best time") -> None:
    """The axes of a race."""
    ax.set(xlabel=f"{time} [µs]", ylabel="error / range", xscale="log", yscale="log", ylim=(LEAST, 3))
    ax.set_title(title, fontsize=9, loc="left")
    ax.grid(alpha=0.3, linewidth=0.4)


def measured(race: "Race") -> list[dict]:
    """A row per method and tolerance; times are medians of repetitions in turns."""
    rows = []
    for method, values in METHODS.items():
        for tolerance in TOLERANCES:
            rows.append({"method": method, "tolerance": tolerance} | race.run(values, tolerance))
    costs: list[list[float]] = [[] for _ in rows]
    for _ in range(TURNS):
        for row, spent in zip(rows, costs, strict=True):
            if not row["note"] and not (spent and spent[0] > SLOW):
                spent.append(race.seconds(METHODS[row["method"]], row["tolerance"]))
    for row, spent in zip(rows, costs, strict=True):
        row["median_us"] = 1e6 * median(spent) if spent else np.nan
    return rows


def write(races: Mapping[str, "Race"], folder: Path) -> None:
    """error_time.csv and error_time.png, a panel for each scene; what failed goes to stdout."""
    style.use_style()
    figure = style.figure_mm(style.PAGE, 80.0)
    figure.set_layout_engine("constrained")
    table = []
    for ax, (label, race) in zip(np.ravel(figure.subplots(1, len(races))), races.items(), strict=True):
        rows = measured(race)
        table += [{"scene": label} | row for row in rows]
        for method in METHODS:
            done = [row for row in rows if row["method"] == method and not row["note"]]
            if done:
                curve(ax, method, [row["median_us"] for row in done], [row["error"] for row in done])
        dress(ax, label, "median time")
    handles = {text: h for ax in figure.axes for h, text in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
    style.save_png(figure, folder / "error_time.png")
    with (folder / "error_time.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ("scene", "method", "tolerance", "error", "median_us", "note"))
        writer.writeheader()
        writer.writerows(row | {n: f"{row[n]:.4g}" for n in ("tolerance", "error", "median_us")} for row in table)
    for row in table:
        if row["note"]:
            print(f"{row['scene']}, {row['method']}, {row['tolerance']:.0e}: {row['note']}", file=sys.stderr)
