"""The paper's six diagrams, each drawn into axes that the caller has placed.

Fig. 1-3: no rolling friction; Fig. 4-6: rolling friction, with the transitions of the exact law.
Fixed axes X, Y, Z, Z up; rad and rad/s, with degrees on a second axis for theta.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.patches import FancyArrowPatch
from matplotlib.ticker import AutoMinorLocator, MaxNLocator, MultipleLocator
from numpy.typing import NDArray

from diagrams import style
from diagrams.scene import Array, Scene

MARK_STEP = 5  # degrees of theta between the candidates for a mark along the arc of Fig. 3
MARK_SIZE = np.array([50.0, 10.0])  # points: width and height that the name of a mark takes
SUBDIVISION = 4  # drawn points per row in Fig. 6
PSI_DOT = r"$\dot\psi$"
PHI_DOT = r"$\dot\varphi$"
_LEADER = {"arrowstyle": "-", "linewidth": 0.5, "shrinkA": 0.0, "shrinkB": 2.5}


def draw_position(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 1, 4: X_O over time."""
    _time_axis(ax, scene, friction)
    ax.plot(scene.time, scene["X_O"], color=style.BLUE)
    ax.set_ylabel(r"position $X_O$ [m]")
    ax.margins(y=0.06)
    _ticks(ax.yaxis, 5)


def draw_tilt(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 2, 5: theta over time, rad on the left and degrees on the right."""
    _time_axis(ax, scene, friction)
    ax.plot(scene.time, scene["theta"], color=style.BLUE)
    past_upright = scene["theta"].max() > np.pi / 2
    ax.set_ylim(0.0, np.pi if past_upright else np.pi / 2)
    ax.set_ylabel(r"angle $\theta$ [rad]")
    ax.yaxis.set_major_locator(MultipleLocator(0.5))
    ax.yaxis.set_minor_locator(MultipleLocator(0.1))
    degrees = ax.secondary_yaxis("right", functions=(np.degrees, np.radians))
    degrees.set_ylabel(r"$\theta$ [deg]")
    degrees.yaxis.set_major_locator(MultipleLocator(30 if past_upright else 15))
    degrees.spines["right"].set_visible(True)


def draw_rates(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 3, 6: phi_dot over psi_dot."""
    ax.set_xlabel(rf"precession rate {PSI_DOT} [rad/s]")
    ax.set_ylabel(rf"spin rate {PHI_DOT} [rad/s]")
    for axis in (ax.xaxis, ax.yaxis):
        _ticks(axis, 5)
    if friction:
        _friction_rates(ax, scene)
    else:
        _free_arc(ax, scene)


def _ticks(axis: Axis, most: int) -> None:
    axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 4, 5, 10]))
    axis.set_minor_locator(AutoMinorLocator(2))


def _time_axis(ax: Axes, scene: Scene, friction: bool) -> None:
    """Time in s over the whole scene; with friction, its events behind the curve."""
    ax.set_xlim(scene.time[0], scene.time[-1])
    ax.set_xlabel("time $t$ [s]")
    _ticks(ax.xaxis, 6)
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
    if scene.value("J_x") != scene.value("J_y"):  # then they depend on phi too
        ax.plot(scene["psi_dot"], scene["phi_dot"], color=style.BLUE, linewidth=0.6)
        ax.margins(0.07)
        return
    rows = np.argsort(scene["theta"])
    ax.plot(scene["psi_dot"][rows], scene["phi_dot"][rows], color=style.BLUE, linewidth=1.1)
    ax.margins(0.12)
    ax.autoscale_view()
    arc = [scene[name][rows] for name in ("theta", "psi_dot", "phi_dot")]
    start = scene["theta"][0]
    ends = {np.degrees(arc[0][0]): "{:.1f}°, lowest", np.degrees(arc[0][-1]): "{:.1f}°, highest"}
    ends = {angle: name for angle, name in ends.items() if abs(angle - np.degrees(start)) > 0.05}
    ends |= {np.degrees(start): r"$\theta = {:.0f}°$, start"}
    taken: list[Array] = []
    for angle, name in ends.items():
        _mark(ax, angle, name.format(angle), arc, taken, end=True)
    first = MARK_STEP * np.ceil(np.degrees(arc[0][0]) / MARK_STEP)
    for angle in np.arange(first, np.degrees(arc[0][-1]), MARK_STEP):
        _mark(ax, angle, rf"${angle:g}°$", arc, taken, end=False)
    _to_and_fro(ax, *arc[1:])


