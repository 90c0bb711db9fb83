"""The panels of ./scripts/run, each drawn into axes: the paper's three, the path, the ground's share, and of other runs
energy, forces and slip.

Fixed axes X, Y, Z, Z up; rad and rad/s, with degrees on a second axis for theta. Friction and brake leave marks at the
upper margin: a strip while omega_z is held, a tick for each change of its sign. A slide has a strip at the lower margin
between thin lines where sliding starts and stops. A panel returns the clauses by which the caption explains it.
"""

from typing import Any

import numpy as np
import textalloc
from matplotlib.axes import Axes
from matplotlib.ticker import AutoMinorLocator, MaxNLocator, NullLocator, ScalarFormatter
from numpy.typing import ArrayLike

from wheelfmu.diagrams import style
from wheelfmu.diagrams.scene import Array, Scene

MARK_STEP = 5  # degrees of theta between the candidates for a mark along an arc
MARK_ROOM = np.array([0.28, 0.06])  # of the axes: no second mark within this width and height
NARROW = 0.25  # a bundle is narrow, and shown sheared in an inset, if shearing leaves less of its height
INSET = (0.39, 0.40)  # width and height in the axes
MOST = 2.0  # coefficient of friction that no road has; without a normal force no coefficient would do
ALIKE = 0.005  # of an axis: two curves are one to the eye
DENSE, SOLID = 60, 400  # turns of a curve over time: from here on a thin line; from here on its envelope
PSI_DOT = r"$\dot\psi$"
PHI_DOT = r"$\dot\varphi$"
LETTER = {
    "lambda_x": r"$\lambda_x$",
    "lambda_y": r"$\lambda_y$",
    "slip_x": "$u_x$",
    "slip_y": "$u_y$",
}


def draw_position(ax: Axes, scene: Scene) -> list[str]:
    """Fig. 1, 4: X_O over time."""
    marks = _time_axis(ax, scene)
    ax.set_ylabel(r"position $X_O$ [m]")
    _scale(ax.yaxis, 5, scene["X_O"], 1e-3 * scene.value("r_0"))
    return marks + _over_time(ax, scene["time"], scene["X_O"])


def draw_tilt(ax: Axes, scene: Scene) -> list[str]:
    """Fig. 2, 5: theta over time, rad on the left and degrees on the right."""
    marks, theta = _time_axis(ax, scene), scene["theta"]
    ax.set_ylabel(r"angle $\theta$ [rad]")
    degrees = ax.secondary_yaxis("right", functions=(np.degrees, np.radians))
    degrees.set_ylabel(r"$\theta$ [deg]")
    degrees.spines["right"].set_visible(True)
    _scale(ax.yaxis, 7, theta, 1e-3, steps=(1, 2, 5, 10))
    wide = np.ptp(theta) >= np.pi / 6
    _scale(degrees.yaxis, 6, steps=(1, 1.5, 3, 10) if wide else (1, 2, 5, 10))
    if wide:
        ax.set_ylim(0.0, np.pi if theta.max() > np.pi / 2 - 0.02 else np.pi / 2)  # a line at the frame cannot be seen
    return marks + _over_time(ax, scene["time"], theta)


def draw_path(ax: Axes, scene: Scene) -> list[str]:
    """The path of the contact point from above, in one scale."""
    x, y = scene["X_C"], scene["Y_C"]
    _track(ax, x, y, scene.slides, style.colour("slide"))
    ax.set(xlabel="$X$ [m]", ylabel="$Y$ [m]")
    least, middle = 0.1 * scene.value("r_0"), [(along.min() + along.max()) / 2 for along in (x, y)]
    ax.update_datalim(np.add.outer([-least, least], middle))  # set limits could not follow the aspect
    for axis in (ax.xaxis, ax.yaxis):
        _scale(axis, 5)
    ax.set_aspect("equal", adjustable="datalim")
    if scene.value("slope") > 0:
        down = scene.value("slope_direction") + np.pi
        step = 12.0 * np.cos(down), 12.0 * np.sin(down)
        arrow = {"arrowstyle": "<|-", "color": style.GREY, "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", (0.12, 0.83), step, "axes fraction", "offset points", arrowprops=arrow)
        ax.text(0.02, 0.93, "downhill", transform=ax.transAxes, color=style.GREY, fontsize=style.NOTE)
    return ["purple on the path: it slides"] * bool(scene.slides.any())


