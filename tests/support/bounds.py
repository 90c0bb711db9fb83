"""Bounds and what was measured, kept together: `within` and `beyond` check a value, and bounds.csv keeps it.

Each folder of tests has its table `bounds.csv`: a row for every bound, with the value that came nearest to it among all
calls of a whole run. A run fails where a bound has more than SLACK times the measured value and its row gives no
reason, where a row is missing, and where a value differs from its row by more than STALE. `pytest --record` writes the
rows; reasons are written by hand and stay. A run of chosen tests (-k, -m, ::) compares only what it has measured.
"""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

SLACK = 30.0  # a wider bound needs a reason
STALE = 3.0  # between the measured value and the row; machines differ by less
STILL = 1.2  # recording leaves a row that is this near
NOTHING = 1e-3  # of the bound: smaller values count as equal
COLUMNS = ("test", "quantity", "side", "bound", "measured", "slack", "reason")

Key = tuple[str, str, str, str]  # file, test, quantity, side


@dataclass(frozen=True)
class Row:
    bound: float
    measured: float
    reason: str = ""

    def slack(self, side: str) -> float:
        """How many times the bound lies off the measured value, on the good side."""
        large, small = (self.bound, self.measured) if side == "below" else (self.measured, self.bound)
        return abs(large / small) if small else float("inf")

    def differs(self, other: Row, factor: float) -> bool:
        least = NOTHING * abs(self.bound)
        a, b = (max(abs(row.measured), least) for row in (self, other))
        return not (a <= factor * b and b <= factor * a)


seen: dict[Key, Row] = {}


def within(value: float, bound: float, quantity: str) -> None:
    """The value lies below the bound; `quantity` names what it is, once in a test."""
    assert value < bound, f"{quantity} is {value:.3g} and must be below {bound:.3g}"
    _note(float(value), float(bound), quantity, "below")


def beyond(value: float, bound: float, quantity: str) -> None:
    """The value lies above the bound: what something broken must show, or what a quantity must at least reach."""
    assert value > bound, f"{quantity} is {value:.3g} and must be above {bound:.3g}"
    _note(float(value), float(bound), quantity, "above")


def absolute_error(found: ArrayLike, expected: ArrayLike) -> float:
    """The largest difference."""
    return float(np.max(np.abs(np.subtract(found, expected))))


def relative_error(found: ArrayLike, expected: ArrayLike) -> float:
    """The largest difference over the size of what is expected there; 0 where both are zero."""
    difference, size = np.abs(np.subtract(found, expected)), np.abs(expected)
    return float(np.max(np.where(difference == 0, 0.0, difference / np.where(size == 0, np.finfo(float).tiny, size))))


def _note(value: float, bound: float, quantity: str, side: str) -> None:
    place = os.environ.get("PYTEST_CURRENT_TEST", "").rsplit(" (", 1)[0].split("[")[0].split("@")[0]
    if "::" in place:
        file, test = place.split("::")
        note((file, test, quantity, side), Row(bound, value))


def note(key: Key, row: Row) -> None:
    """Keeps the call that came nearest to its bound."""
    if key not in seen or row.slack(key[3]) < seen[key].slack(key[3]):
        seen[key] = row


def rounded(row: Row) -> Row:
    """To the digits of the table."""
    return replace(row, bound=float(f"{row.bound:.2g}"), measured=float(f"{row.measured:.2g}"))


def table_of(file: str) -> str:
    """The table of a file of tests; both from the project's root."""
    return str(Path(file).parent / "bounds.csv")


def read(root: Path, table: str) -> dict[Key, Row]:
    if not (root / table).exists():
        return {}
    with (root / table).open(newline="", encoding="utf-8") as lines:
        return {
            (str(Path(table).parent / file), test, row["quantity"], row["side"]): Row(
                float(row["bound"]), float(row["measured"]), row["reason"]
            )
            for row in csv.DictReader(lines)
            for file, test in [row["test"].split("::")]
        }


def write(table: Path, rows: dict[Key, Row]) -> None:
    if not rows:
        table.unlink(missing_ok=True)
        return
    with table.open("w", newline="", encoding="utf-8") as lines:
        out = csv.writer(lines, lineterminator="\n")
        out.writerow(COLUMNS)
        for (file, test, quantity, side), row in sorted(rows.items()):
            figures = (f"{x:.2g}" for x in (row.bound, row.measured, row.slack(side)))
            out.writerow((f"{Path(file).name}::{test}", quantity, side, *figures, row.reason))


def recorded(old: dict[Key, Row], files: set[str]) -> dict[Key, Row]:
    """The rows of a table after a whole run of these of its files."""
    rows = {key: row for key, row in old.items() if key[0] not in files}
    for key, row in seen.items():
        if key[0] in files:
            was = old.get(key)
            measured = was.measured if was and not row.differs(was, STILL) else row.measured
            rows[key] = rounded(replace(row, measured=measured, reason=was.reason if was else ""))
    return rows


def faults(old: dict[Key, Row], files: set[str], whole: bool) -> list[str]:
    """What is wrong between a table and a run of these of its files; whole: every test of them ran."""
    return [
        f"{key[0]}::{key[1]}, {key[2]} ({key[3]}): {fault}"
        for key in sorted({k for k in seen if k[0] in files} | {k for k in old if whole and k[0] in files})
        if (fault := _fault(key, old.get(key), seen.get(key), old, whole))
    ]


def _fault(key: Key, row: Row | None, now: Row | None, old: dict[Key, Row], whole: bool) -> str:
    if row is None:
        return "has no row in bounds.csv"
    if now is None:
        return "has a row in bounds.csv and is measured no more"
    nearer = now.slack(key[3]) < row.slack(key[3])
    if now.differs(row, STALE) and (whole or nearer):
        return f"was {row.measured:.2g} in bounds.csv and is {now.measured:.2g}"
    if whole and f"{now.bound:.2g}" != f"{row.bound:.2g}":
        return f"the bound was {row.bound:.2g} in bounds.csv and is {now.bound:.2g}"
    partner = old.get((*key[:3], "below"))
    breaks_the_bound = key[3] == "above" and partner is not None and partner.bound == row.bound
    if row.slack(key[3]) > SLACK and not row.reason and not breaks_the_bound:
        return f"the bound has {row.slack(key[3]):.2g} times slack, more than {SLACK:g}, and no reason in its row"
    return ""
