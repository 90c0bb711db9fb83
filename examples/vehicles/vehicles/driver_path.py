"""The driver's programmes and paths, written again for the independent check.

Fixed axes X, Y; both paths begin at the origin along X.
"""

from __future__ import annotations

import numpy as np


def rise(t: float, begin: float, duration: float) -> float:
    """From 0 to 1, with continuous second derivatives."""
    z = min(max((t - begin) / duration, 0.0), 1.0)
    return z**3 * (10 - 15 * z + 6 * z**2)


class Path:
    """Point, tangent and curvature of the driver's path as functions of its parameter."""

    def __init__(self, o: dict[str, float]) -> None:
        self.o = o

    def point(self, p: float) -> np.ndarray:
        """X, Y."""
        o = self.o
        if o["path"] == 1:
            x = o["size"] * np.sin(p) / (1 + np.cos(p) ** 2)
            return np.array([x + x * np.cos(p), x * np.cos(p) - x]) / np.sqrt(2)
        out, back = (np.tanh((p - o[end]) / o["length"]) for end in ("x_out", "x_back"))
        return np.array([p, o["width"] / 2 * (out - back)])

    def tangent(self, p: complex) -> np.ndarray:
        """dP/dp."""
        o = self.o
        if o["path"] == 1:
            c = np.cos(p)
            dx, dy = c * (3 - c**2), 3 * c**2 - 1
            return o["size"] * np.array([dx + dy, dy - dx]) / (1 + c**2) ** 2 / np.sqrt(2)
        out, back = (np.cosh((p - o[end]) / o["length"]) ** -2 for end in ("x_out", "x_back"))
        return np.array([1.0, o["width"] / 2 * (out - back) / o["length"]])

    def curvature(self, p: float) -> float:
        """Positive to the left."""
        h = 1e-30  # of the complex step, which has no error
        d, dd = self.tangent(p), self.tangent(p + 1j * h).imag / h
        return float((d[0] * dd[1] - d[1] * dd[0]) / np.hypot(*d) ** 3)
