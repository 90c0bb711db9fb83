"""The wheel as a body in space: its frames, its surface, and a ray-traced image of it.

Fixed axes X, Y, Z, Z up; carrier axes e1 (line of nodes), e2 (up the slope), e3 (axle), paper (3).
All projections are orthographic, so that parallel lengths keep their ratios.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from diagrams.scene import Array

STEPS = 80  # of sphere tracing; a grazing ray that needs more is taken as a miss
SURFACE = 1e-5  # m, a ray this close has hit


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
        cp, sp = np.cos(self.psi), np.sin(self.psi)
        ct, st = np.cos(self.theta), np.sin(self.theta)
        return np.array([[cp, -sp * ct, sp * st], [sp, cp * ct, -cp * st], [0.0, st, ct]])

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

    def distance(self, points: Array) -> Array:
        """Signed distance in m from points in fixed axes to the surface, negative inside."""
        x, y, z = np.moveaxis((points - self.centre) @ self.carrier, -1, 0)
        return np.hypot(np.hypot(x, y) - self.r_0, z) - self.r

    def normal(self, points: Array) -> Array:
        """Outward unit normals at points of the surface."""
        local = (points - self.centre) @ self.carrier
        ring = local * (1.0, 1.0, 0.0)
        ring *= self.r_0 / np.linalg.norm(ring, axis=-1, keepdims=True)
        outward = local - ring
        outward /= np.linalg.norm(outward, axis=-1, keepdims=True)
        return outward @ self.carrier.T

    def march(self, start: Array, direction: Array, reach: float) -> tuple[Array, Array]:
        """Follow rays (n, 3) up to `reach` in m: length to the surface (inf: none), and openness.

        Sphere tracing: each step is as long as the distance to the surface, so it cannot pass it.
        Openness is the least distance/length met on the way: 0 in the core of a shadow.
        """
        length, found = np.zeros(len(start)), np.full(len(start), np.inf)
        openness = np.full(len(start), np.inf)
        live = np.arange(len(start))
        for _ in range(STEPS):
            gap = self.distance(start[live] + length[live, None] * direction)
            openness[live] = np.minimum(openness[live], gap / np.maximum(length[live], 1e-3))
            hit = gap < SURFACE
            found[live[hit]] = length[live[hit]]
            length[live] += gap
            live = live[~hit & (length[live] < reach)]
        return found, np.where(np.isfinite(found), 0.0, openness)


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

    def project(self, points: Array) -> Array:
        """Image coordinates (right, up) in m."""
        return np.asarray(points) @ self.axes[:2].T

    def hides(self, wheel: Wheel, points: Array) -> Array:
        """True where the wheel stands between a point and the eye."""
        start = np.asarray(points) + 2e-3 * self.eye
        return np.isfinite(wheel.march(start, self.eye, 3.0)[0])


@dataclass(frozen=True)
class Paint:
    """Colours (RGB, 0 to 1) of the image and the half-width in rad of the mark on the tyre."""

    tyre: tuple[float, float, float]
    mark: tuple[float, float, float]
    mark_width: float = 0.05
    shadow: float = 0.24


def render(wheel: Wheel, view: View, window: Array, pixels: int, paint: Paint) -> Array:
    """RGBA image, rows downwards, of window (left, right, bottom, top in m), `pixels` per m.

    The ground is transparent but for the wheel's shadow.
    """
    left, right, bottom, top = window
    nu, nv = round((right - left) * pixels), round((top - bottom) * pixels)
    u = left + (np.arange(2 * nu) + 0.5) / (2 * pixels)  # 2 x 2 rays per pixel
    v = top - (np.arange(2 * nv) + 0.5) / (2 * pixels)
    plane = u[None, :, None] * view.axes[0] + v[:, None, None] * view.axes[1]
    start = (plane + 2.0 * view.eye).reshape(-1, 3)
    length, _ = wheel.march(start, -view.eye, 4.0)
    body = np.isfinite(length)
    light = lamp(view)
    rgba = np.zeros((len(start), 4))
    rgba[body] = _tyre(wheel, view, start[body] - length[body, None] * view.eye, light, paint)
    ground = start[~body] - (start[~body, 2:] / view.eye[2]) * view.eye
    rgba[~body] = _ground(wheel, ground, light, paint)
    rgba[:, :3] *= rgba[:, 3:]  # average in premultiplied colours
    small = rgba.reshape(nv, 2, nu, 2, 4).mean(axis=(1, 3))
    small[..., :3] /= np.maximum(small[..., 3:], 1e-9)
    return np.clip(small, 0.0, 1.0)


def window_of(wheel: Wheel, view: View, margin: float, pixels: int) -> Array:
    """The least window, on whole pixels, with the wheel, its shadow and a margin in m."""
    ring = wheel.centre + (wheel.r_0 + wheel.r) * wheel.rim(np.linspace(0, 2 * np.pi, 90))
    light = lamp(view)
    flat = view.project(np.concatenate([ring, ring - (ring[:, 2:] / light[2]) * light]))
    low = np.floor((flat.min(axis=0) - margin) * pixels) / pixels
    high = np.ceil((flat.max(axis=0) + margin) * pixels) / pixels
    return np.array([low[0], high[0], low[1], high[1]])


def lamp(view: View) -> Array:
    """Unit vector towards the lamp: above and left of the eye."""
    light = -0.55 * view.axes[0] + 1.0 * np.array([0.0, 0.0, 1.0]) + 0.55 * view.eye
    return light / np.linalg.norm(light)


def _tyre(wheel: Wheel, view: View, points: Array, light: Array, paint: Paint) -> Array:
    """Colours of points on the tyre: soft diffuse light, a dark edge, a small highlight."""
    normal = wheel.normal(points)
    local = (points - wheel.centre) @ wheel.carrier
    turn = np.arctan2(local[:, 1], local[:, 0]) - wheel.phi
    marked = abs(np.angle(np.exp(1j * turn))) < paint.mark_width
    base = np.where(marked[:, None], paint.mark, paint.tyre)
    lit, _ = wheel.march(points + 3e-3 * normal, light, 1.5)
    diffuse = np.clip(normal @ light, 0.0, 1.0) * np.where(np.isfinite(lit), 0.35, 1.0)
    sky = 0.5 + 0.5 * normal[:, 2]
    edge = np.clip((normal @ view.eye) / 0.35, 0.0, 1.0) ** 0.6
    half = (light + view.eye) / np.linalg.norm(light + view.eye)
    shine = 0.30 * np.clip(normal @ half, 0.0, 1.0) ** 40
    shade = (0.34 + 0.22 * sky + 0.52 * diffuse) * (0.45 + 0.55 * edge)
    colour = base * shade[:, None] + shine[:, None]
    return np.concatenate([np.clip(colour, 0, 1), np.ones((len(points), 1))], axis=1)


def _ground(wheel: Wheel, points: Array, light: Array, paint: Paint) -> Array:
    """Black with the shadow's strength as opacity, dense where the tyre is near the ground."""
    _, openness = wheel.march(points + np.array([0.0, 0.0, 2e-3]), light, 2.5)
    cast = 1.0 - np.clip(openness / 0.10, 0.0, 1.0)
    near = np.exp(-wheel.distance(points) / 0.02)
    rgba = np.zeros((len(points), 4))
    rgba[:, 3] = np.clip(paint.shadow * cast * cast * (3 - 2 * cast) + 0.3 * near, 0.0, 0.6)
    return rgba
