"""python -m diagrams.wheel: the picture of the wheel and its axes (wheel.svg, wheel.png), the FMU's icon (model.png).

The picture shows the paper's free wheel at one instant of results/free.csv, and the path of its contact
point up to then: fixed axes X, Y, Z; carrier axes e1, e2, e3; angles psi, theta, phi of (3);
r_0, r and O as in (27) and (32). Orthographic, so that lengths in one direction compare.
"""

import sys
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image
from scipy.spatial.transform import Rotation

from diagrams import style
from diagrams.scene import Array, Scene, SceneError, read_scene
from diagrams.sketch import Sketch
from diagrams.torus import View, Wheel, draw

ROOT = Path(__file__).resolve().parents[2]
POSE = ("X_O", "Y_O", "psi", "theta", "phi")
R_0, R = 0.3, 0.05  # m, (27)
INSTANT = 2.86  # s
VIEW = View(azimuth=np.radians(36.0), elevation=np.radians(17.0))
WINDOW = np.array([-0.52, 1.12, -0.25, 0.75])  # m in the image plane: left, right, bottom, top
WIDTH = 165.0  # mm
PIXELS = 730  # per m in the image plane
ICON = 176  # pixels
SUBDIVISION = 5  # drawn points of the path per row
ICON_FILE = ROOT / "fmu-src" / "archive" / "model.png"
GROUND = ((-0.9, 0.3), (-0.4, 0.7))  # m, X and Y of the grid

CARRIER = "#00507C"
ANGLE = "#00704F"
PATH = style.VERMILLION
SMALL = {"fontsize": 8.0, "color": "#5A5A5A"}


def draw_ground(sketch: Sketch, path: Array) -> None:
    """A grid of 0.1 m, the fixed axes, and the path of the contact point."""
    for along, (low, high) in enumerate(GROUND):
        ends = np.zeros((2, 3))
        ends[:, 1 - along] = GROUND[1 - along]
        for ends[:, along] in np.arange(round(10 * low), round(10 * high) + 1) / 10:
            sketch.line(ends, "#D9DCDF", 0.5, layer=0)
    sketch.line(path, PATH, 1.3, layer=1.5)
    leftmost = path[np.argmin(sketch.view.project(path)[:, 0])]
    look = {"ha": "left", "fontsize": 8.5, "color": PATH, "linespacing": 1.0}
    sketch.label(leftmost, "path of the\ncontact point", (14, 0), **look)
    for axis, name, shift in zip(np.eye(3), "XYZ", ((-7, -5), (9, -3), (0, 8)), strict=True):
        sketch.arrow([0 * axis, 0.25 * axis], style.INK, 1.2)
        sketch.label(0.25 * axis, f"${name}$", shift)


def draw_carrier(sketch: Sketch) -> None:
    """O and the axes e1, e2, e3, which do not spin with the wheel."""
    centre = sketch.wheel.centre
    for i, (length, shift) in enumerate(((0.42, (9, 2)), (0.19, (-9, 3)), (0.50, (10, 2)))):
        tip = centre + length * sketch.wheel.carrier[:, i]
        sketch.arrow([centre, tip], CARRIER, 1.3, hidden=0.6)
        sketch.label(tip, rf"$\mathbf{{e}}_{i + 1}$", shift, color=CARRIER)
    sketch.dot(centre, style.INK)
    sketch.label(centre, "$O$", (-9, -4))


def draw_angles(sketch: Sketch) -> None:
    """psi from X to e1 on the ground, theta from Z to e3, phi from e1 to the body's x axis."""
    wheel, turn = sketch.wheel, np.linspace(0.0, 1.0, 80)

    def arc(start: Array, axis: Array, angle: float, radius: float, name: str, row: int, shift: tuple) -> None:
        way = Rotation.from_rotvec(np.outer(turn * angle, axis)).apply(start)
        sketch.arrow(centre + radius * way, ANGLE, 1.1, hidden=0.5)
        sketch.label(centre + radius * way[row], name, shift, color=ANGLE)

    def side(end: Array, name: str = "", shift: tuple = (0, 0)) -> None:
        sketch.line([centre, centre + end], style.GREY, 0.7, hidden=0.5)
        sketch.label(centre + end, name, shift, **SMALL)

    (e1, _, _), (X, _, Z) = wheel.carrier.T, np.eye(3)
    centre = wheel.contact
    side(0.24 * X, "$X$", (-2, -6))
    side(0.24 * e1, r"$\mathbf{e}_1$", (4, 7))
    arc(X, Z, wheel.psi % (2 * np.pi), 0.20, r"$\psi$", 36, (8, -7))
    centre = wheel.centre
    side(0.235 * Z, "$Z$", (-5, -2))
    arc(Z, e1, wheel.theta, 0.13, r"$\theta$", 16, (3, 8))
    phi = wheel.phi % (2 * np.pi)
    side((R_0 - R) * wheel.rim(phi))
    arc(e1, wheel.carrier[:, 2], phi, 0.20, r"$\varphi$", 12, (-8, -1))
    sketch.label(centre + (R_0 + 1.2 * R) * wheel.rim(phi), "$x$", (6, 5))


