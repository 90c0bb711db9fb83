"""The map of fates: start angle theta against spin phi_dot, without and with rolling resistance; 10 s each.

`./scripts/study fates` runs it and draws the map; `--publish` writes the figure into docs/figures.
A wheel without any spin lies flat. The least spin of the map is above zero: a column of its own would have no width.
"""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from lab.studies import Study
from lab.studies.dataset import in_degrees
from wheelfmu.diagrams import style
from wheelfmu.truth.closed_forms import critical_spin
from wheelfmu.truth.scenes import PAPER

ANGLES, SPINS = 160, 125  # 2 * 160 * 125 = 40,000 wheels
study = Study(
    grid={
        "s": [0.0, 0.03],  # m; the paper's two scenes
        "theta_start": np.radians(90 * (np.arange(ANGLES) + 0.5) / ANGLES),
        "phi_dot_start": -np.geomspace(0.05, 50.0, SPINS),  # rad/s, rolling towards e1
    },
    values={"keep_contact": 1.0},  # the normal force goes on smoothly through zero, where the wheel lifts off
    measures={"lowest": "lowest", "N": "min(lambda_3)"},
    interval=0.005,
)


def draw(results: xr.Dataset) -> Figure:
    """Two maps: how far the wheel comes down, and where it would lift off."""
    style.use_style()
    table = in_degrees(results).load()
    table = table.assign_coords(spin=-table["phi_dot_start"]).swap_dims(phi_dot_start="spin")
    sides = {"x": "spin", "y": "theta_start", "add_labels": False}
    maps = {"levels": [0, 5, 15, 30, 45, 60, 75], "cmap": "cividis", "extend": "max"}
    scale = {"label": f"smallest angle to the ground within {study.stop_time:g} s [deg]"}
    panels = table["lowest"].plot.contourf(**sides, **maps, col="s", figsize=(7.2, 3.7), cbar_kwargs=scale)
    for ax, s in zip(panels.axs.flat, table["s"].values, strict=True):
        lifts = {"levels": [-np.inf, 0.0], "colors": [style.VERMILLION], "extend": "neither", "add_colorbar": False}
        table["N"].sel(s=s).plot.contourf(ax=ax, **sides, **lifts)
        ax.axvline(critical_spin(PAPER), color="white", linestyle="--")
        ax.plot(2.0, 75.0, "o", markersize=5, markerfacecolor="white", markeredgecolor=style.INK)
        style.note(ax, "paper", (2.0, 75.0), (-6, 3), color="white", fontsize=8, ha="right")
        ax.text(2.2, 22, "critical spin", color="white", rotation=90, ha="center", va="center", fontsize=8)
        ax.set(xscale="log", yticks=range(15, 90, 15), xlabel=r"initial spin $|\dot\varphi|$ [rad/s]")
        ax.set_xticks([0.1, 1, 10], ["0.1", "1", "10"])
        ax.set_title(f"rolling resistance $s$ = {s:g} m", fontsize=9)
    panels.axs[0, 0].set_ylabel(r"initial angle $\theta$ [deg]")
    ends = {"handles": [Patch(color=style.VERMILLION, label="lifts off")], "labelcolor": "white"}
    panels.axs[0, 1].legend(**ends, loc="lower left")
    return panels.fig
