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
from diagrams.labels import Labels, dense, free_corner
from diagrams.scene import Array, Scene

MARK_STEP = 5  # degrees of theta between the candidates for a mark along the arc of Fig. 3
MARK_ROOM = np.array([50.0, 10.0])  # points: no second mark within this width and height
NARROW = 0.25  # a bundle is narrow, and shown sheared in an inset, if shearing leaves less of its height
SUBDIVISION = 4  # drawn points per row in Fig. 6
PSI_DOT = r"$\dot\psi$"
PHI_DOT = r"$\dot\varphi$"


def draw_position(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 1, 4: X_O over time."""
    _time_axis(ax, scene, friction)
    ax.plot(scene.time, scene["X_O"], color=style.BLUE)
    ax.set_ylabel(r"position $X_O$ [m]")
    ax.margins(y=0.06)
    _widen(ax, "y", scene["X_O"], 1e-4 * scene.value("r_0"))
    _ticks(ax.yaxis, 5)


def draw_tilt(ax: Axes, scene: Scene, friction: bool) -> None:
    """Fig. 2, 5: theta over time, rad on the left and degrees on the right."""
    _time_axis(ax, scene, friction)
    ax.plot(scene.time, scene["theta"], color=style.BLUE)
    past_upright = scene["theta"].max() > np.pi / 2 - 0.02  # a line at the frame cannot be seen
    ax.set_ylim(0.0, np.pi if past_upright else np.pi / 2)
    ax.set_ylabel(r"angle $\theta$ [rad]")
    ax.yaxis.set_major_locator(MultipleLocator(0.5))
    ax.yaxis.set_minor_locator(MultipleLocator(0.25 if past_upright else 0.1))
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


def _widen(ax: Axes, name: str, values: Array, least: float) -> None:
    """Values that differ by rounding alone are a straight line."""
    if np.ptp(values) < least:
        middle = float(values.mean())
        ax.set(**{f"{name}lim": (middle - 50 * least, middle + 50 * least)})


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


def still(scene: Scene) -> bool:
    """Whether the rates keep their values."""
    return max(np.ptp(scene["psi_dot"]), np.ptp(scene["phi_dot"])) <= 1e-9


def one_arc(scene: Scene) -> bool:
    """Whether the rates are a function of theta, and move."""
    return scene.value("J_x") == scene.value("J_y") and np.ptp(scene["psi_dot"]) > 1e-9


def _free_arc(ax: Axes, scene: Scene) -> None:
    """The rates depend on theta alone: one arc, run to and fro, with theta written along it.

    All rows are drawn in the order of theta: one clean stroke, and a zigzag if the rates ever
    left the arc.
    """
    if not one_arc(scene):
        x, y = scene["psi_dot"], scene["phi_dot"]
        ax.plot(x, y, color=style.BLUE, linewidth=0.6)
        ax.margins(0.07)
        if still(scene):
            _still_point(ax, x[0], y[0])
        return
    rows = np.argsort(scene["theta"])
    theta, x, y = arc = [scene[name][rows] for name in ("theta", "psi_dot", "phi_dot")]
    ax.plot(x, y, color=style.BLUE, linewidth=1.1)
    ax.margins(0.14)
    ax.autoscale_view()
    labels = Labels(ax, np.column_stack([x, y]))
    side = _to_and_fro(ax, labels, x, y)
    start = np.degrees(scene["theta"][0])
    ends = zip(np.degrees([theta[0], theta[-1]]), ("{:.1f}°, lowest", "{:.1f}°, highest"), strict=True)
    marks = {start: r"$\theta = {:.4g}°$, start"} | {angle: name for angle, name in ends if abs(angle - start) > 0.05}
    first = MARK_STEP * np.ceil(np.degrees(theta[0]) / MARK_STEP)
    taken: list[Array] = []
    for angle in [*marks, *np.arange(first, np.degrees(theta[-1]), MARK_STEP)]:
        at = tuple(float(np.interp(np.radians(angle), theta, rate)) for rate in arc[1:])
        place = ax.transData.transform(at) * 72 / ax.figure.dpi
        solid = len(taken) < len(marks)
        if not solid and any((abs(place - other) < MARK_ROOM).all() for other in taken):
            continue
        taken.append(place)
        _mark(ax, at, solid)
        labels.put((marks[angle] if solid else "${:g}°$").format(angle), at, side)


def _still_point(ax: Axes, x: float, y: float) -> None:
    """Rates that keep their values are one point."""
    _mark(ax, (x, y), solid=True)
    ax.set(xlim=(x - 1, x + 1), ylim=(y - 1, y + 1))
    style.note(ax, "both rates keep\ntheir values", (x, y), (6, 6))


def _mark(ax: Axes, at: tuple[float, float], solid: bool) -> None:
    """A dot on the arc."""
    face, size = (style.BLUE, 4.0) if solid else ("white", 2.8)
    ax.plot(*at, "o", color=style.BLUE, markersize=size, markerfacecolor=face, markeredgewidth=0.8)


def _to_and_fro(ax: Axes, labels: Labels, x: Array, y: Array) -> float:
    """A double arrow beside the middle of the arc; the direction of the other side, in degrees."""
    to_dots = ax.transData.transform
    curve = dense(to_dots(np.column_stack([x, y])))
    a, b = (curve[int(part * (len(curve) - 1))] for part in (0.36, 0.64))
    along = (b - a) / max(np.hypot(*(b - a)), 1e-9)
    normal = np.array([-along[1], along[0]])
    normal *= -np.sign(normal @ [0.1, 1.0]) or 1.0  # below, where both sides are as free
    middle = curve[len(curve) // 2]
    if (middle - (a + b) / 2) @ normal > 1.0:
        normal = -normal  # the arc bends to this side
    shift = (11.0 * ax.figure.dpi / 72) * normal
    ends = [tuple(ax.transData.inverted().transform(end + shift)) for end in (a, b)]
    look = {"mutation_scale": 6, "color": style.GREY, "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0}
    ax.add_patch(FancyArrowPatch(*ends, arrowstyle="<|-|>", **look))
    labels.keep_free(np.array([a + shift, b + shift]))
    away = float(np.degrees(np.arctan2(normal[1], normal[0])))
    labels.put("run to and fro", tuple(np.mean(ends, axis=0)), away, color=style.GREY)
    return away + 180.0


def narrow(scene: Scene) -> bool:
    """Whether the rates run in a bundle that has to be sheared to be seen."""
    sheared = scene["phi_dot"] - _shear(scene) * scene["psi_dot"]
    return 0 < np.ptp(sheared) < NARROW * np.ptp(scene["phi_dot"])


def _shear(scene: Scene) -> float:
    """Slope of the bundle: omega_z = phi_dot + psi_dot cos(theta) is small, and so is the angle at which it lies."""
    return float(-np.sign(np.cos(scene["theta"].mean())) or -1.0)


def _friction_rates(ax: Axes, scene: Scene) -> None:
    """The rates spiral in; stick phases are thick. An inset stretches a narrow bundle."""
    time, psi_dot, phi_dot = scene.smooth(SUBDIVISION, "time", "psi_dot", "phi_dot")
    if still(scene):
        _still_point(ax, psi_dot[0], phi_dot[0])
        return
    stick = np.any([(time > begin) & (time < end) for begin, end in scene.stick_phases()], axis=0)
    _with_stick(ax, psi_dot, phi_dot, stick)
    ax.margins(x=0.2, y=0.1)
    ax.autoscale_view()
    for name, rate in (("x", psi_dot), ("y", phi_dot)):
        _widen(ax, name, rate, 0.01)
    inset = _sheared(ax, scene, psi_dot, phi_dot, stick) if narrow(scene) else None
    labels = Labels(ax, np.column_stack([psi_dot, phi_dot]))
    if inset is not None:
        box = inset.get_tightbbox()
        labels.boxes.append((box.x0, box.x1, box.y0, box.y1))
    for row, first in ((0, 180.0), (-1, -135.0)):
        labels.put(rf"$t = {time[row]:.3g}$" + (" s" if time[row] else ""), (psi_dot[row], phi_dot[row]), first)


def _sheared(ax: Axes, scene: Scene, psi_dot: Array, phi_dot: Array, stick: NDArray[np.bool_]) -> Axes:
    shear = _shear(scene)
    inset = ax.inset_axes(free_corner(ax, psi_dot, phi_dot))
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
    return inset


def _with_stick(ax: Axes, x: Array, y: Array, stick: NDArray[np.bool_]) -> None:
    """A curve with its stick phases thick, its start (dot) and its end (square) marked."""
    ax.plot(x, y, color=style.BLUE, linewidth=0.7)
    held = np.where(stick, y, np.nan)
    ax.plot(x, held, color=style.VERMILLION, linewidth=1.8, solid_capstyle="butt")
    ax.plot(x[0], y[0], "o", color=style.BLUE, markersize=3.6)
    ax.plot(x[-1], y[-1], "s", color=style.INK, markersize=4, fillstyle="none")
