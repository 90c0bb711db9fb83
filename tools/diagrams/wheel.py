"""python -m diagrams.wheel: the picture of the wheel and its axes (wheel.svg, wheel.png), the FMU's icon (model.png).

The picture shows the paper's free wheel at one instant of results/free.csv, and the path of its contact point up to
then: fixed axes X, Y, Z, Z up; carrier axes e1 (line of nodes), e2 (up the slope), e3 (axle); angles psi, theta, phi of
(3); r_0, r and O as in (27) and (32). The projection is orthographic, so that parallel lengths keep their ratios. The
wheel is an image; lines are vectors, solid below it and dashed above it.
"""

import sys
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from PIL import Image
from scipy.spatial.transform import Rotation

from diagrams import style
from diagrams.scene import Array, SceneError, read_scene
from diagrams.start_values import ROOT

INSTANT = 2.86  # s
WINDOW = (-0.52, 1.12, -0.25, 0.75)  # m in the image: left, right, bottom, top
WIDTH, DPI, ICON = 165.0, 184, 176  # mm; pixels per inch; pixels
X, Y, Z = np.eye(3)
# Unit vectors in fixed axes. The eye stands 36 deg from X towards Y and 17 deg above the ground, the lamp left of it.
EYE, RIGHT, UP = Rotation.from_euler("ZY", [36.0, -17.0], degrees=True).as_matrix().T
LAMP = (Z + 0.55 * (EYE - RIGHT)) / np.linalg.norm(Z + 0.55 * (EYE - RIGHT))
HALF = (LAMP + EYE) / np.linalg.norm(LAMP + EYE)  # normal of a surface that mirrors the lamp
TYRE, MARK, SHADOW = (0.72, 0.79, 0.86), (1.0, 0.66, 0.12), (0.0, 0.0, 0.0, 0.17)
INK, CARRIER, ANGLE, PATH = style.INK, "#00507C", "#00704F", style.VERMILLION
REFERENCE = {"color": "#5A5A5A", "width": 0.7, "arrow": False}
HEAD = {"arrowstyle": "-|>,head_length=0.45,head_width=0.17", "mutation_scale": 8, "shrinkA": 0, "shrinkB": 0, "lw": 0}


def project(points: Array) -> Array:
    """Image coordinates (right, up) in m."""
    return np.asarray(points) @ np.column_stack([RIGHT, UP])


class Wheel(NamedTuple):
    """A torus on the ground, of ring radius r_0 and tube radius r; m, rad."""

    r_0: float
    r: float
    angles: Sequence[float]  # psi, theta, phi of (3)
    place: Sequence[float] = (0.0, 0.0)  # X_O, Y_O

    def frame(self) -> Array:
        """Rows e1, e2, e3 in fixed axes, [psi][theta] of (3), and O, whose height follows from contact, (32)."""
        axes = Rotation.from_euler("ZX", self.angles[:2]).as_matrix().T
        return np.array([*axes, [*self.place, self.r_0 * np.sin(self.angles[1]) + self.r]])

    def image(self, window: Sequence[float], pixels: int, shadow: bool) -> Image.Image:
        """The wheel, transparent around it, `pixels` wide; window: left, right, bottom, top in m.

        Dense points of the surface are painted from the back to the front, on twice the pixels.
        """
        left, right, bottom, top = window
        scale = 2 * pixels / (right - left)
        around, turn = (np.linspace(0, 2 * np.pi, int(9 * size * scale)) for size in (self.r, self.r_0 + self.r))
        around, turn, (e1, e2, e3, centre) = around[:, None, None], turn[:, None], self.frame()
        outward = np.cos(turn + self.angles[2]) * e1 + np.sin(turn + self.angles[2]) * e2
        normal = np.cos(around) * outward + np.sin(around) * e3
        points = centre + self.r_0 * outward + self.r * normal
        order = np.argsort(points @ EYE, axis=None)
        colours = shaded(normal, np.where(np.cos(turn) > np.cos(0.06), MARK, TYRE)).reshape(-1, 4)[order]
        canvas = np.zeros((round((top - bottom) * scale), 2 * pixels, 4))
        for at, colour in [(points - points[..., 2:] / LAMP[2] * LAMP, SHADOW)] * shadow + [(points, colours)]:
            column, row = ((project(at) - [left, top]) * [scale, -scale]).astype(int).reshape(-1, 2)[order].T
            canvas[row, column] = colour
        return Image.fromarray(np.uint8(255 * canvas)).reduce(2)


