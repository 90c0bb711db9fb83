"""Measures: one number of a run each, described by a text, which is kept with the results and compared when a study is
started again.

`theta` (at the end), `min(Z_O)`, `max(mu_required)`, `mean(E)`, `first(theta > 1.6)`, `first(theta > 95deg)`. Besides
the FMU's variables there are `plane_angle`, of the wheel's plane to the ground on either side (`lowest` is its least),
and the speed of the slip (`slip` is its largest, `slid` the time for which there is any).
Python's standard library alone.
"""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, NamedTuple

from wheelfmu.fmu.values import Fault

from .names import PLANE, SLIP, in_si

if TYPE_CHECKING:
    import numpy

MADE_OF = {PLANE: ("theta",), SLIP: ("slip_x", "slip_y")}


class Measure(NamedTuple):
    """`kind` is last, min, max, mean, or of a time <, > or lasting; `limit` is in the quantity's unit."""

    kind: str
    quantity: str
    limit: float = 0.0

    @property
    def variables(self) -> tuple[str, ...]:
        """The FMU's variables that have to be read."""
        return MADE_OF.get(self.quantity, (self.quantity,))

    def value(self, t: numpy.ndarray, x: Any, *y: Any) -> float:
        """For samples of the variables at times t, the last of which is the end of the run; x at the end for `last`.

        A time is that of the first passage, interpolated linearly between two samples; NaN if there is none.
        """
        if self.quantity == PLANE:
            x = math.pi / 2 - abs(x - math.pi / 2)
        elif self.quantity == SLIP:
            x = (x * x + y[0] * y[0]) ** 0.5
        if self.kind == "last":
            return x
        if self.kind == "lasting":
            return integral(t, (x > 0) * 1.0)
        if self.kind == "mean":
            return integral(t, x) / (t[-1] - t[0]) if len(t) > 1 else x[-1]
        return self.passage(t, x) if self.kind in "<>" else self.extreme(x)

    def passage(self, t: Any, x: Any) -> float:
        beyond = x < self.limit if self.kind == "<" else x > self.limit
        k = beyond.argmax()
        if k == 0:
            return t[0] if beyond[0] else math.nan
        return t[k - 1] + (self.limit - x[k - 1]) / (x[k] - x[k - 1]) * (t[k] - t[k - 1])

    def extreme(self, x: Any) -> float:
        """The least or largest, by a parabola between the samples where their second differences show a smooth turn."""
        k = getattr(x, f"arg{self.kind}")()
        if 2 <= k < len(x) - 3:  # the last sample, the end of a run, has another distance
            before, bend, after = (x[j - 1] - 2 * x[j] + x[j + 1] for j in (k - 1, k, k + 1))
            if bend and all(0.5 < beside / bend < 2 for beside in (before, after)):
                return x[k] - (x[k + 1] - x[k - 1]) ** 2 / (8 * bend)
        return x[k]


def integral(t: Any, x: Any) -> float:
    """By the trapezoidal rule."""
    return ((t[1:] - t[:-1]) * (x[1:] + x[:-1]) / 2).sum()


MEASURE = re.compile(r"(\w+)|(min|max|mean)\((\w+)\)|first\((\w+)([<>])([-+]?\.?\d.*)\)")
SHORT = {"lowest": Measure("min", PLANE), "slip": Measure("max", SLIP), "slid": Measure("lasting", SLIP)}


def parse_measure(text: str) -> Measure:
    """The measure that the text describes, with a limit in SI; Fault if it describes none."""
    if not (found := MEASURE.fullmatch(text.replace(" ", ""))):
        raise Fault(
            f"'{text}' is not a measure: write lowest, slip, slid, a variable's name, min(name), max(name), "
            "mean(name), first(name < number) or first(name > number), as first(theta < 30deg)."
        )
    name, kind, of, quantity, side, limit = found.groups()
    if name:
        return SHORT.get(name, Measure("last", name))
    return Measure(kind, of) if kind else Measure(side, quantity, in_si(quantity, limit))