def draw_radii(sketch: Sketch) -> None:
    """r_0 from O to the tube's centre, r from there down to the contact point."""
    wheel = sketch.wheel
    for start, end, name, shift in (
        (wheel.centre, wheel.tube_centre, "$r_0$", (-9, 0)),
        (wheel.tube_centre, wheel.contact, "$r$", (-6, 0)),
    ):
        sketch.line([start, end], style.INK, 1.0, hidden=1.0, layer=5)
        sketch.label(0.5 * (start + end), name, shift)
    sketch.dot(wheel.tube_centre, style.INK, 2.6)
    sketch.dot(wheel.contact, PATH)


def draw_picture(scene: Scene, stem: Path) -> list[Path]:
    """docs/figures/wheel: the paper's free wheel at one instant, and its path up to then."""
    row = int(np.argmin(abs(scene.time - INSTANT)))
    wheel = Wheel(R_0, R, *(float(scene[name][row]) for name in POSE))
    left, right, bottom, top = WINDOW
    height = WIDTH * (top - bottom) / (right - left)
    fig = style.figure_mm(WIDTH, height)
    ax = whole(fig, WINDOW)
    draw(ax, wheel, VIEW)
    sketch = Sketch(ax, wheel, VIEW)
    x, y = (column[: SUBDIVISION * row + 1] for column in scene.smooth(SUBDIVISION, "X_C", "Y_C"))
    draw_ground(sketch, np.column_stack([x, y, 0 * x]))
    draw_carrier(sketch)
    draw_angles(sketch)
    draw_radii(sketch)
    note = f"The paper’s free wheel at $t$ = {scene.time[row]:.2f} s. Grid: 0.1 m."
    style.text_mm(fig, 3.0, 3.0, note, fontsize=8.5, color=style.GREY)
    svg, png = style.save(fig, stem, dpi=round(PIXELS * (right - left) / (WIDTH * style.MM)))
    Image.open(png).convert("RGB").quantize(256).save(png, optimize=True)  # it goes into the archive
    return [svg, png]


def whole(fig: Figure, window: Array) -> Axes:
    """Axes without a frame that fill the figure; window: left, right, bottom, top in m."""
    ax = fig.add_axes((0, 0, 1, 1))
    ax.set_axis_off()
    ax.set(xlim=window[:2], ylim=window[2:])
    return ax


def draw_icon(path: Path) -> Path:
    """The FMU's icon: the wheel alone, leaning, transparent around it."""
    pose = {"psi": np.radians(166.0), "theta": np.radians(66.0), "phi": np.radians(40.0)}
    wheel = Wheel(R_0, 0.07, 0.0, 0.0, **pose)  # a thicker tyre reads better when small
    (u, v), half = VIEW.project(wheel.centre), 0.40  # m
    fig, large = Figure(figsize=(1, 1)), BytesIO()
    draw(whole(fig, (u - half, u + half, v - half, v + half)), wheel, VIEW, mark=0.08, shadow=False)
    fig.savefig(large, dpi=4 * ICON, transparent=True)
    Image.open(large).resize((ICON, ICON), Image.Resampling.LANCZOS).save(path, optimize=True)
    return path


def main() -> int:
    """Both, from what `./scripts/run` left; a fault of the input is one sentence on stderr and exit status 1."""
    style.use_style()
    try:
        scene = read_scene(ROOT / "results" / "free.csv", ("time", "X_C", "Y_C", *POSE))
    except SceneError as fault:
        print(f"picture: {fault}", file=sys.stderr)
        return 1
    written = [*draw_picture(scene, ROOT / "docs" / "figures" / "wheel"), draw_icon(ICON_FILE)]
    print("\n".join(str(path) for path in written))
    return 0


if __name__ == "__main__":
    sys.exit(main())
