"""CSV files of numbers as programs and spreadsheets write them: names in the first row, a number in each cell.

Commas part the columns. A byte-order mark, blanks beside a value, a trailing comma and empty rows are no fault.
Standard library alone.
"""

import csv
import io
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from wheelfmu.fmu.values import Fault, single

BOOLEANS = {"False": 0.0, "True": 1.0}  # as FMPy writes them


class Table(NamedTuple):
    """The columns by name, as texts, and the line of each row in the file."""

    path: Path
    columns: dict[str, list[str]]
    lines: list[int]

    def read(self, name: str, parse: Callable[[str], float]) -> list[float]:
        """A column of values; Fault with the place of one that cannot be meant."""
        found = []
        for line, text in zip(self.lines, self.columns[name], strict=True):
            try:
                found.append(parse(text))
            except ValueError as fault:
                raise Fault(f"{self.path}, line {line}, column {[*self.columns].index(name) + 1}: {fault}") from None
        return found

    def numbers(self, name: str) -> list[float]:
        """A column in SI without units."""

        def plain(text: str) -> float:
            try:
                return BOOLEANS[text] if text in BOOLEANS else float(text)
            except ValueError:
                raise Fault(f'{name} = "{text}" is not a number.') from None

        return self.read(name, plain)


def read_table(path: Path) -> Table:
    """The table of a file; Fault where it is none."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as fault:
        raise Fault(f"{path} cannot be read: {fault.strerror}.") from None
    except UnicodeDecodeError:
        raise Fault(f"{path} cannot be read: it is not UTF-8 text.") from None
    first = next((line for line in text.splitlines() if line.strip()), "")  # names have neither mark, quoted or not
    for mark, word in {";": "semicolons", "\t": "tabs"}.items():
        if mark in first.strip():
            raise Fault(f"{path}: {word} separate its columns; write commas, and points as decimal marks.")
    reader = csv.reader(io.StringIO(text, newline=""), skipinitialspace=True, strict=True)
    try:
        rows = [(reader.line_num, cells) for row in reader if any(cells := [cell.strip() for cell in row])]
    except csv.Error as fault:
        raise Fault(f"{path}, line {reader.line_num}: {fault}.") from None
    header, rows = (rows[0][1] if rows else []), rows[1:]
    width = max((k for k, name in enumerate(header, 1) if name), default=0)
    if nameless := [k for k, name in enumerate(header[:width], 1) if not name]:
        raise Fault(f"{path}: column {nameless[0]} has no name in the first row.")
    single((f"{path}: {name}", f"column {k}") for k, name in enumerate(header[:width], 1))
    if not rows:
        raise Fault(f"{path} has no rows: a row of names, then rows of numbers, are expected.")
    for line, cells in rows:
        if len(cells) < width or any(cells[width:]):
            raise Fault(f"{path}, line {line}: {len(cells)} values for the {width} names of the first row.")
    columns = {name: [cells[k] for _, cells in rows] for k, name in enumerate(header[:width])}
    return Table(path, columns, [line for line, _ in rows])
