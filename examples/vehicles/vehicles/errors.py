"""Errors of coupled runs over the communication step: their order, and the longest step."""

from collections.abc import Callable, Sequence
from itertools import takewhile

import numpy as np

STEPS = (0.002, 0.001, 0.0005)  # s
Errors = dict[str, dict[float, float]]  # relative to the range: by exchange and communication step


def orders(errors: dict[float, float]) -> np.ndarray:
    """Observed order between neighbours of the errors by step."""
    return np.diff(np.log([*errors.values()])) / np.diff(np.log([*errors]))


def longest(steps: Sequence[float], error: Callable[[float], float]) -> float:
    """The longest of rising steps up to which a run neither ends early nor strays beyond 10 % of the range, s."""
    return [0.0, *takewhile(lambda h: error(h) < 0.1, steps)][-1]
