"""Inputs as cubic polynomials over intervals of time: exact for the FMU and for the reference alike."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval
from numpy.typing import ArrayLike, NDArray

from wheelfmu.truth.reference import Inputs

INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake", "psi_dot_guide", "theta_dot_guide")


@dataclass(frozen=True)
class Schedule:
    """pieces: (from this instant on, polynomials by input name: coefficients of 1, t, t^2, t^3)."""

    pieces: tuple[tuple[float, dict[str, ArrayLike]], ...] = ()

    @property
    def jumps(self) -> tuple[float, ...]:
        return tuple(t for t, _ in self.pieces[1:])

    @cached_property
    def rows(self) -> list[list[list[float]]]:
        """Of each piece the four coefficients of each input."""
        return [[[*np.ravel(piece.get(name, 0)), 0, 0, 0][:4] for name in INPUTS] for _, piece in self.pieces]

    def at(self, t: float) -> list[list[float]]:
        """The rows of the piece at t, from the right."""
        return self.rows[bisect_right(self.jumps, t)]

    def derivatives(self, t: float) -> NDArray[np.float64]:
        """Row k: the k-th derivative of the inputs at t, from the right; k = 0 ... 3."""
        return np.array([polyval(t, polyder(np.transpose(self.at(t)), k)) for k in range(4)])

    def for_reference(self) -> Inputs:
        def values(which: slice, t: float) -> tuple[float, ...]:
            return tuple(a + t * (b + t * (c + t * d)) for a, b, c, d in self.at(t)[which])

        if not self.pieces:
            return Inputs()
        force, moment = partial(values, slice(3)), partial(values, slice(3, 6))
        return Inputs(force, moment, self.jumps, lambda t: values(slice(6, 7), t)[0])
