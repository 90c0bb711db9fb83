"""How much friction rolling without slip needs: the largest mu_required within 10 s, and where it exceeds 0.8.

`./scripts/study grip` runs it and draws the map; `--publish` writes the figure into docs/figures.
"""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from lab.studies import Study
from lab.studies.drawing import to_the_edges, two_maps, wheel_of
from wheelfmu.diagrams import style
from wheelfmu.fmu.values import scale

SIDE = 100
study = Study(
    grid={
        "s": [0.0, 0.03],  # m; the paper's two scenes
        "theta_start": np.radians(90 * (np.arange(SIDE) + 0.5) / SIDE),
        "phi_dot_start": -12 * (np.arange(SIDE) + 0.5) / SIDE,  # rad/s, rolling towards e1
    },
    values={"keep_contact": 1.0},  # the normal force goes on smoothly through zero
    measures={"mu": "max(mu_required)", "N": "min(lambda_3)"},
    interval=0.002,
)
DRY_ASPHALT = 0.8  # a usual coefficient of friction of a tyre
LEVELS = [0, 0.2, 0.4, 0.6, DRY_ASPHALT, 1, 2, 5]


def table(results: xr.Dataset) -> xr.Dataset:
    """Status, the largest mu_required to four decimals, and the least N [N]."""
    mu = results["mu"].round(4).astype("f4").assign_attrs(units="1", long_name="Largest mu_required")
    return results[["status"]].load().assign(mu=mu, N=results["N"].astype("f4"))


def draw(small: xr.Dataset, stem: Path) -> Path:
    """Two maps in steps, with a line at 0.8."""
    faster = scale(wheel_of(small), s=-1)

    def dress(ax: Axes) -> None:
        ax.set_xlim(0, 12 * faster)

    text = r"largest $\mu_\mathrm{{required}}$ within {:.3g} s (white line: 0.8)"
    fig, axes = two_maps(small, "mu", "viridis", LEVELS, text, dress)
    for ax, s in zip(axes, small["s"].values, strict=True):
        field = to_the_edges(ax, small.sel(s=s), small["mu"].sel(s=s).values)
        ax.contour(*field, levels=[DRY_ASPHALT], colors="white", linewidths=1.4)
    return style.save_png(fig, stem.with_suffix(".png"))
