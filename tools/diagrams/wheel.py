"""python -m diagrams.wheel: the picture of the wheel and its axes (wheel.svg, wheel.png), the FMU's icon (model.png).

The picture shows the paper's free wheel at one instant of results/free.csv, and the path of its contact
point up to then: fixed axes X, Y, Z; carrier axes e1, e2, e3; angles psi, theta, phi of (3);
r_0, r and O as in (27) and (32). Lines are vectors, dashed or left out behind the wheel.
"""

import sys
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from PIL import Image
from scipy.spatial.transform import Rotation

from diagrams import style
from diagrams.scene import Array, Scene, SceneError, read_scene
from diagrams.torus import Wheel, draw, project

ROOT = Path(__file__).resolve().parents[2]
POSE = ("psi", "theta", "phi", "X_O", "Y_O")
R_0, R = 0.3, 0.05  # m, (27)
INSTANT = 2.86  # s
WINDOW = np.array([-0.52, 1.12, -0.25, 0.75])  # m in the image plane: left, right, bottom, top
SIZE = 165.0, 165.0 / 1.64  # mm
DPI = 184
ICON = 176  # pixels
ICON_FILE = ROOT / "fmu-src" / "archive" / "model.png"
GROUND = ((-0.9, 0.3), (-0.4, 0.7))  # m, X and Y of the grid
CARRIER, ANGLE, PATH = "#00507C", "#00704F", style.VERMILLION
HEAD = {
    "arrowstyle": "-|>,head_length=0.45,head_width=0.17",
    "mutation_scale": 8.0,
    "shrinkA": 0,
    "shrinkB": 0,
    "lw": 0,
}
HALO = [withStroke(linewidth=1.7, foreground="white")]


@dataclass(frozen=True)
class Sketch:
    """A drawing of one wheel; points in fixed axes in m."""

    ax: Axes
    wheel: Wheel

    def line(self, points: Array, color: str, width: float, hidden: float = 0.0, layer: float = 3.0) -> Array:
        """Between two points, or a fine polyline, in the image; hidden: the opacity of its dashes behind the wheel."""
        points = np.linspace(*points, 300) if len(points) == 2 else points
        covered, image = self.wheel.hides(points)[:, None], project(points)
        dashed = {"alpha": hidden, "dashes": (2.5, 1.8)}
        for shown, linewidth, look in ((~covered, width, {}), (covered & (hidden > 0), 0.8 * width, dashed)):
            part = np.where(shown, image, np.nan)
            self.ax.plot(*part.T, color=color, lw=linewidth, zorder=layer, solid_capstyle="butt", **look)
        return image

    def arrow(self, points: Array, color: str, width: float, hidden: float = 0.0) -> None:
        """A line with a head at its last point."""
        tail, tip = self.line(points, color, width, hidden)[[-4, -1]]
        self.ax.annotate("", tip + 0.3 * (tip - tail), tail, arrowprops=HEAD | {"color": color}, zorder=3.0)

    def label(self, point: Array, text: str, shift: tuple[float, float], color: str = style.INK, **how: object) -> None:
        """Text centred at a point, moved by `shift` in typographic points."""
        look = {"ha": "center", "va": "center", "fontsize": 10.5, "path_effects": HALO, "zorder": 7} | how
        style.note(self.ax, text, project(point), shift, color=color, **look)

    def dot(self, point: Array, color: str, size: float = 4.0) -> None:
        """A point, never hidden."""
        self.ax.plot(*project(point), "o", mfc=color, mec="white", mew=0.6, markersize=size, zorder=6)


def draw_ground(sketch: Sketch, path: Array) -> None:
    """A grid of 0.1 m, the fixed axes, and the path of the contact point."""
    for along, (low, high) in enumerate(GROUND):
        ends = np.zeros((2, 3))
        ends[:, 1 - along] = GROUND[1 - along]
        for ends[:, along] in np.arange(round(10 * low), round(10 * high) + 1) / 10:
            sketch.line(ends, "#D9DCDF", 0.5, layer=0)
    sketch.line(path, PATH, 1.3, layer=1.5)
    leftmost = path[np.argmin(project(path)[:, 0])]
    sketch.label(leftmost, "path of the\ncontact point", (14, 0), PATH, ha="left", fontsize=8.5, linespacing=1.0)
    for axis, name, shift in zip(np.eye(3), "XYZ", ((-7, -5), (9, -3), (0, 8)), strict=True):
        sketch.arrow([0 * axis, 0.25 * axis], style.INK, 1.2)
        sketch.label(0.25 * axis, f"${name}$", shift)


