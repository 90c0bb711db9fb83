"""Vectors and turns in plain numbers, for speed: fixed axes, body axes, and n, the vertical seen from the body."""

from math import cos, sin, sqrt

from .model import Vector

Matrix = tuple[Vector, Vector, Vector]


def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def quaternion(psi: float, theta: float, phi: float) -> tuple[float, float, float, float]:
    """Unit quaternion (w, x, y, z) of the z-x-z turns psi, theta, phi: the matrix A of (4)."""
    c, s = cos(theta / 2), sin(theta / 2)
    plus, minus = (psi + phi) / 2, (psi - phi) / 2
    return c * cos(plus), s * cos(minus), s * sin(minus), c * sin(plus)


def rotation(w: float, x: float, y: float, z: float) -> Matrix:
    """Body-to-fixed matrix; its last row is the vertical seen from the body. Any norm of q."""
    f = 2 / (w * w + x * x + y * y + z * z)
    return (
        (1 - f * (y * y + z * z), f * (x * y - w * z), f * (x * z + w * y)),
        (f * (x * y + w * z), 1 - f * (x * x + z * z), f * (y * z - w * x)),
        (f * (x * z - w * y), f * (y * z + w * x), 1 - f * (x * x + y * y)),
    )


def to_fixed(R: Matrix, v: Vector) -> Vector:
    """R v."""
    (a, b, c), (d, e, f), (g, h, i) = R
    x, y, z = v
    return (a * x + b * y + c * z, d * x + e * y + f * z, g * x + h * y + i * z)


def to_body(R: Matrix, v: Vector) -> Vector:
    """R^T v."""
    (a, b, c), (d, e, f), (g, h, i) = R
    x, y, z = v
    return (a * x + d * y + g * z, b * x + e * y + h * z, c * x + f * y + i * z)


def slope(n: Vector) -> tuple[float, float, float]:
    """e2 in body axes, and s = sin(theta) = |n x k|: (e2_x, e2_y, s)."""
    s = sqrt(n[0] * n[0] + n[1] * n[1])
    return n[0] / s, n[1] / s, s
