"""Plays inputs to an instance, which are polynomials from given instants on."""

from collections.abc import Sequence

from wheelfmu.fmu.driver import OK, FMU2Wheel

# From this instant on; by input the coefficients of 1, t, t^2, t^3, t counted from the instant.
Piece = tuple[float, dict[str, Sequence[float]]]


def play(w: FMU2Wheel, pieces: Sequence[Piece], stop: float, cuts: Sequence[float] = ()) -> int:
    """Steps to the begin of each piece, to each cut and to `stop`; the status of the last step."""
    begins = [begin for begin, _ in pieces]
    points = sorted({*begins, *(t for t in cuts if begins[0] < t < stop), stop})
    status = OK
    for t, end in zip(points, points[1:], strict=False):
        begin, inputs = max((piece for piece in pieces if piece[0] <= t), key=lambda piece: piece[0])
        w.give(inputs, t - begin)
        w.time = t
        status = w.step_to(end)
        if status != OK:
            break
    return status
