"""Shared by the examples' figures: two maps side by side, initial theta over initial spin."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from scipy.spatial import KDTree

from wheelfmu.diagrams import style
from wheelfmu.fmu.values import scale
from wheelfmu.truth import closed_forms
from wheelfmu.truth.reference import Wheel

from .dataset import study_of
from .plan import Status, quantities

PAPER = (2.0, 75.0)  # |phi_dot| in rad/s and theta in degrees of the paper's scenes
HEIGHT = 92.0  # mm, of a figure
FATES = {  # ends of a run
    Status.flat: (style.INK, "lies flat"),
    Status.lifted_off: (style.VERMILLION, "lifts off"),
    Status.grip: (style.PURPLE, "needs more grip"),
    Status.jammed: (style.GREEN, "jams"),
    Status.refused: (style.GREY, "refused"),
    Status.failed: (style.GREY, "failed"),
}
LEAST = 0.004  # of a map: a smaller region has no label
NARROW = 0.05  # of the frame: from here to a region's nearest edge its label is upright


def wheel_of(table: xr.Dataset) -> dict[str, float]:
    """The wheel of the study whose results these are; of a body with the moments that follow from its mass and size."""
    own = next(study_of(table).starts(quantities()))
    return {field.name: own[field.name] for field in fields(Wheel)}


def critical_spin(wheel: Mapping[str, float]) -> float:
    """|omega_z| [rad/s] above which upright straight rolling is stable."""
    return closed_forms.critical_spin(Wheel(**wheel))


def label_regions(ax: Axes, x: np.ndarray, y: np.ndarray, inside: np.ndarray, text: str) -> None:
    """A word in the middle of a region of a map, which is also its widest place."""
    if inside.mean() <= LEAST:
        return
    shares = ax.transAxes.inverted().transform(ax.transData.transform(np.column_stack([x.ravel(), y.ravel()])))
    found, rest = shares[inside.ravel()], np.concatenate([shares[~inside.ravel()], [[2, 2]]])
    apart = np.minimum(KDTree(rest).query(found)[0], np.minimum(found, 1 - found).min(axis=1))
    (across, up), narrow = found[int(np.argmax(apart))], apart.max() < NARROW
    if narrow:  # its wheels stand at the frame, and it ends half-way to the next ones
        across, up = across + (rest[:, 0].min() - across) / 4, 0.5
    look: style.Look = {"color": "white", "ha": "center", "va": "center", "fontsize": 8, "linespacing": 0.9}
    words = text if narrow else text.replace(" ", "\n")
    ax.text(float(across), float(up), words, rotation=90 * narrow, transform=ax.transAxes, **look)


def two_maps(
    small: xr.Dataset,
    name: str,
    tones: str,
    levels: Sequence[float],
    text: str,
    dress: Callable[[Axes], None],
    side: int = 1,
) -> tuple:
    """Maps of the variable `name`, for the free wheel and for the one with friction, and a scale; figure and axes.

    Where the normal force `N` falls below zero the wheel lifts off: flat colours of FATES, as for other ends of a run.
    Boundaries run between the wheels, where the interpolated variable has its level.

    tones: the colour map, in steps, one tone between each two levels and one above the last.
    text: of the scale, with {} for the runs' length in s.
    dress: sets the axis of the spin.
    side: of the paper's mark on which its name stands, 1 right, -1 left.
    """
    style.use_style()
    fig = style.figure_mm(style.PAGE, HEIGHT)
    axes = [style.axes_mm(fig, 14.0 + 75.0 * k, 14.0, 70.0, HEIGHT - 24.0) for k in range(2)]
    colours = style.mpl.colormaps[tones].resampled(len(levels))
    look: style.Look = {"cmap": colours, "norm": BoundaryNorm(levels, len(levels), extend="max"), "extend": "max"}
    faster = scale(wheel_of(small), s=-1)
    start = PAPER[0] * faster, PAPER[1]
    for ax, s in zip(axes, small["s"].values, strict=True):
        one = small.sel(s=s).transpose("theta_start", "phi_dot_start")
        ax.set(ylim=(0, 90), yticks=range(0, 91, 15), xlabel=r"initial spin $|\dot\varphi|$ [rad/s]")
        dress(ax)
        spin, angle, values = to_the_edges(ax, one, one[name].values)
        shades = ax.contourf(spin, angle, np.minimum(values, 2 * levels[-1]), levels, **look)
        regions = {code: (one["status"].values == code) * 1.0 - 0.5 for code in FATES if code != Status.lifted_off}
        if "N" in one:
            regions[Status.lifted_off] = -one["N"].values
        x, y = np.meshgrid(np.abs(one["phi_dot_start"]), np.degrees(one["theta_start"]))
        for code, field in regions.items():
            if (field > 0).any():
                tone, word = FATES[code]
                ax.contourf(*to_the_edges(ax, one, field), [0, np.inf], colors=[tone])
                label_regions(ax, x, y, field > 0, word)
        ax.set_title("no rolling friction" if s == 0 else f"rolling friction, $s$ = {s:.3g} m", fontsize=9)
        ax.plot(*start, marker="o", markersize=5, markerfacecolor="white", markeredgecolor=style.INK)
        paper = "paper" if faster == 1 else "paper, scaled"
        style.note(ax, paper, start, (6 * side, 3), color="white", fontsize=8, ha="left" if side > 0 else "right")
    axes[0].set_ylabel(r"initial angle $\theta$ [deg]")
    axes[1].set_yticklabels([])
    bar = fig.colorbar(shades, cax=style.axes_mm(fig, 163.0, 14.0, 4.0, HEIGHT - 24.0), spacing="uniform")
    bar.set_label(text.format(study_of(small).stop_time))
    bar.ax.tick_params(size=0)
    return fig, axes


def to_the_edges(ax: Axes, one: xr.Dataset, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Spin, angle and a field that go on as they are from the outer wheels to the frame."""
    spin, angle = np.abs(one["phi_dot_start"].values), np.degrees(one["theta_start"].values)
    order = np.argsort(spin)
    wide = [np.concatenate([[low], x, [high]]) for x, (low, high) in ((spin[order], ax.get_xlim()), (angle, (0, 90)))]
    return wide[0], wide[1], np.pad(values[:, order], 1, mode="edge")
