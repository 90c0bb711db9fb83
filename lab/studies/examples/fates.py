"""The map of fates: start angle theta against spin phi_dot, without and with rolling resistance; 10 s each.

`./scripts/study fates` runs it and draws the map; `--publish` writes the figure into docs/figures.
"""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from lab.studies import Study
from lab.studies.drawing import critical_spin, two_maps, wheel_of
from wheelfmu.diagrams import style
from wheelfmu.fmu.values import scale

ANGLES, SPINS = 160, 125  # 2 * 160 * 125 = 40,000 wheels
study = Study(
    grid={
        "s": [0.0, 0.03],  # m; the paper's two scenes
        "theta_start": np.radians(90 * (np.arange(ANGLES) + 0.5) / ANGLES),
        "phi_dot_start": -np.r_[0.0, np.geomspace(0.05, 50.0, SPINS - 1)],  # rad/s, rolling towards e1
    },
    values={"keep_contact": 1.0},  # the normal force goes on smoothly through zero
    measures={"lowest": "lowest", "N": "min(lambda_3)"},
    interval=0.005,
)
LEVELS = [0, 5, 15, 30, 45, 60, 75]  # degrees


def table(results: xr.Dataset) -> xr.Dataset:
    """Status, the smallest angle between the wheel's plane and the ground [deg] to a hundredth, the least N [N]."""
    angle = np.degrees(results["lowest"]).round(2).astype("f4")
    angle = angle.assign_attrs(units="deg", long_name="Smallest angle to the ground")
    return results[["status"]].load().assign(smallest_angle=angle, N=results["N"].astype("f4"))


def draw(small: xr.Dataset, stem: Path) -> Path:
    """Two maps: how far the wheel comes down, and in flat colours where it lies flat or would lift off."""
    wheel = wheel_of(small)
    spin, faster = critical_spin(wheel), scale(wheel, s=-1)
    linear = 0.05 * faster  # rad/s, up to which the scale is linear
    ticks = [0, *(tick for tick in (0.1, 1, 10, 100) if tick >= 2 * linear)]

    def dress(ax: Axes) -> None:
        ax.set_xscale("symlog", linthresh=linear, linscale=0.3)
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        ax.set_xlim(0, 50 * faster)

    text = "smallest angle to the ground within {:.3g} s [deg]"
    fig, axes = two_maps(small, "smallest_angle", "cividis", LEVELS, text, dress, side=-1)
    for ax in axes:
        ax.axvline(spin, color="white", linewidth=1.0, linestyle=(0, (4, 3)))
        ax.text(spin * 0.82, 22, "critical spin", color="white", rotation=90, ha="center", va="center", fontsize=8)
    return style.save_png(fig, stem.with_suffix(".png"))