def _mark(ax: Axes, angle: float, name: str, arc: list[Array], taken: list[Array], end: bool) -> None:
    """A dot on the arc with theta beside it, unless it would overlap one that is there."""
    at = tuple(float(np.interp(np.radians(angle), arc[0], rate)) for rate in arc[1:])
    place = ax.transData.transform(at) * 72 / ax.figure.dpi  # points
    if not end and any((abs(place - other) < MARK_SIZE).all() for other in taken):
        return
    taken.append(place)
    ax.plot(
        *at,
        "o",
        color=style.BLUE,
        markersize=4.0 if end else 2.8,
        markerfacecolor=style.BLUE if end else "white",
        markeredgewidth=0.8,
    )
    # Names stand outside the axes' middle, so that they do not cross the arc.
    left = end and ax.transAxes.inverted().transform(ax.transData.transform(at))[0] > 0.6
    style.note(ax, name, at, (-5, -4) if left else (4.5, 2.5), ha="right" if left else "left")


def _to_and_fro(ax: Axes, x: Array, y: Array) -> None:
    """A double arrow beside the middle of the arc."""
    span = np.ptp(x)
    if span == 0:
        return
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
    ax.margins(x=0.2, y=0.1)
    ax.autoscale_view()
    for row, offset, line in ((0, (-4.0, -2.3), None), (-1, (-12.0, -26.0), _LEADER)):
        instant = rf"$t = {time[row]:.3g}$" + (" s" if time[row] else "")
        at = (psi_dot[row], phi_dot[row])
        style.note(ax, instant, at, offset, ha="right", arrowprops=line)
    if np.ptp(psi_dot) == 0:
        return
    shear = -np.sign(np.cos(scene["theta"].mean())) or -1.0
    inset = ax.inset_axes(_free_corner(ax, psi_dot, phi_dot))
    _with_stick(inset, psi_dot, phi_dot - shear * psi_dot, stick)
    inset.yaxis.tick_right()
    inset.yaxis.set_label_position("right")
    inset.spines["left"].set_visible(False)
    inset.spines["right"].set_visible(True)
    inset.set_xlabel(rf"{PSI_DOT} [rad/s]", fontsize=7.5, labelpad=1)
    inset.set_ylabel(rf"{PHI_DOT} {'+' if shear < 0 else '−'} {PSI_DOT} [rad/s]", fontsize=7.5, labelpad=3)
    _ticks(inset.xaxis, 4)
    _ticks(inset.yaxis, 5)
    inset.tick_params(labelsize=7)


def _free_corner(ax: Axes, x: Array, y: Array) -> tuple[float, float, float, float]:
    """Of the corners that an inset may take, the one that covers the least of the curve."""
    width, height = 0.39, 0.40
    corners = ((0.59, 0.60), (0.12, 0.60), (0.50, 0.12), (0.12, 0.12))
    u, v = ax.transAxes.inverted().transform(ax.transData.transform(np.column_stack([x, y]))).T

    def covered(corner: tuple[float, float]) -> int:
        return int(np.sum((u > corner[0]) & (u < corner[0] + width) & (v > corner[1]) & (v < corner[1] + height)))

    return (*min(corners, key=covered), width, height)


def _with_stick(ax: Axes, x: Array, y: Array, stick: NDArray[np.bool_]) -> None:
    """A curve with its stick phases thick, its start (dot) and its end (square) marked."""
    ax.plot(x, y, color=style.BLUE, linewidth=0.7)
    held = np.where(stick, y, np.nan)
    ax.plot(x, held, color=style.VERMILLION, linewidth=1.8, solid_capstyle="butt")
    ax.plot(x[0], y[0], "o", color=style.BLUE, markersize=3.6)
    ax.plot(x[-1], y[-1], "s", color=style.INK, markersize=4, fillstyle="none")
