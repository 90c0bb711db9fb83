"""Shared by the examples' figures: two maps side by side, initial theta over initial spin."""

import json
from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.colors import BoundaryNorm, ListedColormap

from wheelfmu.diagrams import style
from wheelfmu.fmu.values import moments, scale
from wheelfmu.studies import Status

PAPER = (2.0, 75.0)  # |phi_dot| in rad/s and theta in degrees of the paper's scenes
HEIGHT = 92.0  # mm, of a figure
FATES = {Status.flat: style.INK, Status.lifted_off: style.VERMILLION, Status.grip: style.PURPLE}  # ends of a run
WHEEL = {"m": 20.0, "r_0": 0.3, "r": 0.05, "J_x": 0.9, "J_z": 1.8, "g": 9.81}  # SI; the FMU's defaults


def rolling_inertia(m: float, r_0: float, r: float, J_z: float, **_: float) -> float:
    """J_z + m R^2 [kg.m2], R = r_0 + r: upright rolling, about the contact."""
    return J_z + m * (r_0 + r) ** 2


def studied(table: xr.Dataset) -> dict[str, object]:
    """The definition of the study whose results these are."""
    return json.loads(table.attrs["study"])


def wheel_of(table: xr.Dataset) -> dict[str, float]:
    """The study's wheel; of a body with the moments that follow from its mass and size."""
    study = studied(table)
    wheel = WHEEL | study["values"]
    return wheel | (moments(study["body"], *(wheel[name] for name in ("m", "r_0", "r"))) if study["body"] else {})


def upright_limit(w: Mapping[str, float]) -> float:
    """|omega_z| [rad/s] above which upright straight rolling is stable: (J_z + m R^2) J_z omega_z^2 = m g r_0 J_x."""
    return float(np.sqrt(w["m"] * w["g"] * w["r_0"] * w["J_x"] / (w["J_z"] * rolling_inertia(**w))))


def two_maps(small: xr.Dataset, name: str, tones: str, levels: list[float], text: str, side: int = 1) -> tuple:
    """Maps of the variable `name`, for the free wheel and for the one with friction, and a scale; figure and axes.

    Where a run ended early they have the flat colours of FATES.

    tones: the colour map, in steps, one tone between each two levels and one above the last.
    text: of the scale, with {} for the runs' length in s.
    side: of the paper's mark on which its name stands, 1 right, -1 left.
    """
    style.use_style()
    fig = style.figure_mm(style.PAGE, HEIGHT)
    axes = [style.axes_mm(fig, 14.0 + 75.0 * k, 14.0, 70.0, HEIGHT - 24.0) for k in range(2)]
    colours = style.mpl.colormaps[tones].resampled(len(levels))
    look = {"cmap": colours, "norm": BoundaryNorm(levels, len(levels), extend="max")}
    faster = scale(wheel_of(small), s=-1)
    start, beside = (PAPER[0] * faster, PAPER[1]), {"xytext": (6 * side, 3), "ha": "left" if side > 0 else "right"}
    spin, angle = np.abs(small["phi_dot_start"]), np.degrees(small["theta_start"])
    for ax, s in zip(axes, small["s"].values, strict=True):
        one = small.sel(s=s)
        shades = ax.pcolormesh(spin, angle, one[name].where(one["status"] == Status.reached), rasterized=True, **look)
        for code, colour in FATES.items():
            fate = one["status"].where(one["status"] == code)
            ax.pcolormesh(spin, angle, fate, cmap=ListedColormap([colour]), rasterized=True)
        ax.set_title("no rolling friction" if s == 0 else f"rolling friction, $s$ = {s:.3g} m", fontsize=9)
        ax.set(ylim=(0, 90), yticks=range(0, 91, 15), xlabel=r"initial spin $|\dot\varphi|$ [rad/s]")
        ax.plot(*start, marker="o", markersize=5, markerfacecolor="white", markeredgecolor=style.INK)
        paper = "paper" if faster == 1 else "paper, scaled"
        ax.annotate(paper, start, textcoords="offset points", color="white", fontsize=8, **beside)
    axes[0].set_ylabel(r"initial angle $\theta$ [deg]")
    axes[1].set_yticklabels([])
    bar = fig.colorbar(shades, cax=style.axes_mm(fig, 163.0, 14.0, 4.0, HEIGHT - 24.0), spacing="uniform")
    bar.set_label(text.format(studied(small)["stop_time"]))
    bar.ax.tick_params(size=0)
    return fig, axes
