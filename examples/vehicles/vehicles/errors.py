"""Errors of coupled runs: relative to each variable's range, over the communication step, and their order."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import takewhile

import numpy as np

from .component import Ended

STEPS = (0.002, 0.001, 0.0005)  # s
Table = dict[str, np.ndarray]


@dataclass(frozen=True)
class Errors:
    """Errors relative to the range over the communication step, by exchange."""

    steps: Sequence[float]
    of: dict[str, list[float]]


def apart(table: Table, truth: Table, names: Sequence[str], least: float = 0.01) -> dict[str, float]:
    """Largest difference over time of each variable, relative to its range, or to `least` where that is larger."""
    return {n: float(np.abs(table[n] - truth[n]).max() / max(np.ptp(truth[n]), least)) for n in names}


def distance(table: Table, truth: Table, names: Sequence[str], least: float = 0.01) -> float:
    """The largest of them."""
    return max(apart(table, truth, names, least).values())


def orders(steps: Sequence[float], errors: Sequence[float]) -> list[float]:
    """Observed order between neighbours."""
    return list(np.diff(np.log(errors)) / np.diff(np.log(steps)))


def longest(steps: Sequence[float], error: Callable[[float], float]) -> float:
    """The longest of rising steps up to which a run neither ends early nor strays beyond 10 % of the range, s."""

    def fits(h: float) -> bool:
        try:
            return error(h) < 0.1
        except Ended:
            return False

    return max(takewhile(fits, steps), default=0.0)