def shaded(normal: Array, base: Array) -> Array:
    """RGBA in soft diffuse light, with a dark edge and a small highlight."""
    diffuse, facing, shine = (np.clip(normal @ to, 0.0, 1.0)[..., None] for to in (LAMP, EYE, HALF))
    edge = np.clip(facing / 0.35, 0.0, 1.0) ** 0.6
    shade = (0.45 + 0.11 * normal[..., 2:] + 0.52 * diffuse) * (0.45 + 0.55 * edge)
    return np.insert(np.clip(base * shade + 0.30 * shine**40, 0.0, 1.0), 3, 1.0, axis=-1)


def label(ax: Axes, point: Array, text: str, shift: Sequence[float], color: str = INK, size: float = 10.5) -> None:
    """Text centred at a point, moved by `shift` in typographic points."""
    halo = {"path_effects": [withStroke(linewidth=1.7, foreground="white")], "linespacing": 1.0}
    style.note(ax, text, project(point), shift, color=color, fontsize=size, ha="center", va="center", zorder=7, **halo)


def stroke(ax: Axes, line: Array, color: str, width: float = 1.2, arrow: bool = True, front: bool = False) -> None:
    """A polyline; unless it is in front, what the wheel hides of it is dashed."""
    image = project(np.linspace(*line, 300) if len(line) == 2 else line)
    ax.plot(*image.T, color=color, lw=width, zorder=3 if front else 1, solid_capstyle="butt")
    ax.plot(*image.T, color=color, lw=0.8 * width, zorder=3, alpha=0.7, dashes=(2.5, 1.8))
    if arrow:
        tail, tip = image[[-4, -1]]
        ax.annotate("", tip + 0.3 * (tip - tail), tail, arrowprops=HEAD | {"color": color}, zorder=3)


