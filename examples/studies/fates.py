"""The map of fates: start angle theta against spin phi_dot, without and with rolling friction. 80,000 wheels, 10 s each.

`./scripts/study fates` runs it and draws the map; `--publish` writes its data and its figure into docs/.
"""

from pathlib import Path

import numpy as np
import xarray as xr
from plotting import style
from study import Status, Study

SIDE = 200  # wheels along each axis
CELLS = (np.arange(SIDE) + 0.5) / SIDE
study = Study(
    grid={
        "s": [0.0, 0.03],  # m; the paper's two scenes
        "theta_start": np.radians(90 * CELLS),
        "phi_dot_start": -np.r_[0.0, np.geomspace(0.05, 50.0, SIDE - 1)],  # rad/s, rolling towards +e1
    },
    measures={"lowest": "min(theta)", "highest": "max(theta)"},
    interval=0.05,
)
LINEAR = 0.05  # rad/s; the axis of the spin is linear below and logarithmic above
PAPER = (2.0, 75.0)  # rad/s and degrees: the start of the paper's scenes


def table(results: xr.Dataset) -> xr.Dataset:
    """Status and smallest angle between the wheel's plane and the ground [deg], small enough to be kept in docs/."""
    small = results[["status"]].load()
    lean = np.degrees(np.minimum(results["lowest"], np.pi - results["highest"]))
    small["smallest_angle"] = lean.round(1).astype("f4").assign_attrs(units="deg", long_name="Smallest angle to the ground")
    return small.assign_attrs({name: str(value) for name, value in results.attrs.items()})


def upright_limit(m=20.0, r_0=0.3, r=0.05, J_x=0.9, J_z=1.8, g=9.81) -> float:
    """|phi_dot| [rad/s] above which upright straight rolling is stable: (J_z + m R^2) J_z phi_dot^2 = m g r_0 J_x."""
    return float(np.sqrt(m * g * r_0 * J_x / (J_z * (J_z + m * (r_0 + r) ** 2))))


def draw(small: xr.Dataset, stem: Path) -> list[Path]:
    """Two maps: how far the wheel goes down, and in flat colours where the model ends."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 84.0)
    spin, angle = -small["phi_dot_start"].values, np.degrees(small["theta_start"].values)
    for k, s in enumerate(small["s"].values):
        ax = style.axes_mm(fig, 14.0 + 75.0 * k, 15.0, 70.0, 58.0)
        one = small.sel(s=s)
        rolls = one["smallest_angle"].where(one["status"] == Status.reached)
        shades = ax.pcolormesh(spin, angle, rolls, vmin=0, vmax=90, cmap="cividis", rasterized=True)
        for status, colour in ((Status.flat, style.INK), (Status.lifted_off, style.VERMILLION)):
            fate = np.ma.masked_where(one["status"].values != status, np.ones(one["status"].shape))
            ax.pcolormesh(spin, angle, fate, cmap=style.mpl.colors.ListedColormap([colour]), rasterized=True)
        ax.axvline(upright_limit(), color="white", linewidth=1.0, linestyle=(0, (4, 3)))
        ax.plot(*PAPER, marker="o", markersize=5, markerfacecolor="white", markeredgecolor=style.INK)
        ax.set_xscale("symlog", linthresh=LINEAR, linscale=0.3)
        ax.set_xticks([0, 0.1, 1, 10], ["0", "0.1", "1", "10"])
        ax.set(xlim=(0, spin[-1]), ylim=(0, 90), yticks=range(0, 91, 15), xlabel=r"spin at the start $|\dot\varphi|$ [rad/s]")
        ax.set_title("no rolling friction" if s == 0 else f"rolling friction, $s$ = {s:g} m", fontsize=9)
        if k:
            ax.set_yticklabels([])
        else:
            ax.set_ylabel(r"angle at the start $\theta$ [deg]")
    bar = fig.colorbar(shades, cax=style.axes_mm(fig, 163.0, 15.0, 4.0, 58.0), ticks=range(0, 91, 15))
    bar.set_label("smallest angle to the ground within 10 s [deg]")
    return style.save(fig, stem)[1:]
