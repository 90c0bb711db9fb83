"""The paper's six diagrams, each drawn into axes that the caller has placed.

Fig. 1-3: no rolling friction; Fig. 4-6: rolling friction, with the transitions of the exact law.
Fixed axes X, Y, Z, Z up; rad and rad/s, with degrees on a second axis for theta.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch
from matplotlib.ticker import AutoMinorLocator, MultipleLocator
from numpy.typing import NDArray

from plotting import style
from plotting.scene import Array, Scene

THETA_MARKS = (55, 45, 40, 35, 30)  # degrees, written along the arc of Fig. 3
SUBDIVISION = 4  # drawn points per row in Fig. 6
PSI_DOT = r"$\dot\psi$"
PHI_DOT = r"$\dot\varphi$"
_LEADER = {"arrowstyle": "-", "linewidth": 0.5, "shrinkA": 0.0, "shrinkB": 2.5}


def draw_position(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 1, 4: X_O over time."""
    _time_axis(ax, scene, friction)
    ax.plot(scene.time, scene["X_O"], color=style.BLUE)
    ax.set_ylabel(r"position $X_O$ [m]")
    step = 0.4 if friction else 0.2
    ax.yaxis.set_major_locator(MultipleLocator(step))
    ax.yaxis.set_minor_locator(AutoMinorLocator(2))
    lowest = np.floor(scene["X_O"].min() / step - 0.05) * step
    ax.set_ylim(lowest, max(0.0, scene["X_O"].max()) + 0.02 * abs(lowest))


def draw_tilt(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 2, 5: theta over time, rad on the left and degrees on the right."""
    _time_axis(ax, scene, friction)
    ax.plot(scene.time, scene["theta"], color=style.BLUE)
    ax.set_ylim(0.0, np.pi / 2)
    ax.set_ylabel(r"angle $\theta$ [rad]")
    ax.yaxis.set_major_locator(MultipleLocator(0.5))
    ax.yaxis.set_minor_locator(MultipleLocator(0.1))
    degrees = ax.secondary_yaxis("right", functions=(np.degrees, np.radians))
    degrees.set_ylabel(r"$\theta$ [deg]")
    degrees.yaxis.set_major_locator(MultipleLocator(15))
    degrees.spines["right"].set_visible(True)


def draw_rates(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 3, 6: phi_dot over psi_dot."""
    ax.set_xlabel(rf"precession rate {PSI_DOT} [rad/s]")
    ax.set_ylabel(rf"spin rate {PHI_DOT} [rad/s]")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MultipleLocator(10 if friction else 4))
        axis.set_minor_locator(AutoMinorLocator(2))
    if friction:
        _friction_rates(ax, scene)
    else:
        _free_arc(ax, scene)


def _time_axis(ax: Axes, scene: Scene, friction: bool) -> None:
    """Time in s over the whole scene; with friction, its events behind the curve."""
    ax.set_xlim(scene.time[0], scene.time[-1])
    ax.set_xlabel("time $t$ [s]")
    ax.xaxis.set_major_locator(MultipleLocator(2))
    ax.xaxis.set_minor_locator(MultipleLocator(1))
    if friction:
        _mark_events(ax, scene)


def _mark_events(ax: Axes, scene: Scene) -> None:
    """A band per stick phase; a tick at the top for each change of sign of omega_z."""
    for begin, end in scene.stick_phases():
        ax.axvspan(begin, end, color=style.BAND, linewidth=0, zorder=0)
    ax.vlines(
        scene.reversals(),
        0.955,
        1.0,
        transform=ax.get_xaxis_transform(),
        color=style.VERMILLION,
        linewidth=0.8,
        zorder=1,
    )