def draw_ground(ax: Axes, scene: Scene) -> list[str]:
    """Above, the normal force; below, the friction coefficient that rolling needs, and the two that are set."""
    marks, colour = _time_axis(ax, scene), style.colour("mu")
    right, force, mu_max, mu_slide = ax.twinx(), scene["lambda_3"], scene.value("mu_max"), scene.value("mu_slide")
    if "jams" in scene.ending:  # there it grows without bound
        force = np.append(force[:-1], np.nan)
    needed = np.where(scene.slides, np.nan, scene["mu_required"])
    left_out = bool((needed > MOST).any() or not np.isfinite(scene["mu_required"]).all())
    needed = np.where(needed <= MOST, needed, np.nan)
    right.spines["right"].set_visible(True)
    ax.set_ylabel("normal force $N$ [N]", color=style.colour("N"))
    right.set_ylabel(r"$\mu$ required", color=colour)
    marks += _over_time(ax, scene["time"], force, style.colour("N"))
    if np.isfinite(needed).any():
        marks += _over_time(right, scene["time"], needed, colour)
        at, most = scene.peak(needed)
        if not left_out and not (mu_max and most > 0.8 * mu_max):
            style.note(right, f"{most:.4g}", (at, most), (2, 3), color=colour, **_inward(scene, at))
    right.set_ylim(0.0, 1.15 * max(np.nanmax(needed, initial=0.05), mu_max))
    _scale(ax.yaxis, 5, force, 0.02 * scene.value("m") * scene.value("g"))
    _scale(right.yaxis, 5)
    for side, below, above in ((ax, 1.1, 0.0), (right, 0.0, 1.1)):
        low, high = side.get_ylim()
        side.set_yticks([tick for tick in side.get_yticks() if low <= tick <= high])
        side.yaxis.set_minor_locator(NullLocator())
        side.set_ylim(low - below * (high - low), high + above * (high - low))
    limits = {mu_max: r"$\mu_\mathrm{max}$", mu_slide: r"$\mu_\mathrm{slide}$"}
    if mu_max == mu_slide:
        limits = {mu_max: r"$\mu_\mathrm{max} = \mu_\mathrm{slide}$"}
    for limit, text in limits.items():
        if limit:
            right.axhline(limit, color=colour, linewidth=0.8, linestyle=(0, (4, 2)))
            below = text.endswith(r"slide}$") and len(limits) > 1
            place = {"xycoords": right.get_yaxis_transform(), "va": "top" if below else "bottom"}
            style.note(right, text, (0.02, limit), (0, -2 if below else 2), color=colour, **place)
    return marks + [rf"$\mu$ above {MOST:g} is left out"] * left_out


def draw_slip(ax: Axes, scene: Scene) -> list[str]:
    """The slip along and across the rolling direction."""
    ax.set_ylabel("slip [m/s]")
    marks, parts = _time_axis(ax, scene), {"slip_x": "along", "slip_y": "across"}
    for name, side in parts.items():
        marks += _over_time(ax, scene["time"], scene[name], style.colour(name))
        most = int(np.argmax(abs(scene[name])))
        high = scene[name][most] > 0
        place = {"va": "bottom" if high else "top", **_inward(scene, scene["time"][most])}
        shift = (2, 3 if high else -3)
        if abs(scene[name][most]) <= 1e-3 * scene.slip.max():  # a line along the axis, which the other one may cover
            most, place, shift = -1, {"va": "bottom", "ha": "right"}, (-2, 2)
        at, color = (scene["time"][most], scene[name][most]), style.colour(name)
        style.note(ax, f"{side}, {LETTER[name]}", at, shift, color=color, **place)
    _scale(ax.yaxis, 5, np.array([scene[name] for name in parts]), 0.01)
    ax.margins(y=0.2)
    return marks


