"""The outcome of a run as one number: a value at its end, an extreme, a mean, or the time of a first passage.

A measure is written as text, so that it can be kept with the results and compared when a study is started again:
`theta` (at the end), `lowest`, `min(Z_O)`, `max(mu_required)`, `mean(E)`, `first(theta > 1.6)`. Besides the FMU's
variables there is `plane_angle`, the angle of the wheel's plane to the ground on either side; `lowest` is its least.
Python's standard library is all that this needs: scripts/study checks names before anything is installed.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

PLANE_ANGLE = "plane_angle"
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_FORMS = re.compile(
    rf"\s*(?:(?P<last>\w+)|(?P<kind>min|max|mean)\(\s*(?P<of>\w+)\s*\)"
    rf"|first\(\s*(?P<watched>\w+)\s*(?P<side>[<>])\s*(?P<limit>{_NUMBER})\s*\))\s*"
)


class StudyError(ValueError):
    """The study cannot be run as it is written; the text is one line for the user."""


@dataclass(frozen=True)
class Measure:
    """One number of a run: `kind` is last, min, max, mean, < or >; SI units, `limit` in the quantity's unit."""

    kind: str
    quantity: str
    limit: float = 0.0
    text: str = ""

    @property
    def variable(self) -> str:
        """The FMU's variable that has to be read."""
        return "theta" if self.quantity == PLANE_ANGLE else self.quantity

    @property
    def is_time(self) -> bool:
        """Whether the number is a time in s; otherwise it has the variable's unit."""
        return self.kind in "<>"


def parse_measure(text: str) -> Measure:
    """The measure that the text describes; StudyError if it describes none."""
    found = _FORMS.fullmatch(f"min({PLANE_ANGLE})" if text.strip() == "lowest" else text)
    if not found:
        raise StudyError(
            f"'{text}' is not a measure: write lowest, a variable's name, min(name), max(name), mean(name), "
            "first(name < number) or first(name > number)."
        )
    if found["side"]:
        return Measure(found["side"], found["watched"], float(found["limit"]), text)
    return Measure(found["kind"] or "last", found["of"] or found["last"], text=text)
