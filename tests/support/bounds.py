"""Bounds: `within` and `beyond` check a value; `pytest --bounds` prints how near each came to its bound.

A bound states what must hold on any processor, with any libm and any NumPy. Where only rounding is left, it is a
multiple of EPSILON times the size of the terms that are rounded: 64 * EPSILON is some dozens of roundings of terms of
size one, and needs no further reason.
"""

import os
from collections.abc import Iterable, Mapping

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

EPSILON = float(np.finfo(float).eps)  # the relative distance of neighbouring doubles, 2.2e-16

asked = False  # whether --bounds is given
nearest: dict[tuple[str, str, str], tuple[float, float]] = {}  # test, quantity and side -> value and bound of one call


def within(value: float, bound: float, quantity: str) -> None:
    """The value lies below the bound; `quantity` names what it is, once in a test."""
    assert value < bound, f"{quantity} is {value:.3g} and must be below {bound:.3g}"
    _note(quantity, "<", float(value), float(bound))


def beyond(value: float, bound: float, quantity: str) -> None:
    """The value lies above the bound: what something broken must show, or what a quantity must at least reach."""
    assert value > bound, f"{quantity} is {value:.3g} and must be above {bound:.3g}"
    _note(quantity, ">", float(value), float(bound))


def absolute_error(found: ArrayLike, expected: ArrayLike) -> float:
    """The largest difference."""
    return float(np.max(np.abs(np.subtract(found, expected))))


def relative_error(found: ArrayLike, expected: ArrayLike) -> float:
    """The largest difference over the size of what is expected there; 0 where both are zero."""
    difference, size = np.abs(np.subtract(found, expected)), np.abs(expected)
    return float(np.max(np.where(difference == 0, 0.0, difference / np.where(size == 0, np.finfo(float).tiny, size))))


def range_error(found: Mapping[str, NDArray], expected: Mapping[str, NDArray], names: Iterable[str]) -> float:
    """The largest error of the columns, each relative to its range."""
    return max(float(np.abs(found[name] - expected[name]).max() / np.ptp(expected[name])) for name in names)


def slack(side: str, value: float, bound: float) -> float:
    """How many times the bound lies off the value, on the good side."""
    large, small = (bound, value) if side == "<" else (value, bound)
    return abs(large / small) if small else float("inf")


def _note(quantity: str, side: str, value: float, bound: float) -> None:
    if asked:
        test = os.environ.get("PYTEST_CURRENT_TEST", "").rsplit(" (", 1)[0].split("[")[0].split("@")[0]
        _keep((test, quantity, side), (value, bound))


def _keep(key: tuple[str, str, str], call: tuple[float, float]) -> None:
    """Of several calls that which came nearest to its bound."""
    if key not in nearest or slack(key[2], *call) < slack(key[2], *nearest[key]):
        nearest[key] = call


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--bounds", action="store_true", help="print each bound, the value nearest to it and the slack")


def pytest_configure(config: pytest.Config) -> None:
    global asked
    asked = config.option.bounds


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node) -> None:
    for key, call in getattr(node, "workeroutput", {}).get("bounds", ()):
        _keep(tuple(key), tuple(call))


def pytest_sessionfinish(session: pytest.Session) -> None:
    if asked and hasattr(session.config, "workeroutput"):
        session.config.workeroutput["bounds"] = list(nearest.items())


def pytest_terminal_summary(terminalreporter) -> None:
    if asked:
        terminalreporter.section("bounds")
        for (test, quantity, side), (value, bound) in sorted(nearest.items()):
            figures = f"{value:.2g} {side} {bound:.2g}, slack {slack(side, value, bound):.2g}"
            terminalreporter.write_line(f"{test}, {quantity}: {figures}")
