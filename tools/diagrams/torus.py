"""The wheel as a body in space: its frames, its surface in shaded facets, its shadow, and a camera.

Fixed axes X, Y, Z, Z up; carrier axes e1 (line of nodes), e2 (up the slope), e3 (axle), paper (3).
All projections are orthographic, so that parallel lengths keep their ratios.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from scipy.spatial.transform import Rotation

from diagrams.scene import Array

FACETS = 480, 96  # around the axle, around the tube
SIGHT = np.linspace(2e-3, 1.0, 600)  # m from a point towards the eye, where the wheel may stand
TYRE, MARK = np.array([0.72, 0.79, 0.86]), np.array([1.0, 0.66, 0.12])
SHADOW = "#D2D4D6"


@dataclass(frozen=True)
class Wheel:
    """A torus of ring radius r_0 and tube radius r in m, with its pose; angles in rad."""

    r_0: float
    r: float
    X_O: float
    Y_O: float
    psi: float
    theta: float
    phi: float

    @cached_property
    def carrier(self) -> Array:
        """Columns e1, e2, e3 in fixed axes: [psi][theta] of (3)."""
        return Rotation.from_euler("ZX", [self.psi, self.theta]).as_matrix()

    @cached_property
    def centre(self) -> Array:
        """O; its height follows from contact, (32)."""
        return np.array([self.X_O, self.Y_O, self.r_0 * np.sin(self.theta) + self.r])

    @property
    def tube_centre(self) -> Array:
        """The point of the ring circle that lies r above the contact point."""
        return self.centre - self.r_0 * self.carrier[:, 1]

    @property
    def contact(self) -> Array:
        """The contact point with the ground, Z = 0."""
        return self.tube_centre - np.array([0.0, 0.0, self.r])

    def rim(self, angle: float | Array) -> Array:
        """Unit vectors in the wheel plane, at an angle from e1 towards e2; shape (..., 3)."""
        angle = np.asarray(angle)[..., None]
        return np.cos(angle) * self.carrier[:, 0] + np.sin(angle) * self.carrier[:, 1]

    def surface(self, turn: Array, around: Array) -> tuple[Array, Array]:
        """Points and outward normals at angles from the body's x axis and around the tube; shape (turn, around, 3)."""
        outward = self.rim(turn + self.phi)[:, None]
        normal = np.cos(around)[:, None] * outward + np.sin(around)[:, None] * self.carrier[:, 2]
        return self.centre + self.r_0 * outward + self.r * normal, normal

    def holds(self, points: Array) -> Array:
        """Whether points lie inside."""
        x, y, z = np.moveaxis((points - self.centre) @ self.carrier, -1, 0)
        return np.hypot(np.hypot(x, y) - self.r_0, z) < self.r


@dataclass(frozen=True)
class View:
    """An orthographic camera; azimuth from X towards Y and elevation above the ground in rad."""

    azimuth: float
    elevation: float

    @cached_property
    def axes(self) -> Array:
        """Rows: right, up, and towards the eye, in fixed axes."""
        ca, sa = np.cos(self.azimuth), np.sin(self.azimuth)
        ce, se = np.cos(self.elevation), np.sin(self.elevation)
        return np.array([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])

    @property
    def eye(self) -> Array:
        """Unit vector towards the eye."""
        return self.axes[2]

    @property
    def lamp(self) -> Array:
        """Unit vector towards the lamp: above and left of the eye."""
        light = -0.55 * self.axes[0] + [0.0, 0.0, 1.0] + 0.55 * self.eye
        return light / np.linalg.norm(light)

    def project(self, points: Array) -> Array:
        """Image coordinates (right, up) in m."""
        return np.asarray(points) @ self.axes[:2].T

    def hides(self, wheel: Wheel, points: Array) -> Array:
        """True where the wheel stands between a point and the eye."""
        return wheel.holds(np.asarray(points)[:, None] + SIGHT[:, None] * self.eye).any(axis=1)


def draw(ax: Axes, wheel: Wheel, view: View, mark: float = 0.05, shadow: bool = True) -> None:
    """The wheel as a raster image, over its shadow on the ground; mark: half its width on the tyre, rad."""
    turn, around = (np.linspace(0, 2 * np.pi, count + 1) for count in FACETS)
    points, _ = wheel.surface(turn, around)
    middles, normals = wheel.surface(turn[:-1] + turn[1] / 2, around[:-1] + around[1] / 2)
    from_back = np.argsort((middles @ view.eye).ravel())
    on_mark = (np.abs(np.angle(np.exp(1j * (turn[:-1] + turn[1] / 2)))) < mark)[:, None, None]
    colours = shaded(normals, np.where(on_mark, MARK, TYRE), view)
    _fill(ax, _quads(view.project(points))[from_back], colours.reshape(-1, 3)[from_back], 2)
    if shadow:
        on_ground = points - points[..., 2:] / view.lamp[2] * view.lamp
        _fill(ax, _quads(view.project(on_ground)), SHADOW, -1)


def shaded(normal: Array, base: Array, view: View) -> Array:
    """Soft diffuse light, a dark edge, a small highlight."""
    half = (view.lamp + view.eye) / np.linalg.norm(view.lamp + view.eye)
    diffuse, facing, shine = (np.clip(normal @ to, 0.0, 1.0)[..., None] for to in (view.lamp, view.eye, half))
    edge = np.clip(facing / 0.35, 0.0, 1.0) ** 0.6
    shade = (0.45 + 0.11 * normal[..., 2:] + 0.52 * diffuse) * (0.45 + 0.55 * edge)
    return np.clip(base * shade + 0.30 * shine**40, 0.0, 1.0)


def _quads(grid: Array) -> Array:
    """The facets of a grid of points, four corners each."""
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 2)


def _fill(ax: Axes, quads: Array, colours: Array | str, layer: int) -> None:
    ax.add_collection(
        PolyCollection(quads, facecolors=colours, edgecolors="face", lw=0.3, rasterized=True, zorder=layer)
    )
