"""No restart where nothing jumped: a polynomial input that continues the last one leaves the solver's history alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import factorial
from pathlib import Path

import pytest
from vehicles.inputs import Bench, Case

STOP = 2.0  # s, 2000 communication points
ZERO = (0.0,) * 5


@pytest.fixture(scope="module")
def bench(fmus: dict[str, Path]) -> Iterator[Bench]:
    bench = Bench(fmus["wheel"])
    yield bench
    bench.close()


def torque(polynomial: Callable[[float, int], float], orders: int) -> Case:
    """M_3 with its derivatives up to `orders`."""
    return Case(
        "torque",
        lambda t: (*ZERO, polynomial(t, 0)),
        orders=orders,
        derivatives=lambda t, order: (*ZERO, polynomial(t, order)),
    )


def power(degree: int, scale: float, root: float) -> Callable[[float, int], float]:
    """scale (t - root)^degree and its derivatives."""

    def value(t: float, order: int) -> float:
        if order > degree:
            return 0.0
        return scale * factorial(degree) / factorial(degree - order) * (t - root) ** (degree - order)

    return value


@pytest.mark.parametrize(
    ("degree", "scale", "root"), [(1, 0.3, -1.0), (1, 0.3, 1.0), (2, 0.3, 1.0), (3, 0.3, 1.0), (3, -0.1, 0.7)]
)
def test_a_polynomial_that_continues_causes_no_restart(bench: Bench, degree: int, scale: float, root: float) -> None:
    """Also where the input passes through zero and its rounding is large beside its value."""
    assert bench.run(torque(power(degree, scale, root), degree), STOP).restarts == 0


def test_one_jump_causes_one_restart(bench: Bench) -> None:
    """Partner: the same ramp with a jump of 0.01 N m at 1 s."""
    ramp = power(1, 0.3, -1.0)
    jumping = torque(lambda t, order: ramp(t, order) + (0.01 if order == 0 and t > 0.9995 else 0.0), 1)
    assert bench.run(jumping, STOP).restarts == 1