def _free_arc(ax: Axes, scene: Scene) -> None:
    """The rates depend on theta alone: one arc, run to and fro, with theta written along it.

    All rows are drawn in the order of theta: one clean stroke, and a zigzag if the rates ever
    left the arc.
    """
    rows = np.argsort(scene["theta"])
    ax.plot(scene["psi_dot"][rows], scene["phi_dot"][rows], color=style.BLUE, linewidth=1.1)
    swing = slice(0, _first_turn(scene["theta"]) + 1)
    psi_dot, phi_dot = scene["psi_dot"][swing], scene["phi_dot"][swing]
    theta = np.degrees(scene["theta"][swing])
    named = {angle: rf"${angle}°$" for angle in THETA_MARKS if theta[-1] + 1 < angle < theta[0] - 1}
    named |= {
        theta[0]: rf"$\theta = {theta[0]:.0f}°$, start",
        theta[-1]: f"{theta[-1]:.1f}°, lowest",
    }
    for angle, name in named.items():
        at = tuple(np.interp(-angle, -theta, rate) for rate in (psi_dot, phi_dot))
        end = angle in (theta[0], theta[-1])
        ax.plot(
            *at,
            "o",
            color=style.BLUE,
            markersize=4.0 if end else 2.8,
            markerfacecolor=style.BLUE if end else "white",
            markeredgewidth=0.8,
        )
        if angle == theta[-1]:
            style.note(ax, name, at, (-5, -4), ha="right")
        else:
            style.note(ax, name, at, (4.5, 2.5))
    _to_and_fro(ax, psi_dot, phi_dot)
    ax.margins(0.07)


def _first_turn(theta: Array) -> int:
    """Row of the first lowest theta."""
    rising = np.flatnonzero(np.diff(theta) > 0)
    return int(rising[0]) if rising.size else len(theta) - 1


def _to_and_fro(ax: Axes, x: Array, y: Array) -> None:
    """A double arrow beside the middle of the arc."""
    span = np.ptp(x)
    a, b = (int(np.argmin(abs(x - part * span))) for part in (0.36, 0.64))
    shift = 0.055 * span
    ends = [(x[i] - shift, y[i] - shift) for i in (a, b)]
    ax.add_patch(
        FancyArrowPatch(
            *ends,
            arrowstyle="<|-|>",
            mutation_scale=6,
            color=style.GREY,
            linewidth=0.7,
            shrinkA=0,
            shrinkB=0,
        )
    )
    middle = np.mean(ends, axis=0)
    style.note(ax, "run to and fro", middle, (-4, -4), ha="right", va="top", color=style.GREY)


def _friction_rates(ax: Axes, scene: Scene) -> None:
    """The rates spiral in; stick phases are thick. The inset stretches the narrow bundle."""
    time, psi_dot, phi_dot = scene.smooth(SUBDIVISION, "time", "psi_dot", "phi_dot")
    stick = np.any([(time > begin) & (time < end) for begin, end in scene.stick_phases()], axis=0)
    _with_stick(ax, psi_dot, phi_dot, stick)
    ax.set_xlim(-6.0, None)
    for row, offset, line in ((0, (-4.0, -2.3), None), (-1, (-12.0, -26.0), _LEADER)):
        instant = rf"$t = {time[row]:g}$" + (" s" if time[row] else "")
        at = (psi_dot[row], phi_dot[row])
        style.note(ax, instant, at, offset, ha="right", arrowprops=line)
    inset = ax.inset_axes((0.59, 0.60, 0.39, 0.40))
    _with_stick(inset, psi_dot, phi_dot + psi_dot, stick)
    inset.yaxis.tick_right()
    inset.yaxis.set_label_position("right")
    inset.spines["left"].set_visible(False)
    inset.spines["right"].set_visible(True)
    inset.set_xlabel(rf"{PSI_DOT} [rad/s]", fontsize=7.5, labelpad=1)
    inset.set_ylabel(rf"{PHI_DOT} + {PSI_DOT} [rad/s]", fontsize=7.5, labelpad=3)
    inset.xaxis.set_major_locator(MultipleLocator(10))
    inset.yaxis.set_major_locator(MultipleLocator(1))
    inset.tick_params(labelsize=7)


def _with_stick(ax: Axes, x: Array, y: Array, stick: NDArray[np.bool_]) -> None:
    """A curve with its stick phases thick, its start (dot) and its end (square) marked."""
    ax.plot(x, y, color=style.BLUE, linewidth=0.7)
    held = np.where(stick, y, np.nan)
    ax.plot(x, held, color=style.VERMILLION, linewidth=1.8, solid_capstyle="butt")
    ax.plot(x[0], y[0], "o", color=style.BLUE, markersize=3.6)
    ax.plot(x[-1], y[-1], "s", color=style.INK, markersize=4, fillstyle="none")
