"""How long a wheel stays up: started at 89 degrees with four spins, for a rolling resistance s from 0 to 0.1 m.

`./scripts/study uptime` runs it and draws it; `--publish` writes the figure into docs/figures.
It counts as up until it leans by more than 30 degrees. The spin of an upright wheel falls by s m g / (J_z + m R^2) per
second; dashed: the time at which it comes down to the critical spin.
"""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from lab.studies import Study
from wheelfmu.diagrams import style
from wheelfmu.truth.closed_forms import critical_spin, rolling_inertia
from wheelfmu.truth.scenes import PAPER

study = Study(
    grid={"phi_dot_start": [-3.0, -4.0, -6.0, -10.0], "s": np.linspace(0.0, 0.1, 401)},
    values={"theta_start": "89deg"},
    measures={"up_time": "first(plane_angle < 60deg)"},
    stop_time=60.0,
)


def draw(results: xr.Dataset) -> Figure:
    """Time over s, one curve per spin, with the closed form dashed."""
    style.use_style()
    fig = style.figure_mm(116.0, 80.0)
    ax = style.axes_mm(fig, 14.0, 12.0, 84.0, 62.0)
    colours = (style.GREEN, style.ORANGE, style.BLUE, style.PURPLE)
    s = results["s"].values
    slowing = s[1:] * PAPER.m * PAPER.g / rolling_inertia(PAPER)  # rad/s2, where s > 0
    beside = (-5, 3, 0, 0)  # points, so that labels do not touch
    for colour, apart, spin in zip(colours, beside, results["phi_dot_start"].values, strict=True):
        times = results["up_time"].sel(phi_dot_start=spin).values
        ax.plot(s[1:], (-spin - critical_spin(PAPER)) / slowing, "--", color=colour, linewidth=0.8)
        ax.plot(s, times, color=colour, linewidth=1.4)
        text = {"textcoords": "offset points", "va": "center", "color": colour}
        ax.annotate(f"{-spin:g} rad/s", (s[-1], times[-1]), xytext=(5, apart), **text)
    ax.set(yscale="log", xlim=(0, s[-1]), ylim=(0.2, 60.0), xlabel="rolling resistance $s$ [m]")
    ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    ax.yaxis.set_major_formatter("{x:g}")
    ax.set_ylabel("time until it leans by 30° [s]")
    ax.set_title("solid: the wheel; dashed: spin down to the critical spin", fontsize=8.5)
    return fig