def draw_forces(ax: Axes, scene: Scene) -> list[str]:
    """The ground's force in the wheel's axes, what stays zero left out; dashed, how much of it friction allows."""
    ax.set_ylabel("force of the ground [N]")
    marks, weight = _time_axis(ax, scene), scene.value("m") * scene.value("g")
    forces = {LETTER[name]: (scene[name], style.colour(name)) for name in ("lambda_x", "lambda_y")}
    forces["$N$"] = (scene["lambda_3"], style.colour("N"))
    shown = {text: of for text, of in forces.items() if abs(of[0]).max() > 1e-6 * weight}
    limit = scene["lambda_3"] * np.where(scene.slides, scene.value("mu_slide"), scene.value("mu_max"))
    if scene.value("mu_max") > 0:
        for side in (1, -1):
            if any((side * force).max() > 0.3 * limit.min() for text, (force, _) in shown.items() if text != "$N$"):
                ax.plot(scene["time"], side * limit, color=style.GREY, linewidth=0.8, linestyle=(0, (4, 2)))
        marks.append(r"dashed: $\mu N$, with $\mu_\mathrm{max}$ while it rolls, $\mu_\mathrm{slide}$ while it slides")
    sides = {LETTER["lambda_x"]: "along $e_1$", LETTER["lambda_y"]: "to the left"}
    words = ", ".join(f"{letter} {side}" for letter, side in sides.items() if letter in shown)
    return [*marks, *_curves(ax, scene, shown), *[words] * bool(words)]


def draw_energy(ax: Axes, scene: Scene) -> list[str]:
    """The total energy of the wheel: what resistance, brake and slip take from it, and what loads do on it."""
    marks = _time_axis(ax, scene)
    ax.set_ylabel("energy $E$ [J]")
    _scale(ax.yaxis, 5, scene["E"], 1e-6)
    ax.margins(y=0.1)
    return marks + _over_time(ax, scene["time"], scene["E"])


def _inward(scene: Scene, at: float) -> dict[str, str]:
    """A text's side of an instant, so that it stays in the axes."""
    return {"ha": "right" if at > np.mean(scene["time"][[0, -1]]) else "left"}


