"""How long a wheel stays up: started at 89 degrees with four spins, for a rolling resistance s from 0 to 0.1 m.

`./scripts/study uptime` runs it and draws it; `--publish` writes the figure into docs/figures.
It counts as up until it leans by more than 30 degrees. The spin of an upright wheel falls by s m g / (J_z + m R^2) per
second; dashed: the time at which it comes down to the critical spin.
"""

from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.ticker import LogLocator

from lab.studies import Study
from lab.studies.drawing import critical_spin, wheel_of
from wheelfmu.diagrams import style
from wheelfmu.fmu.values import scale
from wheelfmu.truth.closed_forms import rolling_inertia
from wheelfmu.truth.reference import Wheel

study = Study(
    grid={"phi_dot_start": [-3.0, -4.0, -6.0, -10.0], "s": np.linspace(0.0, 0.1, 401)},
    values={"theta_start": np.radians(89.0)},
    measures={"up_time": f"first(plane_angle < {np.radians(60.0)})"},
    stop_time=60.0,
)


def table(results: xr.Dataset) -> xr.Dataset:
    """Time until the wheel leans by 30 degrees, to a millisecond; NaN if it never does."""
    return results[["up_time"]].load().round(3)


def draw(small: xr.Dataset, stem: Path) -> Path:
    """Time over s, one curve per spin, with the closed form dashed."""
    style.use_style()
    fig = style.figure_mm(116.0, 80.0)
    ax = style.axes_mm(fig, 14.0, 12.0, 84.0, 62.0)
    colours = (style.GREEN, style.ORANGE, style.BLUE, style.PURPLE)
    wheel, s = wheel_of(small), small["s"].values
    beside = (-5, 3, 0, 0)  # points, so that labels do not touch
    slowing = s[1:] * wheel["m"] * wheel["g"] / rolling_inertia(Wheel(**wheel))  # rad/s2, where s > 0
    for colour, apart, spin in zip(colours, beside, small["phi_dot_start"].values, strict=True):
        times = small["up_time"].sel(phi_dot_start=spin).values
        ax.plot(s[1:], (-spin - critical_spin(wheel)) / slowing, color=colour, linestyle=(0, (4, 2)), linewidth=0.8)
        ax.plot(s, times, color=colour, linewidth=1.4)
        text = {"textcoords": "offset points", "va": "center", "color": colour}
        ax.annotate(f"{-spin:.3g} rad/s", (s[-1], times[-1]), xytext=(5, apart), **text)
    limits = scale(wheel, s=1) * np.array([0.2, 60.0])
    ax.set(yscale="log", xlim=(0, s[-1]), ylim=limits, xlabel="rolling resistance $s$ [m]")
    ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    ax.yaxis.set_major_formatter("{x:g}")
    ax.set_ylabel("time until it leans by 30° [s]")
    ax.set_title("solid: the wheel; dashed: spin down to the critical spin", fontsize=8.5)
    return style.save_png(fig, stem.with_suffix(".png"))
