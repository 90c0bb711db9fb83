"""Inputs as cubic polynomials over intervals of time: exact for the FMU and for the reference alike."""

from bisect import bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike, NDArray
from reference import Inputs

INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake")


@dataclass(frozen=True)
class Schedule:
    """pieces: (from this instant on, polynomials by input name: coefficients of 1, t, t^2, t^3)."""

    pieces: tuple[tuple[float, dict[str, ArrayLike]], ...] = ()

    @property
    def jumps(self) -> tuple[float, ...]:
        return tuple(t for t, _ in self.pieces[1:])

    def derivatives(self, t: float) -> NDArray[np.float64]:
        """Row k: the k-th derivative of the inputs at t, from the right; k = 0 ... 3."""
        piece = self.pieces[bisect_right([start for start, _ in self.pieces], t) - 1][1]
        table = np.zeros((4, len(INPUTS)))
        for name, coefficients in piece.items():
            p = Polynomial(coefficients)
            table[:, INPUTS.index(name)] = [p.deriv(k)(t) for k in range(4)]
        return table

    def for_reference(self) -> Inputs:
        if not self.pieces:
            return Inputs()
        return Inputs(
            lambda t: tuple(self.derivatives(t)[0, :3].tolist()),
            lambda t: tuple(self.derivatives(t)[0, 3:6].tolist()),
            self.jumps,
            lambda t: float(self.derivatives(t)[0, 6]),
        )
