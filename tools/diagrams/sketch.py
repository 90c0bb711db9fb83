"""Lines, arrows, arcs and labels in space, drawn as vectors with the parts behind the wheel hidden.

Points are in fixed axes X, Y, Z in m; the axes of the drawing are those of diagrams.torus.View.
"""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch
from matplotlib.patheffects import withStroke

from diagrams import style
from diagrams.scene import Array
from diagrams.torus import View, Wheel

FINENESS = 2e-3  # m between the points at which a line is tested for visibility
HALO = [withStroke(linewidth=1.7, foreground="white")]


@dataclass(frozen=True)
class Sketch:
    """A drawing of one wheel in one view."""

    ax: Axes
    wheel: Wheel
    view: View

    def line(self, points: Array, color: str, width: float, hidden: float = 0.0, layer: float = 3.0) -> None:
        """A polyline; hidden: the opacity of its dashed part behind the wheel, which is left out without it."""
        points = _refine(np.asarray(points, dtype=float))
        covered = self.view.hides(self.wheel, points)[:, None]
        looks = [(~covered, width, {})]
        if hidden and covered.any():
            looks.append((covered, 0.8 * width, {"alpha": hidden, "dashes": (2.5, 1.8)}))
        for shown, linewidth, look in looks:
            part = np.where(shown, self.view.project(points), np.nan)
            self.ax.plot(*part.T, color=color, lw=linewidth, zorder=layer, solid_capstyle="butt", **look)

    def arrow(self, points: Array, color: str, width: float, hidden: float = 0.0) -> None:
        """A polyline with a head at its last point."""
        points = _refine(np.asarray(points, dtype=float))
        self.line(points, color, width, hidden)
        tail, tip = self.view.project(points[[-3, -1]])
        look = {"arrowstyle": "-|>,head_length=0.45,head_width=0.17", "mutation_scale": 8.0, "shrinkA": 0, "shrinkB": 0}
        self.ax.add_patch(FancyArrowPatch(tail, tip + 0.3 * (tip - tail), color=color, lw=0, zorder=3.0, **look))

    def dot(self, point: Array, color: str, size: float = 4.0) -> None:
        """A point, never hidden."""
        edge = {"markeredgecolor": "white", "markeredgewidth": 0.6}
        self.ax.plot(*self.view.project(point), "o", color=color, markersize=size, zorder=6, **edge)

    def label(self, point: Array, text: str, shift: tuple[float, float], **how: object) -> None:
        """Text centred at a point, moved by `shift` in typographic points."""
        look = {"ha": "center", "va": "center", "fontsize": 10.5, "path_effects": HALO} | how
        style.note(self.ax, text, self.view.project(point), shift, zorder=7, **look)


def _refine(points: Array) -> Array:
    """The same polyline with points at most about FINENESS apart."""
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    fine = np.linspace(0.0, way[-1], max(int(way[-1] / FINENESS) + 1, 4))
    return np.stack([np.interp(fine, way, column) for column in points.T], axis=1)
