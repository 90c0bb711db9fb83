"""How much friction rolling without slip needs: the largest mu_required within 10 s, and where it exceeds 0.8.

`./scripts/study grip` runs it and draws the map; `--publish` writes the figure into docs/figures.
"""

from pathlib import Path

import numpy as np
import xarray as xr

from wheelfmu.diagrams import style
from wheelfmu.fmu.values import scale
from wheelfmu.studies import Study
from wheelfmu.studies.drawing import two_maps, wheel_of

SIDE = 100
study = Study(
    grid={
        "s": [0.0, 0.03],  # m; the paper's two scenes
        "theta_start": np.radians(90 * (np.arange(SIDE) + 0.5) / SIDE),
        "phi_dot_start": -12 * (np.arange(SIDE) + 0.5) / SIDE,  # rad/s, rolling towards +e1
    },
    measures={"mu": "max(mu_required)"},
)
DRY_ASPHALT = 0.8  # a usual coefficient of friction of a tyre
LEVELS = [0, 0.2, 0.4, 0.6, DRY_ASPHALT, 1, 2, 5]


def table(results: xr.Dataset) -> xr.Dataset:
    """Status and the largest mu_required, to three decimals."""
    mu = results["mu"].round(3).astype("f4").assign_attrs(units="1", long_name="Largest mu_required")
    return results[["status"]].load().assign(mu=mu)


def draw(small: xr.Dataset, stem: Path) -> Path:
    """Two maps in steps, with a line at 0.8."""
    text = r"largest $\mu_\mathrm{{required}}$ within {:.3g} s (white line: 0.8)"
    fig, axes = two_maps(small, "mu", "viridis", LEVELS, text)
    spin, angle = -small["phi_dot_start"].values, np.degrees(small["theta_start"].values)
    for ax, s in zip(axes, small["s"].values, strict=True):
        ax.contour(spin, angle, small["mu"].sel(s=s), levels=[DRY_ASPHALT], colors="white", linewidths=1.4)
        ax.set_xlim(0, 12 * scale(wheel_of(small), s=-1))
    return style.save_png(fig, stem.with_suffix(".png"))
