#!/usr/bin/env python3
"""Writes the table of docs/interoperability.md from docs/results/data/interoperability.csv.

No paper equation and no frame: what other people's masters and checkers did with the FMU, noted by hand in the CSV.
With --check it changes nothing and tells by its exit status whether the page and the data differ.
"""

from __future__ import annotations

import argparse
import csv
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "interoperability.md"
DATA = ROOT / "docs" / "results" / "data" / "interoperability.csv"
BEGIN, END = "<!-- runs: scripts/interoperability_table.py -->", "<!-- end of runs -->"
ERRORS = ("free", "friction")
HEAD = ("tool", "version", "tolerance passed", "default scene", "friction", "early end", "rollback", "remarks")


def read_runs(path: Path = DATA) -> list[dict[str, str]]:
    """One row per tool; the errors are relative, empty where the tool does not simulate."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def short(number: str) -> str:
    """Two digits and a plain exponent: 3.5e-9."""
    mantissa, exponent = f"{float(number):.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"


def table(runs: list[dict[str, str]]) -> str:
    rows = [[short(text) if name in ERRORS and text else text for name, text in run.items()] for run in runs]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (HEAD, ["---"] * len(HEAD), *rows))


def with_table(page: str, runs: list[dict[str, str]]) -> str:
    """The page's text with the table between its marks."""
    before, rest = page.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n\n{table(runs)}\n\n{END}{after}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="change nothing; exit status 1 if the page is stale")
    check = parser.parse_args().check
    page = PAGE.read_text(encoding="utf-8")
    fresh = with_table(page, read_runs())
    if check:
        return int(fresh != page)
    PAGE.write_text(fresh, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
