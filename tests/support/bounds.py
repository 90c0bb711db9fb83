"""Bounds: `within` and `beyond` check a value; a failure names the quantity, its value and the bound.

A bound states what must hold on any processor, with any libm and any NumPy. Where only rounding is left, it is a
multiple of EPSILON times the size of the terms that are rounded: 64 * EPSILON is some dozens of roundings of terms of
size one, and needs no further reason.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

EPSILON = float(np.finfo(float).eps)  # the relative distance of neighbouring doubles, 2.2e-16


def within(value: float | Mapping[str, float], bound: float, quantity: str) -> None:
    """The value lies below the bound; `quantity` names it. Of values by name, of variables for instance, the largest
    counts and is named where it fails."""
    of = ""
    if isinstance(value, Mapping):
        name, value = max(value.items(), key=lambda item: np.inf if np.isnan(item[1]) else item[1])
        of = f" of {name}"
    assert value < bound, f"{quantity}{of} is {value:.3g} and must be below {bound:.3g}"


def beyond(value: float, bound: float, quantity: str) -> None:
    """The value lies above the bound: what something broken must show, or what a quantity must at least reach."""
    assert value > bound, f"{quantity} is {value:.3g} and must be above {bound:.3g}"


def absolute_error(found: ArrayLike, expected: ArrayLike) -> float:
    """The largest difference."""
    return float(np.max(np.abs(np.subtract(found, expected))))


def relative_error(found: ArrayLike, expected: ArrayLike) -> float:
    """The largest difference over the size of what is expected there; 0 where both are zero."""
    difference, size = np.abs(np.subtract(found, expected)), np.abs(expected)
    return float(np.max(np.where(difference == 0, 0.0, difference / np.where(size == 0, np.finfo(float).tiny, size))))
