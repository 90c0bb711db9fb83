"""Errors of a motion over the range of each variable."""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

Errors = dict[str, float]  # by variable


def range_errors(found: Mapping[str, NDArray], expected: Mapping[str, NDArray], names: Iterable[str]) -> Errors:
    """The largest error of each column, relative to its range."""
    return {name: over_range(found[name], expected[name]) for name in names}


def range_error(found: Mapping[str, NDArray], expected: Mapping[str, NDArray], names: Iterable[str]) -> float:
    """The largest of them."""
    return max(range_errors(found, expected, names).values())


def over_range(found: NDArray, expected: NDArray) -> float:
    """The largest error of a column, or of several side by side, relative to its range; infinite where there are other
    rows, or none."""
    if found.shape != expected.shape or not np.isfinite(found).all():
        return np.inf
    return float((np.abs(found - expected).max(axis=0) / np.ptp(expected, axis=0)).max())
