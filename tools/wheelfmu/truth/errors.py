"""Errors of a motion over the range of each variable."""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

Errors = dict[str, float]  # by variable


def range_errors(found: Mapping[str, NDArray], expected: Mapping[str, NDArray], names: Iterable[str]) -> Errors:
    """The largest error of each column, relative to its range."""
    return {name: float(np.abs(found[name] - expected[name]).max() / np.ptp(expected[name])) for name in names}


def range_error(found: Mapping[str, NDArray], expected: Mapping[str, NDArray], names: Iterable[str]) -> float:
    """The largest of them."""
    return max(range_errors(found, expected, names).values())
