"""One log-log sheet per scene: time to the right, error down."""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.pyplot as plt

from .builds import ROOT
from .runner import Sheet

sys.path.insert(0, str(ROOT / "scripts"))
from plotting import style  # noqa: E402

FMU_SHADES = (style.BLUE, style.SKY, "#004A75", "#9BD0F2", "#2F6690")
LOOKS = {
    "DOP853 C++": (style.VERMILLION, "-", "s"),
    "DOP853 C++ native": (style.VERMILLION, ":", "s"),
    "heyoka": (style.GREEN, "-", "^"),
    "odeint dopri5": (style.ORANGE, "-", "v"),
    "odeint fehlberg78": (style.ORANGE, "--", "v"),
    "odeint bulirsch_stoer": (style.ORANGE, ":", "v"),
    "numbalsoda lsoda": (style.PURPLE, "-", "D"),
    "numbalsoda dop853": (style.PURPLE, "--", "D"),
}


def look_of(name: str, rank: int) -> dict[str, object]:
    if name.startswith("FMU"):
        bold = name == "FMU automatic"
        return {"color": FMU_SHADES[rank % 5], "lw": 1.8 if bold else 0.9, "marker": "o", "ls": "-", "zorder": 3}
    color, line, marker = LOOKS.get(name, (style.GREY, ("-", "--", ":", "-.")[rank % 4], "."))
    return {"color": color, "ls": line, "marker": marker, "lw": 1.0}


def draw(sheet: Sheet, path: Path) -> None:
    style.use_style()
    fig = style.figure_mm(style.PAGE, 110)
    ax = style.axes_mm(fig, 16, 13, 115, 88)
    for rank, name in enumerate(sheet.names()):
        points = sorted((e.tolerance, e.best, e.error) for e in sheet.of(name) if e.error is not None and e.bests)
        if points:
            times, errors = [1e6 * t for _, t, _ in points], [max(e, 1e-15) for *_, e in points]
            ax.plot(times, errors, markersize=3, label=name, **look_of(name, rank))
    ax.axhspan(sheet.reference.error / 10, sheet.reference.error, color=style.BAND, lw=0, zorder=0)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_ylim(sheet.reference.error / 10, 2)
    ax.set_xlabel(f"time for {sheet.scene.stop:g} s and 101 grid times, best / µs")
    ax.set_ylabel("error relative to each output's range")
    ax.set_title(sheet.scene.title, fontsize=9.5, loc="left")
    ax.grid(True, lw=0.3, color="#DDDDDD")
    ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0))
    ax.annotate("the reference's own error", (0.01, 0.015), xycoords="axes fraction", fontsize=7)
    fig.savefig(path, dpi=150, metadata={"Software": None})
    plt.close(fig)