def draw_wheel(sketch: Sketch) -> None:
    """O and the axes that do not spin; psi from X to e1, theta from Z to e3, phi from e1 to the body's x; r_0 and r."""
    wheel, X, Z = sketch.wheel, *np.eye(3)[[0, 2]]
    (e1, e2, e3), centre, phi = wheel.carrier.T, wheel.centre, wheel.phi % (2 * np.pi)
    tube, contact = centre - R_0 * e2, centre - R_0 * e2 - R * Z
    for end, name, shift in ((0.42 * e1, "1", (9, 2)), (0.19 * e2, "2", (-9, 3)), (0.50 * e3, "3", (10, 2))):
        sketch.arrow([centre, centre + end], CARRIER, 1.3, hidden=0.6)
        sketch.label(centre + end, rf"$\mathbf{{e}}_{name}$", shift, CARRIER)
    for start, end, name, shift in (
        (contact, 0.24 * X, "$X$", (-2, -6)),
        (contact, 0.24 * e1, r"$\mathbf{e}_1$", (4, 7)),
        (centre, 0.235 * Z, "$Z$", (-5, -2)),
        (centre, (R_0 - R) * wheel.rim(phi), "", (0, 0)),
    ):
        sketch.line([start, start + end], style.GREY, 0.7, hidden=0.5)
        sketch.label(start + end, name, shift, "#5A5A5A", fontsize=8.0)
    for middle, start, axis, angle, name, at, shift in (
        (contact, 0.20 * X, Z, wheel.psi % (2 * np.pi), r"$\psi$", 137, (8, -7)),
        (centre, 0.13 * Z, e1, wheel.theta, r"$\theta$", 60, (3, 8)),
        (centre, 0.20 * e1, e3, phi, r"$\varphi$", 45, (-8, -1)),
    ):
        arc = middle + Rotation.from_rotvec(np.outer(np.linspace(0.0, angle, 300), axis)).apply(start)
        sketch.arrow(arc, ANGLE, 1.1, hidden=0.5)
        sketch.label(arc[at], name, shift, ANGLE)
    for start, end, name, shift in ((centre, tube, "$r_0$", (-9, 0)), (tube, contact, "$r$", (-6, 0))):
        sketch.line([start, end], style.INK, 1.0, hidden=1.0, layer=5)
        sketch.label((start + end) / 2, name, shift)
    sketch.label(centre + (R_0 + 1.2 * R) * wheel.rim(phi), "$x$", (6, 5))
    sketch.label(centre, "$O$", (-9, -4))
    for point, color, size in ((centre, style.INK, 4.0), (tube, style.INK, 2.6), (contact, PATH, 4.0)):
        sketch.dot(point, color, size)


def draw_picture(scene: Scene, stem: Path) -> list[Path]:
    """docs/figures/wheel: the paper's free wheel at one instant, and its path up to then."""
    row = int(np.argmin(abs(scene.time - INSTANT)))
    wheel = Wheel(R_0, R, *(float(scene[name][row]) for name in POSE))
    fig = style.figure_mm(*SIZE)
    sketch = Sketch(whole(fig, WINDOW), wheel)
    draw(sketch.ax, wheel)
    time, x, y = scene.smooth(5, "time", "X_C", "Y_C")
    draw_ground(sketch, np.column_stack([x, y, 0 * x])[time <= INSTANT])
    draw_wheel(sketch)
    note = f"The paper’s free wheel at $t$ = {scene.time[row]:.2f} s. Grid: 0.1 m."
    style.text_mm(fig, 3.0, 3.0, note, fontsize=8.5, color=style.GREY)
    svg, png = style.save(fig, stem, DPI)
    Image.open(png).convert("RGB").quantize(256).save(png, optimize=True)  # it goes into the archive
    return [svg, png]


def whole(fig: Figure, window: Array) -> Axes:
    """Axes without a frame that fill the figure; window: left, right, bottom, top in m."""
    ax = fig.add_axes((0, 0, 1, 1), xlim=window[:2], ylim=window[2:])
    ax.set_axis_off()
    return ax


def draw_icon(path: Path) -> Path:
    """The FMU's icon: the wheel alone, leaning, transparent around it."""
    wheel = Wheel(R_0, 0.07, *np.radians([166.0, 66.0, 40.0]))  # a thicker tyre reads better when small
    (u, v), half = project(wheel.centre), 0.40  # m
    fig, large = Figure(figsize=(1, 1)), BytesIO()
    draw(whole(fig, (u - half, u + half, v - half, v + half)), wheel, mark=0.08, shadow=False)
    fig.savefig(large, dpi=4 * ICON, transparent=True)
    Image.open(large).resize((ICON, ICON), Image.Resampling.LANCZOS).save(path, optimize=True)
    return path


def main() -> None:
    """Both, from what `./scripts/run` left; a fault of the input is one line on stderr and exit status 1."""
    style.use_style()
    try:
        scene = read_scene(ROOT / "results" / "free.csv")
        print(*draw_picture(scene, ROOT / "docs" / "figures" / "wheel"), draw_icon(ICON_FILE), sep="\n")
    except SceneError as fault:
        sys.exit(f"picture: {fault}")


if __name__ == "__main__":
    main()
