"""The first instant within one step at which a margin falls through zero.

A margin is positive while the present mode may last. It is known at Chebyshev points of the step, x in (0, 1); its
polynomial through them gives every root, so a brief excursion between two steps, there and back, is seen.
"""

from math import cos, pi

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

COUNT = 12
NODES = np.array([(1 - cos(pi * (i + 0.5) / COUNT)) / 2 for i in range(COUNT)])
_TO_COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(2 * NODES - 1, COUNT - 1))


def first_fall(values: NDArray[np.float64], from_zero: bool) -> tuple[float, float] | None:
    """(x, slope) of the first fall through zero; values are the margin at NODES.

    from_zero: the margin starts at exactly 0 (w_z after a stick or a reversal); that root is
    divided out, so that only the return to zero counts. A margin that is already negative, and
    did not get there by a fall within the step, falls at x = 0.
    """
    quotient = values / NODES if from_zero else values
    c = _TO_COEFFICIENTS @ quotient
    if c[0] >= np.abs(c[1:]).sum():
        return None
    roots = chebyshev.chebroots(c)
    real = (roots[np.isreal(roots)].real + 1) / 2
    fall_rates = chebyshev.chebder(c)
    for x in np.sort(real[(real >= 0) & (real <= 1)]):
        slope = 2 * chebyshev.chebval(2 * x - 1, fall_rates)
        if slope < 0:
            if quotient[0] < 0 and x > NODES[0]:
                return 0.0, 0.0
            return float(x), float(slope * x if from_zero else slope)
    return (0.0, 0.0) if quotient[0] < 0 else None
