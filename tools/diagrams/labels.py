"""Texts and insets in axes whose limits are set: where they cover neither a curve nor each other."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from diagrams import style

Array = NDArray[np.float64]
Box = tuple[float, float, float, float]  # left, right, bottom, top
DISTANCES = (4.0, 7.0, 12.0, 20.0, 30.0)  # points between a text and what it names
LEADER = 10.0  # points: from here on a thin line leads to it
DIRECTIONS = np.radians(np.arange(0.0, 360.0, 22.5))
CORNERS = ((0.59, 0.60), (0.04, 0.60), (0.47, 0.13), (0.04, 0.13))  # of an inset, in parts of the axes
SIZE = (0.39, 0.40)
NUMBERS = (0.12, 0.13)  # room of an inset's numbers, to its right and below it
GROWTH = (1.0, 1.15, 1.3, 1.5, 1.75, 2.0, 2.5)


def inside(points: Array, box: Box) -> int:
    """How many points lie in the box."""
    left, right, bottom, top = box
    x, y = points.T
    return int(np.sum((x > left) & (x < right) & (y > bottom) & (y < top)))


def dense(points: Array, step: float = 2.0) -> Array:
    """A polyline with a point at least every `step` of its length."""
    lengths = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    if along[-1] == 0:
        return points[:1]
    at = np.arange(0.0, along[-1], max(step, along[-1] / 20000))
    return np.column_stack([np.interp(at, along, points[:, k]) for k in (0, 1)])


class Labels:
    """What is written into one diagram; curves and boxes, in the figure's dots, are kept free."""

    def __init__(self, ax: Axes, *curves: Array) -> None:
        self.ax = ax
        self.curves = np.concatenate([dense(ax.transData.transform(curve)) for curve in curves])
        self.boxes: list[Box] = []

    def keep_free(self, points: Array) -> None:
        """A line that is given in the figure's dots."""
        self.curves = np.concatenate([self.curves, dense(points)])

    def put(self, text: str, at: tuple[float, float], first: float = 45.0, **how: object) -> None:
        """The text beside the point `at`: near it, towards `first` (degrees) if there is room."""
        place, size = self.ax.transData.transform(at), self._size(text, how)
        order = sorted(DIRECTIONS, key=lambda angle: -np.cos(angle - np.radians(first)))
        tries = [(distance, angle) for distance in DISTANCES for angle in order]
        distance, angle = min(tries, key=lambda one: self._covered(self._box(place, size, *one)))
        box = self._box(place, size, distance, angle)
        self.boxes.append(box)
        shift = (np.array([box[0] + box[1], box[2] + box[3]]) / 2 - place) * 72 / self.ax.figure.dpi
        line = {"arrowstyle": "-", "linewidth": 0.5, "shrinkA": 0.0, "shrinkB": 2.5} if distance > LEADER else None
        style.note(self.ax, text, at, shift, ha="center", va="center", arrowprops=line, **how)

    def _size(self, text: str, how: dict[str, object]) -> Array:
        measured = self.ax.text(0, 0, text, **({"fontsize": style.NOTE} | how))
        extent = measured.get_window_extent()
        measured.remove()
        return np.array([extent.width, extent.height])

    def _box(self, place: Array, size: Array, distance: float, angle: float) -> Box:
        towards = np.array([np.cos(angle), np.sin(angle)])
        reach = distance * self.ax.figure.dpi / 72 + 0.5 * abs(towards) @ size
        (x, y), (w, h) = place + reach * towards, size
        return x - w / 2, x + w / 2, y - h / 2, y + h / 2

    def _covered(self, box: Box) -> float:
        left, right, bottom, top = box
        frame = self.ax.get_window_extent()
        beyond = max(frame.x0 - left, right - frame.x1, frame.y0 - bottom, top - frame.y1, 0.0)
        clashes = sum(left < b[1] and right > b[0] and bottom < b[3] and top > b[2] for b in self.boxes)
        return inside(self.curves, (left - 2, right + 2, bottom - 1, top + 1)) + 1000 * clashes + 10 * beyond


def free_corner(ax: Axes, x: Array, y: Array) -> tuple[float, float, float, float]:
    """Place of an inset that covers nothing of the curve; the axes grow towards a corner until there is one."""
    limits = np.array([ax.get_xlim(), ax.get_ylim()])
    points = dense(ax.transAxes.inverted().transform(ax.transData.transform(np.column_stack([x, y]))), 0.005)
    for growth in GROWTH:
        for left, bottom in CORNERS:
            side = np.array([left < 0.4, bottom < 0.4])  # the side that stays is the other one
            moved = np.where(side, 1 + (points - 1) / growth, points / growth)
            box = (left - 0.02, left + SIZE[0] + NUMBERS[0], bottom - NUMBERS[1], bottom + SIZE[1] + 0.02)
            if inside(moved, box) == 0:
                low, high = limits.T
                span = (high - low) * growth
                new_low = np.where(side, high - span, low)
                ax.set(xlim=(new_low[0], new_low[0] + span[0]), ylim=(new_low[1], new_low[1] + span[1]))
                return left, bottom, *SIZE
    return *CORNERS[0], *SIZE
