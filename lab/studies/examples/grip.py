"""How much friction rolling without slip needs: the largest mu_required within 10 s, and where it exceeds 0.8.

`./scripts/study grip` runs it and draws the map; `--publish` writes the figure into docs/figures.
"""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from lab.studies import Study
from lab.studies.dataset import in_degrees
from wheelfmu.diagrams import style

SIDE = 100
study = Study(
    grid={
        "s": [0.0, 0.03],  # m; the paper's two scenes
        "theta_start": np.radians(90 * (np.arange(SIDE) + 0.5) / SIDE),
        "phi_dot_start": -12 * (np.arange(SIDE) + 0.5) / SIDE,  # rad/s, rolling towards e1
    },
    values={"keep_contact": 1.0},
    measures={"mu": "max(mu_required)"},
    interval=0.002,
)
DRY_ASPHALT = 0.8  # a usual coefficient of friction of a tyre


def draw(results: xr.Dataset) -> Figure:
    """Two maps in steps, with a line at 0.8."""
    style.use_style()
    table = in_degrees(results).load()
    table = table.assign_coords(spin=-table["phi_dot_start"]).swap_dims(phi_dot_start="spin")
    sides = {"x": "spin", "y": "theta_start", "add_labels": False}
    maps = {"levels": [0, 0.2, 0.4, 0.6, DRY_ASPHALT, 1, 2, 5], "cmap": "viridis", "extend": "max"}
    scale = {"label": rf"largest $\mu_\mathrm{{required}}$ within {study.stop_time:g} s (white line: {DRY_ASPHALT})"}
    panels = table["mu"].plot.contourf(**sides, **maps, col="s", figsize=(7.2, 3.7), cbar_kwargs=scale)
    for ax, s in zip(panels.axs.flat, table["s"].values, strict=True):
        table["mu"].sel(s=s).plot.contour(ax=ax, **sides, levels=[DRY_ASPHALT], colors="white", linewidths=1.4)
        ax.plot(2.0, 75.0, "o", markersize=5, markerfacecolor="white", markeredgecolor=style.INK)
        style.note(ax, "paper", (2.0, 75.0), (6, 3), color="white", fontsize=8)
        ax.set(yticks=range(15, 90, 15), xlabel=r"initial spin $|\dot\varphi|$ [rad/s]")
        ax.set_title(f"rolling resistance $s$ = {s:g} m", fontsize=9)
    panels.axs[0, 0].set_ylabel(r"initial angle $\theta$ [deg]")
    return panels.fig