def _curves(ax: Axes, scene: Scene, curves: dict[str, tuple[Array, str]]) -> list[str]:
    """Curves over time, each with its name where it is farthest from the others; those that coincide share one."""
    marks, values = [], np.array([curve for curve, _ in curves.values()])
    for curve, colour in curves.values():
        marks += _over_time(ax, scene["time"], curve, colour)
    _scale(ax.yaxis, 5, values, 1e-3)
    ax.margins(y=0.14)
    range_of_all = max(np.ptp(ax.get_ylim()), 1e-300)
    named: list[tuple[list[str], Array, str]] = []
    for text, (curve, colour) in curves.items():
        same = next((names for names, other, _ in named if abs(other - curve).max() < ALIKE * range_of_all), None)
        if same is None:
            named.append(([text], curve, colour))
        else:
            same.append(text)
    for k, (names, curve, colour) in enumerate(named):
        others = np.array([other for j, (_, other, _) in enumerate(named) if j != k]).reshape(-1, len(curve))
        gap = abs(others - curve).min(axis=0) if len(others) else np.ones(len(curve))
        inside = slice(len(gap) // 20, max(-len(gap) // 8, 1 - len(gap)))
        at = inside.start + int(np.argmax(gap[inside]))
        above = curve[at] >= others[:, at].max() if len(others) else True
        place = {"va": "bottom" if above else "top", "color": colour}
        style.note(ax, " = ".join(names), (scene["time"][at], curve[at]), (3, 2 if above else -2), **place)
    return marks


def draw_rates(ax: Axes, scene: Scene) -> list[str]:
    """Fig. 3, 6: phi_dot over psi_dot; stick phases are thick. The texts beside the curve come with write_rates."""
    ax.set_xlabel(rf"precession rate {PSI_DOT} [rad/s]")
    ax.set_ylabel(rf"rate {PHI_DOT} [rad/s]")
    x, y, stick = _rates(scene)
    if scene.still:
        ax.plot(x[:1], y[:1], "o", color=style.BLUE, markersize=4.0)
    elif scene.one_arc:
        ax.plot(x, y, color=style.BLUE, linewidth=1.1)
    else:
        _track(ax, x, y, stick)
    ax.margins(0.14)
    for axis, rate in ((ax.xaxis, x), (ax.yaxis, y)):
        _scale(axis, 5, rate, 1.0 if scene.still else 1e-3 + 1e-5 * abs(rate).max())
    if scene.one_arc and not scene.still:
        return [r"both rates depend on $\theta$ alone, so the curve is a single arc, traced back and forth"]
    # omega_z = phi_dot + psi_dot cos(theta) is small, and so is the angle at which a narrow bundle lies.
    shear = float(-np.sign(np.cos(scene["theta"].mean())) or -1.0)
    marks = [r"thick: held at $\omega_z = 0$"] * bool(stick.any())
    if scene.still or np.ptp(y - shear * x) >= NARROW * np.ptp(y):
        return marks
    _draw_inset(ax, x, y, stick, shear)
    return [*marks, "inset: the same motion sheared, which opens the narrow bundle"]


def write_rates(ax: Axes, scene: Scene) -> None:
    """What is written beside the curve: theta along an arc, else the times of start and end."""
    x, y, _ = _rates(scene)
    marks = _marks(ax, scene) if scene.one_arc and not scene.still else {
        (x[0], y[0]): "both rates keep\ntheir values" if scene.still else "$t = 0$",
        **({} if scene.still else {(x[-1], y[-1]): f"$t = {scene['time'][-1]:.3g}$ s"}),
    }  # fmt: skip
    lines = [np.column_stack([x, y])]
    for inset in ax.child_axes:
        left, bottom, right, top = ax.transData.inverted().transform_bbox(inset.get_tightbbox() or inset.bbox).extents
        lines += [np.array([(left, h), (right, h)]) for h in np.linspace(bottom, top, 12)]
    write_beside(ax, marks, lines)


def write_beside(ax: Axes, texts: dict[tuple[float, float], str], lines: list[Array]) -> None:
    """Texts beside points of data, clear of the lines and of each other."""
    ax.set(xlim=ax.get_xlim(), ylim=ax.get_ylim())  # no line moves them any more
    x, y = np.transpose([*texts])
    curves: style.Look = {"x_lines": [line[:, 0] for line in lines], "y_lines": [line[:, 1] for line in lines]}
    look: style.Look = {"textsize": style.NOTE, "textcolor": style.INK, "draw_lines": False}
    place: style.Look = {"min_distance": 0.015, "max_distance": 0.25, "nbr_candidates": 200}
    textalloc.allocate(ax, x, y, [*texts.values()], x_scatter=x, y_scatter=y, **curves, **look, **place)


def _rates(scene: Scene) -> tuple[Array, Array, Array]:
    """psi_dot, phi_dot and whether it sticks: in the order of the tilt where they run on one arc, else of time.

    In the order of the tilt a run to and fro is one clean stroke, and a zigzag if the rates ever left the arc.
    """
    if scene.one_arc or scene.still:
        rows = np.argsort(scene["theta"])
        return scene["psi_dot"][rows], scene["phi_dot"][rows], np.zeros(len(rows), dtype=bool)
    return scene["psi_dot"], scene["phi_dot"], scene.mode == 0


def _marks(ax: Axes, scene: Scene) -> dict[tuple[float, float], str]:
    """theta along the arc: at its start and ends, and at whole steps where there is room; their dots are drawn."""
    rows = np.argsort(scene["theta"])
    theta, x, y = (scene[name][rows] for name in ("theta", "psi_dot", "phi_dot"))
    ends = -scene.peak(-scene["theta"])[1], scene.peak(scene["theta"])[1]
    start, low, high = np.degrees([scene["theta"][0], *ends])
    named = {start: f"$\\theta = {start:.4g}°$, start"}
    named |= {at: f"{at:.1f}°, {end}" for at, end in ((low, "lowest"), (high, "highest")) if abs(at - start) > 0.05}
    texts: dict[tuple[float, float], str] = {}
    taken: list[Array] = []
    for angle in [*named, *np.arange(MARK_STEP * np.ceil(low / MARK_STEP), high, MARK_STEP)]:
        at: Any = tuple(float(np.interp(np.radians(angle), theta, rate)) for rate in (x, y))
        place = ax.transAxes.inverted().transform(ax.transData.transform(at))
        solid = angle in named
        if not solid and any((abs(place - other) < MARK_ROOM).all() for other in taken):
            continue
        taken.append(place)
        ax.plot(*at, "o", color=style.BLUE, markersize=4.0 if solid else 2.8,
                markerfacecolor=style.BLUE if solid else "white", markeredgewidth=0.8)  # fmt: skip
        texts[at] = named.get(angle, f"${angle:g}°$")
    return texts


def _draw_inset(ax: Axes, x: Array, y: Array, stick: Array, shear: float) -> None:
    """The bundle sheared, above it: the axes grow there, so that it covers nothing of the curve."""
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    width, height = 0.1 * (right - left), 0.1 * (top - bottom)
    ax.set(xlim=(left, right + width) if shear < 0 else (left - width, right), ylim=(bottom, top + height))
    inset = ax.inset_axes((0.58 if shear < 0 else 0.06, 0.59, *INSET))
    _track(inset, x, y - shear * x, stick)
    inset.yaxis.tick_right()
    inset.yaxis.set_label_position("right")
    inset.spines["left"].set_visible(False)
    inset.spines["right"].set_visible(True)
    inset.set_xlabel(rf"{PSI_DOT} [rad/s]", fontsize=7.5, labelpad=1)
    inset.set_ylabel(rf"{PHI_DOT} {'+' if shear < 0 else '−'} {PSI_DOT} [rad/s]", fontsize=7.5, labelpad=3)
    _scale(inset.xaxis, 4)
    _scale(inset.yaxis, 5)
    inset.tick_params(labelsize=7)


def _track(ax: Axes, x: Array, y: Array, thick: Array | bool = False, color: str = style.colour("held")) -> None:
    """A curve that may cross itself: a part of it thick, its start a dot, its end a square."""
    ax.plot(x, y, color=style.BLUE, linewidth=min(0.7, 80 / max(_turns(x), _turns(y), 1)))
    ax.plot(x, np.where(thick, y, np.nan), color=color, linewidth=1.8, solid_capstyle="butt")
    ax.plot(x[0], y[0], "o", color=style.BLUE, markersize=3.6)
    ax.plot(x[-1], y[-1], "s", color=style.INK, markersize=4, fillstyle="none")


def _time_axis(ax: Axes, scene: Scene) -> list[str]:
    """Time in s over the whole scene, and behind the curve the marks of friction and of slides, which it explains."""
    ax.set(xlim=scene["time"][[0, -1]], xlabel="time $t$ [s]")
    _scale(ax.xaxis, 6)
    place: dict[str, Any] = {"transform": ax.get_xaxis_transform()}
    slide = style.colour("slide")
    style.strip(ax, scene.edges, scene.mode == 0, style.colour("held"), top=True)
    ax.vlines(scene.reversals, 0.955, 1.0, color=style.INK, linewidth=0.8, zorder=2, **place)
    marks = [r"orange at the top: held at $\omega_z = 0$"] * bool((scene.mode == 0).any())
    marks += [r"ticks at the top: $\omega_z$ changes sign"] * bool(scene.reversals.size)
    if scene.slides.any():
        style.strip(ax, scene.edges, scene.slides, slide)
        ax.vlines(scene.turns, 0.0, 1.0, color=slide, linewidth=0.5, alpha=0.6, zorder=0, **place)
        marks.append("purple at the bottom: it slides; thin lines: it starts and stops sliding")
    return marks


def _over_time(ax: Axes, time: Array, values: Array, color: str = style.BLUE) -> list[str]:
    """A curve over time; where its swings lie too close to be seen apart, their highest and lowest values as two
    lines, and the room between them filled."""
    turns = _turns(values)
    if turns < SOLID:
        ax.plot(time, values, color=color, linewidth=min(1.0, max(0.35, DENSE / 1.5 / max(turns, 1))))
        return []
    parts = np.array_split(np.arange(len(time)), min(SOLID // 2, turns // 4))  # a swing or more in each
    middle, low, high = np.array([(time[rows].mean(), values[rows].min(), values[rows].max()) for rows in parts]).T
    ax.fill_between(middle, low, high, color=color, alpha=0.2, linewidth=0)
    for edge in (low, high):
        ax.plot(middle, edge, color=color, linewidth=0.7)
    look = {"ha": "right", "va": "bottom", "color": color}
    style.note(ax, "swings between two lines", (middle[-1], high[-1]), (-2, 3), **look)
    return ["swings too close to be drawn: their highest and lowest values"]


def _turns(values: Array) -> int:
    """How often a curve turns, rounding aside."""
    steps, rounding = np.diff(values), 1e-6 * np.ptp(values) + 1e-9 * abs(values).max() + 1e-12
    return int(np.count_nonzero(np.diff(np.sign(steps[abs(steps) > rounding]))))


def _scale(axis: Any, most: int, values: ArrayLike = (0,), least: float = 0, steps: tuple = (1, 2, 4, 5, 10)) -> None:
    """Few ticks, numbers in full: no offset or power of ten stands over the title. An axis is no narrower than `least`:
    what differs by rounding alone is a straight line."""
    axis.set_major_locator(MaxNLocator(most, steps=steps))
    axis.set_minor_locator(AutoMinorLocator(2))
    axis.set_major_formatter(full := ScalarFormatter(useOffset=False))
    full.set_scientific(False)
    if np.ptp(values) < least:
        middle = float(np.min(values) + np.max(values)) / 2
        axis.axes.set(**{f"{axis.axis_name}lim": (middle - least, middle + least)})
