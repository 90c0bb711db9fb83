"""Time at a given error, by straight lines through log(time) over log(error); ratios between set-ups."""

from __future__ import annotations

from math import exp, log

from .runner import Entry, Sheet


def frontier(entries: list[Entry]) -> list[tuple[float, float]]:
    """(error, best time) of what solved, errors falling; a point that is beaten in both by another is left out."""
    points = sorted((e.error, e.best) for e in entries if e.error is not None and e.bests)
    kept: list[tuple[float, float]] = []
    for error, seconds in points:
        if not kept or seconds < kept[-1][1]:
            kept.append((error, seconds))
    return kept[::-1]


def time_at(entries: list[Entry], error: float) -> float | None:
    """s; None outside the range of errors that the set-up reaches."""
    points = frontier(entries)
    for (e_0, t_0), (e_1, t_1) in zip(points, points[1:], strict=False):
        if e_1 <= error <= e_0:
            x = (log(e_0) - log(error)) / (log(e_0) - log(e_1))
            return exp(log(t_0) + x * (log(t_1) - log(t_0)))
    return None


def ratio(sheet: Sheet, name: str, peer: str, error: float) -> float | None:
    """Time of `name` over time of `peer` at the same error."""
    ours, theirs = time_at(sheet.of(name), error), time_at(sheet.of(peer), error)
    return ours / theirs if ours and theirs else None
