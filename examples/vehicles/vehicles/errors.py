"""Errors of coupled runs: relative to each variable's range, over the communication step, and their order."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from itertools import takewhile

import numpy as np

from .component import Ended
from .vehicle import Table

STEPS = (0.002, 0.001, 0.0005)  # s
Errors = dict[str, dict[float, float]]  # relative to the range: by exchange and communication step


def apart(table: Table, truth: Table, names: Sequence[str], least: float = 0.01) -> dict[str, float]:
    """Largest difference over time of each variable, relative to its range, or to `least` where that is larger."""
    return {n: float(np.abs(table[n] - truth[n]).max() / max(np.ptp(truth[n]), least)) for n in names}


def distance(table: Table, truth: Table, names: Sequence[str], least: float = 0.01) -> float:
    """The largest of them."""
    return max(apart(table, truth, names, least).values())


def orders(errors: dict[float, float]) -> np.ndarray:
    """Observed order between neighbours of the errors by step."""
    return np.diff(np.log([*errors.values()])) / np.diff(np.log([*errors]))


def longest(steps: Sequence[float], error: Callable[[float], float]) -> float:
    """The longest of rising steps up to which a run neither ends early nor strays beyond 10 % of the range, s."""
    reached = 0.0
    with suppress(Ended):
        for h in takewhile(lambda h: error(h) < 0.1, steps):
            reached = h
    return reached
