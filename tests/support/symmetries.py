"""What the plane and the wheel leave unchanged, as data: fixed axes for places and forces, carrier axes for moments."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

ANGLES = ("psi", "theta", "phi")


@dataclass(frozen=True)
class Symmetry:
    """plane: on (X, Y); signs, shifts: z -> sign z + shift of psi, theta, phi; moment: signs of M_1..3; move: X, Y.

    omega_z, sigma and tau have the sign of phi.
    """

    plane: NDArray[np.float64]
    signs: tuple[int, int, int] = (1, 1, 1)
    shifts: tuple[float, float, float] = (0, 0, 0)
    moment: tuple[int, int, int] = (1, 1, 1)
    move: tuple[float, float] = (0, 0)

    @property
    def angles(self) -> list[tuple[str, int, float]]:
        return list(zip(ANGLES, self.signs, self.shifts, strict=True))

    def on_plane(self, table, x: str, y: str) -> dict[str, NDArray[np.float64]]:
        """The images of two columns."""
        return dict(zip((x, y), self.plane @ np.array([table[x], table[y]]), strict=True))


TURN = np.array([[cos(0.7), -sin(0.7)], [sin(0.7), cos(0.7)]])
SYMMETRIES = {
    "rotation": Symmetry(TURN, shifts=(0.7, 0, 0)),
    "translation": Symmetry(np.eye(2), move=(100.0, -30.0)),
    "mirror": Symmetry(np.diag([1, -1]), (-1, 1, -1), (pi, 0, 0), (1, -1, -1)),
    "axle named the other way": Symmetry(np.eye(2), (1, -1, -1), (pi, pi, pi), (-1, 1, -1)),
    "half a turn of the body": Symmetry(np.eye(2), shifts=(0, 0, pi)),
}