def draw_lines(ax: Axes, wheel: Wheel, path: Array) -> None:
    """A grid of 0.1 m, the path, fixed axes, axes that do not spin, r_0 and r; psi from X to e1, theta from Z to e3,
    phi from e1 to the body's x."""
    (e1, e2, e3, centre), (psi, theta, phi) = wheel.frame(), np.mod(wheel.angles, 2 * np.pi)
    x, tube = np.cos(phi) * e1 + np.sin(phi) * e2, centre - wheel.r_0 * e2
    contact = tube - wheel.r * Z
    grid = project(np.stack([*np.mgrid[-0.9:0.3:13j, -0.4:0.7:12j], np.zeros((13, 12))], axis=-1)).T
    for lines in (grid, grid.swapaxes(1, 2)):
        ax.plot(*lines, color="#D9DCDF", lw=0.5, zorder=0)
    ax.plot(*project(path).T, color=PATH, lw=1.3, zorder=1)
    for origin, end, look, name, shift in (
        (0 * X, 0.25 * X, {"color": INK}, "$X$", (-7, -5)),
        (0 * X, 0.25 * Y, {"color": INK}, "$Y$", (9, -3)),
        (0 * X, 0.25 * Z, {"color": INK}, "$Z$", (0, 8)),
        (centre, 0.42 * e1, {"color": CARRIER}, r"$\mathbf{e}_1$", (9, 2)),
        (centre, 0.19 * e2, {"color": CARRIER}, r"$\mathbf{e}_2$", (-9, 3)),
        (centre, 0.50 * e3, {"color": CARRIER, "front": True}, r"$\mathbf{e}_3$", (10, 2)),
        (contact, 0.24 * X, REFERENCE, "$X$", (-2, -6)),
        (contact, 0.24 * e1, REFERENCE, r"$\mathbf{e}_1$", (4, 7)),
        (centre, 0.235 * Z, REFERENCE, "$Z$", (-5, -2)),
        (centre, 0.25 * x, REFERENCE, "", (0, 0)),
    ):
        stroke(ax, [origin, origin + end], **look)
        label(ax, origin + end, name, shift, look["color"], 8.0 if look is REFERENCE else 10.5)
    for start, axis, angle, middle, name, at, shift in (
        (0.20 * X, Z, psi, contact, r"$\psi$", 137, (8, -7)),
        (0.13 * Z, e1, theta, centre, r"$\theta$", 60, (3, 8)),
        (0.20 * e1, e3, phi, centre, r"$\varphi$", 45, (-8, -1)),
    ):
        arc = middle + Rotation.from_rotvec(np.outer(np.linspace(0.0, angle, 300), axis)).apply(start)
        stroke(ax, arc, ANGLE)
        label(ax, arc[at], name, shift, ANGLE)
    stroke(ax, [centre, tube, contact], INK, arrow=False)
    label(ax, (centre + tube) / 2, "$r_0$", (-9, 0))
    label(ax, (tube + contact) / 2, "$r$", (-6, 0))
    label(ax, centre, "$O$", (-9, -4))
    label(ax, centre + 0.36 * x, "$x$", (6, 5))
    label(ax, path[np.argmin(path @ RIGHT)], "path of the\ncontact point", (42, 0), PATH, 8.5)
    dots = project([centre, tube, contact]).T
    ax.scatter(*dots, s=[16, 7, 16], c=[INK, INK, PATH], edgecolors="white", linewidths=0.6, zorder=6)


def main() -> None:
    """Both, from what `./scripts/run` left; a fault of the input is one line on stderr and exit status 1."""
    style.use_style()
    try:
        scene = read_scene(ROOT / "results" / "free.csv")
    except SceneError as fault:
        sys.exit(f"picture: {fault}")
    row = int(np.argmin(abs(scene["time"] - INSTANT)))
    angles, place = ([scene[name][row] for name in names] for names in (("psi", "theta", "phi"), ("X_O", "Y_O")))
    wheel = Wheel(scene.value("r_0"), scene.value("r"), angles, place)
    fig = style.figure_mm(WIDTH, WIDTH / 1.64)
    ax = fig.add_axes((0, 0, 1, 1))
    ax.set_axis_off()
    ax.imshow(wheel.image(WINDOW, round(WIDTH * style.MM * DPI), shadow=True), extent=WINDOW, zorder=2)
    time, x, y = scene.smooth(5, "time", "X_C", "Y_C")
    draw_lines(ax, wheel, np.column_stack([x, y, 0 * x])[time <= INSTANT])
    ax.set(xlim=WINDOW[:2], ylim=WINDOW[2:])
    note = f"The paper’s free wheel at $t$ = {scene['time'][row]:.2f} s. Grid: 0.1 m."
    style.text_mm(fig, 3.0, 3.0, note, fontsize=8.5, color=style.GREY)
    svg, png = style.save(fig, ROOT / "docs" / "figures" / "wheel", DPI)
    Image.open(png).convert("RGB").quantize(256, kmeans=1).save(png, optimize=True)  # it goes into the archive
    leaning = Wheel(0.3, 0.07, np.radians([166.0, 66.0, 40.0]))  # a thicker tyre reads better when small
    (u, v), half = project(leaning.frame()[3]), 0.40  # m
    icon = ROOT / "fmu-src" / "archive" / "model.png"
    leaning.image((u - half, u + half, v - half, v + half), ICON, shadow=False).save(icon, optimize=True)
    print(svg, png, icon, sep="\n")


if __name__ == "__main__":
    main()
