"""The map of fates: start angle theta against spin phi_dot, without and with rolling friction; 10 s each.

`./scripts/study fates` runs it and draws the map; `--publish` writes the figure into docs/figures.
"""

from pathlib import Path

import numpy as np
import xarray as xr

from wheelfmu.diagrams import style
from wheelfmu.fmu.values import scale
from wheelfmu.studies import Study
from wheelfmu.studies.drawing import two_maps, upright_limit, wheel_of

ANGLES, SPINS = 160, 125  # 2 * 160 * 125 = 40,000 wheels
study = Study(
    grid={
        "s": [0.0, 0.03],  # m; the paper's two scenes
        "theta_start": np.radians(90 * (np.arange(ANGLES) + 0.5) / ANGLES),
        "phi_dot_start": -np.r_[0.0, np.geomspace(0.05, 50.0, SPINS - 1)],  # rad/s, rolling towards +e1
    },
    measures={"lowest": "lowest"},
)
LEVELS = [0, 5, 15, 30, 45, 60, 75]  # degrees


def table(results: xr.Dataset) -> xr.Dataset:
    """Status, and the smallest angle between the wheel's plane and the ground [deg] to a tenth."""
    angle = np.degrees(results["lowest"]).round(1).astype("f4")
    angle = angle.assign_attrs(units="deg", long_name="Smallest angle to the ground")
    return results[["status"]].load().assign(smallest_angle=angle)


def draw(small: xr.Dataset, stem: Path) -> Path:
    """Two maps: how far the wheel comes down, and in flat colours where the run ends."""
    wheel = wheel_of(small)
    limit, faster = upright_limit(wheel), scale(wheel, s=-1)
    text = "smallest angle to the ground within {:.3g} s [deg]"
    fig, axes = two_maps(small, "smallest_angle", "cividis", LEVELS, text, side=-1)
    linear = 0.05 * faster  # rad/s, up to which the scale is linear
    ticks = [0, *(tick for tick in (0.1, 1, 10, 100) if tick >= 2 * linear)]
    for ax in axes:
        ax.axvline(limit, color="white", linewidth=1.0, linestyle=(0, (4, 3)))
        ax.set_xscale("symlog", linthresh=linear, linscale=0.3)
        ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        ax.set_xlim(0, 50 * faster)
        white = {"color": "white", "rotation": 90, "ha": "center", "va": "center", "fontsize": 8}
        ax.text(0.012 * faster, 45, "no spin: lies flat", **white)
        ax.text(limit * 0.82, 22, "limit of upright rolling", **white)
    axes[1].text(35 * faster, 9, "lifts\noff", **(white | {"rotation": 0, "linespacing": 0.9}))
    return style.save_png(fig, stem.with_suffix(".png"))
