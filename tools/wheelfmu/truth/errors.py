"""Errors of a motion over the range of each variable, or over the size of its kind; of instants."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

Errors = dict[str, float]  # by variable
LEVEL = 1e-9  # of a column's scale: less is no range
Columns = Mapping[str, NDArray]
KINDS = (
    ("X_O", "Y_O", "Z_O"),
    ("psi", "theta", "phi"),
    ("X_O_dot", "Y_O_dot", "Z_O_dot", "slip_x", "slip_y"),
    ("psi_dot", "theta_dot", "phi_dot", "omega_z"),
    ("lambda_1", "lambda_2", "lambda_3", "lambda_x", "lambda_y"),
    ("E",),
)


def range_errors(found: Columns, expected: Columns, names: Iterable[str]) -> Errors:
    """The largest error of each column, relative to its range."""
    return {name: over_range(found[name], expected[name]) for name in names}


def range_error(found: Columns, expected: Columns, names: Iterable[str]) -> float:
    """The largest of them."""
    return max(range_errors(found, expected, names).values())


def over_range(found: NDArray, expected: NDArray) -> float:
    """The largest error of a column, or of several side by side, relative to its range; infinite where there are other
    rows, or none."""
    if found.shape != expected.shape or not np.isfinite(found).all():
        return np.inf
    return float(by_instant(found, expected, 0.0).max())


def by_instant(found: NDArray, expected: NDArray, scales: NDArray | float = 1.0) -> NDArray:
    """At each instant the largest error of a column, relative to its range, or to its scale where it has hardly any."""
    span = np.ptp(expected, axis=0)
    errors = np.abs(found - expected) / np.where(span > LEVEL * scales, span, scales)
    return errors.reshape(len(found), -1).max(axis=1)


def kind_errors(found: Columns, expected: Columns, least: float = 0.0) -> Errors:
    """The largest error of the outputs of each kind, by its first name, relative to the largest value of the kind or
    `least`."""
    errors = {}
    for kind in KINDS:
        size = max(least, *(float(np.abs(expected[name]).max()) for name in kind))
        errors[kind[0]] = max(float(np.abs(found[name] - expected[name]).max()) for name in kind) / size
    return errors


def instants_error(found: Sequence[tuple[float, int]], expected: Sequence[tuple[float, int]]) -> float:
    """The largest error of the instants of transitions, (instant, mode), s; infinite where one is missing, added or of
    another mode."""
    if [mode for _, mode in found] != [mode for _, mode in expected]:
        return np.inf
    return max((abs(a - b) for (a, _), (b, _) in zip(found, expected, strict=True)), default=0.0)
