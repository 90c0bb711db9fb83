"""Piecewise polynomial inputs as a master gives them: values and derivatives at each communication point."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb, factorial

from .driver import OK, FMU2Wheel

# From this instant on; by input the coefficients of 1, t, t^2, t^3, t counted from the instant.
Piece = tuple[float, dict[str, Sequence[float]]]


def shifted(coefficients: Sequence[float], by: float) -> list[float]:
    """The same polynomial about another origin: four coefficients."""
    c = [*coefficients, 0.0, 0.0, 0.0, 0.0][:4]
    return [sum(comb(n, k) * c[n] * by ** (n - k) for n in range(k, 4)) for k in range(4)]


def give(w: FMU2Wheel, inputs: dict[str, Sequence[float]], since: float = 0.0) -> None:
    """Values and derivatives of the polynomials, `since` seconds after their origin."""
    names = list(inputs)
    table = [shifted(inputs[name], since) for name in names]
    assert w.set(**{name: row[0] for name, row in zip(names, table, strict=True)}) == OK
    orders = [[factorial(k) * row[k] for row in table] for k in (1, 2, 3)]
    assert w.set_input_derivatives(names, orders) == OK


def play(w: FMU2Wheel, pieces: Sequence[Piece], stop: float, cuts: Sequence[float] = ()) -> int:
    """Steps to the begin of each piece, to each cut and to `stop`; the status of the last step."""
    begins = [begin for begin, _ in pieces]
    points = sorted({*begins, *(t for t in cuts if begins[0] < t < stop), stop})
    status = OK
    for t, end in zip(points, points[1:], strict=False):
        begin, inputs = max((piece for piece in pieces if piece[0] <= t), key=lambda piece: piece[0])
        give(w, inputs, t - begin)
        w.time = t
        status = w.step_to(end)
        if status != OK:
            break
    return status
