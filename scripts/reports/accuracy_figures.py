"""The figures of docs/results/accuracy.md: convergence, energy, drift, stability. PNG, one page wide."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from plotting import style
from support.motion import Run

from .markdown import number

Array = NDArray[np.float64]
Drift = dict[float, tuple[Array, Array]]
TABLE_UNIT = 1e-9  # s, last digit of the table of transitions
TONES = (style.VERMILLION, style.ORANGE, style.SKY, style.BLUE)


def pair(height: float = 62.0) -> tuple[Figure, Axes, Axes]:
    """Two diagrams side by side on a page."""
    fig = style.figure_mm(style.PAGE, height)
    left, right = (style.axes_mm(fig, x, 12.0, 72.0, height - 18.0) for x in (15.0, 107.0))
    return fig, left, right


def save(fig: Figure, file: Path) -> None:
    fig.savefig(file, dpi=150, metadata={"Software": None})


def convergence(rows: Array, file: Path) -> None:
    """rows: tolerance, error of the free scene, of the friction scene, of the energy, of the instants."""
    fig, left, right = pair(66.0)
    tolerance = rows[:, 0]
    left.loglog(tolerance, rows[:, 1], "o-", color=style.BLUE, ms=3, label="free")
    left.loglog(tolerance, rows[:, 2], "s-", color=style.VERMILLION, ms=3, label="friction")
    left.axhline(1e-6, color=style.GREY, lw=0.6, ls="--")
    left.text(2e-13, 1.3e-6, "asked at the default tolerance", color=style.GREY, fontsize=7)
    left.set_ylabel("largest headline error / range")
    right.loglog(tolerance, rows[:, 3], "o-", color=style.BLUE, ms=3, label="free: energy, relative")
    right.loglog(
        tolerance,
        np.maximum(rows[:, 4], TABLE_UNIT / 2),
        "s-",
        color=style.VERMILLION,
        ms=3,
        label="friction: instants, s",
    )
    right.loglog(tolerance, tolerance, color=style.GREY, lw=0.6, ls="--", label="the tolerance")
    for ax in (left, right):
        ax.axvline(1e-8, color=style.GREY, lw=0.4)
        ax.set_xlabel("tolerance (line: default)")
        ax.legend(loc="upper left")
    save(fig, file)


def energy(times: Array, free: Run, rough: Run, file: Path) -> None:
    fig = style.figure_mm(style.PAGE, 58.0)
    ax = style.axes_mm(fig, 15.0, 12.0, 160.0, 40.0)
    held = rough["friction_mode"] == 0
    ax.fill_between(times, 54, 77, where=held, color=style.BAND, lw=0, label=r"held at $\omega_z = 0$")
    ax.plot(times, free["E"], color=style.BLUE, label="$s = 0$")
    ax.plot(times, rough["E"], color=style.VERMILLION, label="$s = 0.03$ m")
    ax.set(xlim=(0, 10), ylim=(54, 77), xlabel="$t$, s", ylabel="$E$, J")
    ax.legend(loc="upper left", bbox_to_anchor=(0.3, 0.9))
    save(fig, file)


def drift(times: Array, plain: Drift, held: Drift, file: Path) -> None:
    """tolerance -> velocity and height off the constraints: of (24) as it stands, and of the FMU. Shows the height."""
    fig, left, right = pair()
    for tone, tolerance in zip(TONES, plain, strict=True):
        for ax, curves in ((left, plain), (right, held)):
            height = np.maximum(curves[tolerance][1], 1e-18)
            ax.semilogy(times, height, color=tone, lw=0.6, label=f"tolerance {number(tolerance)}")
    left.set_title("(24) as it stands", loc="left", fontsize=9)
    right.set_title("the FMU: stabilised", loc="left", fontsize=9)
    left.set_ylabel(r"$|Z_O - r_0 \sin\theta - r|$, m")
    for ax in (left, right):
        ax.set(xlim=(0, 10), ylim=(1e-18, 1e-3), xlabel="$t$, s")
    left.legend(loc="upper center", ncols=2)
    save(fig, file)


def stability(times: Array, leans: dict[float, Array], points: Array, expected: Array, file: Path) -> None:
    """points: omega_z and measured kappa^2; expected: that of the linearised equation."""
    fig, left, right = pair()
    for tone, (factor, lean) in zip((style.VERMILLION, style.BLUE), leans.items(), strict=True):
        left.semilogy(times, np.abs(lean), color=tone, label=rf"{factor} $\omega_c$")
    left.set(xlim=(0, 10), ylim=(1e-2, 1e3), xlabel="$t$, s", ylabel="|lean| / lean at the start")
    left.legend(loc="upper left")
    x, k = points[:, 0] ** 2, points[:, 1]
    right.plot(x, expected, color=style.GREY, lw=0.7, label="linearised equation")
    below = k < 0
    right.plot(x[below], k[below], "o", color=style.VERMILLION, ms=3, label="measured: grows")
    right.plot(x[~below], k[~below], "o", color=style.BLUE, ms=3, label="measured: swings")
    right.axhline(0, color=style.INK, lw=0.5)
    right.set(xlim=(0, None), xlabel=r"$\omega_z^2$, rad$^2$/s$^2$", ylabel=r"$\kappa^2$, 1/s$^2$")
    right.legend(loc="lower right")
    save(fig, file)
