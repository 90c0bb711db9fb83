"""The wheel as a body in space: its frames, its surface in shaded facets, its shadow, and the camera.

Fixed axes X, Y, Z, Z up; carrier axes e1 (line of nodes), e2 (up the slope), e3 (axle), paper (3).
The projection is orthographic, so that parallel lengths keep their ratios.
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
# Unit vectors in fixed axes. The eye stands 36 deg from X towards Y and 17 deg above the ground, the lamp left of it.
RIGHT, UP, EYE = Rotation.from_euler("ZY", [36.0, -17.0], degrees=True).as_matrix().T[[1, 2, 0]]
LAMP = np.array([0.0, 0.0, 1.0]) + 0.55 * (EYE - RIGHT)
LAMP /= np.linalg.norm(LAMP)


def project(points: Array) -> Array:
    """Image coordinates (right, up) in m."""
    return np.asarray(points) @ np.column_stack([RIGHT, UP])


@dataclass(frozen=True)
class Wheel:
    """A torus of ring radius r_0 and tube radius r in m, with its pose; angles in rad."""

    r_0: float
    r: float
    psi: float
    theta: float
    phi: float
    X_O: float = 0.0
    Y_O: float = 0.0

    @cached_property
    def carrier(self) -> Array:
        """Columns e1, e2, e3 in fixed axes: [psi][theta] of (3)."""
        return Rotation.from_euler("ZX", [self.psi, self.theta]).as_matrix()

    @cached_property
    def centre(self) -> Array:
        """O; its height follows from contact, (32)."""
        return np.array([self.X_O, self.Y_O, self.r_0 * np.sin(self.theta) + self.r])

    def rim(self, angle: float | Array) -> Array:
        """Unit vectors in the wheel plane, at an angle from e1 towards e2; shape (..., 3)."""
        return np.stack([np.cos(angle), np.sin(angle)], axis=-1) @ self.carrier[:, :2].T

    def surface(self, turn: Array, around: Array) -> tuple[Array, Array]:
        """Points and outward normals at angles from the body's x axis and around the tube; shape (turn, around, 3)."""
        outward = self.rim(turn + self.phi)[:, None]
        normal = np.cos(around)[:, None] * outward + np.sin(around)[:, None] * self.carrier[:, 2]
        return self.centre + self.r_0 * outward + self.r * normal, normal

    def hides(self, points: Array) -> Array:
        """True where the wheel stands between a point and the eye."""
        sight = points[:, None] + SIGHT[:, None] * EYE
        x, y, z = np.moveaxis((sight - self.centre) @ self.carrier, -1, 0)
        return (np.hypot(np.hypot(x, y) - self.r_0, z) < self.r).any(axis=1)


def draw(ax: Axes, wheel: Wheel, mark: float = 0.05, shadow: bool = True) -> None:
    """The wheel as a raster image, over its shadow on the ground; mark: half its width on the tyre, rad."""
    turn, around = (np.linspace(0, 2 * np.pi, count + 1) for count in FACETS)
    points, _ = wheel.surface(turn, around)
    between = turn[:-1] + turn[1] / 2
    middles, normals = wheel.surface(between, around[:-1] + around[1] / 2)
    from_back = np.argsort((middles @ EYE).ravel())
    colours = shaded(normals, np.where((np.cos(between) > np.cos(mark))[:, None, None], MARK, TYRE))
    _fill(ax, _quads(points)[from_back], colours.reshape(-1, 3)[from_back], 2)
    if shadow:
        _fill(ax, _quads(points - points[..., 2:] / LAMP[2] * LAMP), SHADOW, -1)


def shaded(normal: Array, base: Array) -> Array:
    """Soft diffuse light, a dark edge, a small highlight."""
    half = (LAMP + EYE) / np.linalg.norm(LAMP + EYE)
    diffuse, facing, shine = (np.clip(normal @ to, 0.0, 1.0)[..., None] for to in (LAMP, EYE, half))
    edge = np.clip(facing / 0.35, 0.0, 1.0) ** 0.6
    shade = (0.45 + 0.11 * normal[..., 2:] + 0.52 * diffuse) * (0.45 + 0.55 * edge)
    return np.clip(base * shade + 0.30 * shine**40, 0.0, 1.0)


def _quads(grid: Array) -> Array:
    """The facets of a grid of points in the image, four corners each."""
    corners = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    return project(np.stack(corners, axis=2)).reshape(-1, 4, 2)


def _fill(ax: Axes, quads: Array, colours: Array | str, layer: int) -> None:
    look = {"edgecolors": "face", "linewidths": 0.3, "rasterized": True}
    ax.add_collection(PolyCollection(quads, facecolors=colours, zorder=layer, **look))
