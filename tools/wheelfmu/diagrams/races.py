"""Error over run time: the look of all such races, and those of the scenes of ./scripts/run.

    python -m wheelfmu.diagrams.races FOLDER [argument of ./scripts/run]...

writes FOLDER/SCENE.error for both scenes: the line for the user, then the words for the captions. With error=methods it
also writes the table and the picture error_time of all methods and tolerances.
"""

import csv
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import extract
from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.ticker import LogLocator, NullFormatter

from wheelfmu.diagrams import style
from wheelfmu.fmu.outputs import worded
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.start_values import CHECKS, PAPER_S, RUN, values
from wheelfmu.fmu.values import variables
from wheelfmu.truth.trust import DEFAULT, REPEATS, Wheel, trust

BESIDE = 0.06  # decades: marks that are closer are one
LEAST = 1e-14  # of the range: what is drawn for less
LOOKS = {  # colour, marker and line
    "automatic": (style.BLUE, "o-"),
    "adams": (style.GREEN, "v-"),
    "bdf": (style.SKY, "<--"),
    "runge_kutta": (style.ORANGE, ">:"),
    "heyoka": (style.VERMILLION, "s-"),  # of the speed report
    "formulation 3": (style.PURPLE, "s-."),
}
METHODS = {name: {"method": str(k)} for k, name in enumerate(("automatic", "adams", "bdf", "runge_kutta"), 1)}
METHODS["formulation 3"] = {"formulation": "3"}
TOLERANCES = tuple(10.0**-k for k in range(4, 13))
TURNS, SLOW = 7, 0.3  # repetitions; s: what takes longer is measured once


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
    first, last = ax.dataLim.intervalx
    if last < 30 * first:  # few decades, or none: 1, 2 and 5 of each have room
        ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_formatter(NullFormatter())


def mark(ax: Axes, rows: Sequence[dict]) -> None:
    """Of one method: the tolerances at the ends of its curve, and a ring about the default one."""
    at = {row["tolerance"]: (row["median_us"], max(row["error"], LEAST)) for row in rows}
    for tolerance, shift, side in ((max(at), (0, 4), "bottom"), (min(at), (0, -4), "top")):
        there = [text.xy for text in ax.texts if isinstance(text, Annotation) and text.get_verticalalignment() == side]
        if all(abs(np.log10(np.divide(at[tolerance], other))).max() > BESIDE for other in there):
            look = {"ha": "center", "va": side, "fontsize": 6.5, "color": style.GREY}
            style.note(ax, power(tolerance), at[tolerance], shift, **look)
    if DEFAULT in at:
        look = {"markersize": 8, "fillstyle": "none", "markeredgewidth": 0.8, "color": style.INK, "linestyle": "none"}
        ax.plot(*at[DEFAULT], "o", label=f"default tolerance, {power(DEFAULT)}", **look)


def power(tolerance: float) -> str:
    return rf"$10^{{{np.log10(tolerance):.0f}}}$"


def methods_of(start: dict[str, str]) -> dict[str, dict[str, str]]:
    """The ways to be compared: formulation 3 once, also where the others have it."""
    left_out = ["formulation 3"] * (start.get("formulation") == "3")
    return {name: more for name, more in METHODS.items() if name not in left_out}


def measured(wheel: Wheel, start: dict[str, str], times: np.ndarray, scales: np.ndarray) -> list[dict]:
    """A row per method and tolerance, with its error by another solver or why it has none; times are medians of
    repetitions in turns."""
    rows: list[dict] = []
    for method, more in methods_of(start).items():
        truth = wheel.judge(start | more, times)
        for tolerance in TOLERANCES:
            found = wheel.motion(start | more, times, tolerance)
            failed = abs(len(found.rows) - len(truth.rows)) > 1
            error, note = (np.nan, found.message) if failed else (trust(found, truth, scales).error, "")
            rows.append({"method": method, "tolerance": tolerance, "error": error, "note": note, "costs": []})
    for row in (row for _ in range(TURNS) for row in rows):
        if not row["note"] and not (row["costs"] and row["costs"][0][0] > SLOW):
            row["costs"].append(wheel.timed(start | METHODS[row["method"]], times, row["tolerance"]))
    ours = min(empty for row in rows for _, empty in row["costs"])  # Python's share, alike for all
    for row in rows:
        costs = [step - ours for step, _ in row.pop("costs")]
        row["median_us"] = 1e6 * float(np.median(costs)) if costs else np.nan
    return rows


def write(races: dict[str, list[dict]], folder: Path) -> None:
    """error_time.csv and error_time.png, a panel for each scene; what failed is printed."""
    style.use_style()
    figure = style.figure_mm(style.PAGE, 80.0)
    figure.set_layout_engine("constrained")
    for ax, (label, rows) in zip(np.ravel(figure.subplots(1, len(races))), races.items(), strict=True):
        for method in dict.fromkeys(row["method"] for row in rows):
            done = [row for row in rows if row["method"] == method and not row["note"]]
            curve(ax, method, [row["median_us"] for row in done], [row["error"] for row in done])
            if done:
                mark(ax, done)
        dress(ax, label, "median time; at the ends: the tolerance")
    handles = {text: handle for ax in figure.axes for handle, text in zip(*ax.get_legend_handles_labels(), strict=True)}
    order = sorted(handles, key=lambda text: text.startswith("default"))
    figure.legend([handles[text] for text in order], order, loc="outside lower center", ncols=6)
    style.save_png(figure, folder / "error_time.png")
    with (folder / "error_time.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(names := ("scene", "method", "tolerance", "error", "median_us", "note"))
        for label, rows in races.items():
            for row in rows:
                texts = {n: f"{x:.4g}" if isinstance(x, float) else x for n, x in row.items()} | {"scene": label}
                writer.writerow(texts[name] for name in names)
                if row["note"]:
                    print(f"{label}, {row['method']}, tolerance {texts['tolerance']}: {row['note']}")


def main(folder: Path, given: dict[str, str]) -> None:
    """Both scenes of ./scripts/run."""
    asked = given.pop("error", CHECKS["estimate"])
    if asked == CHECKS["no"]:
        return
    stop, interval = (float(given.pop(name, v.start)) for name, v in RUN.items())
    times, races = np.append(np.arange(0, stop * (1 - 1e-9), interval), stop), {}
    r_0, r, g = (float(given.get(name, variables("parameter")[name].start)) for name in ("r_0", "r", "g"))
    fall = np.sqrt(g / (r_0 + r))  # rad/s
    scales = np.array([r_0 + r, 1.0, fall, fall])
    with TemporaryDirectory() as folder_of_fmu:
        wheel = Wheel(extract(str(ROOT / "wheel.fmu"), folder_of_fmu))
        for name, label in (("free", "No rolling resistance"), ("friction", "Rolling resistance")):
            start = {"s": str(PAPER_S)} | given | ({"s": "0"} if name == "free" else {})
            truth = wheel.judge(start, times)
            if len(truth.rows) > 1:
                found = trust(wheel.motion(start, times, DEFAULT, REPEATS), truth, scales)
                (folder / f"{name}.error").write_text(f"{found.said(label)}\n{found.short}\n", encoding="utf-8")
                if asked == CHECKS["methods"]:
                    races[label] = measured(wheel, start, truth.times, scales)
    if races:
        write(races, folder)


if __name__ == "__main__":
    with worded("run"):
        main(Path(sys.argv[1]), values(sys.argv[2:]))
