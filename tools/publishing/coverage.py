"""Data of docs/testing.md from gcovr's reports: lines and branches of fmu-src, and why the rest is not reached.

    python -m publishing.coverage TABLE.csv COBERTURA.xml

A line or branch counts as reached if any instantiation of its function reaches it. Status 1 if less than 95 % of the
lines are reached, a line that is not has no reason below, or a reason names code that is gone.
"""

from __future__ import annotations

import sys
from itertools import groupby
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd

from publishing.markdown import ROOT

DATA = ROOT / "docs" / "results" / "data"
LEAST = 95.0  # per cent of lines
# What no test reaches: file, a piece of the text of the first line of a range, and why.
UNUSED = "a vector of SUNDIALS must have it; nothing calls it in the set-ups used here"
VECTOR = "fmu-src/solver/cvode_vector.cpp"
OBSERVED = "for events that are only counted; tests/repository/test_event_recipe.py adds them to a copy"
REASONS = (
    *((VECTOR, f"o.nv{name} = ", UNUSED) for name in ("getvectorid", "getlength", "prod", "addconst")),
    ("fmu-src/fmi/derivatives.cpp", "no valid initial values", "each allowed start has allowed ones beside it"),
    ("fmu-src/orbit/orbit.cpp", "return solver::Outcome::failed;", OBSERVED),
    ("fmu-src/wheel/events.cpp", "Consequence observe(", OBSERVED),
    ("fmu-src/solver/solver.cpp", "step_.set_point(stop,", "a stop time within rounding of a step's end: none was met"),
)
COLUMNS = {"filename": "file", "line_covered": "lines reached", "line_total": "lines"}
COLUMNS |= {"branch_covered": "branches reached", "branch_total": "branches"}


def unreached(report: Path) -> pd.DataFrame:
    """Ranges of lines that are not reached; lines without code join what they lie between."""
    rows = []
    for unit in ElementTree.parse(report).iter("class"):
        file = unit.get("filename")
        texts = (ROOT / file).read_text(encoding="utf-8").splitlines()
        for missing, lines in groupby(unit.find("lines"), key=lambda line: line.get("hits") == "0"):
            if missing:
                first, *_, last = [int(line.get("number")) for line in lines] * 2
                whys = [why for name, piece, why in REASONS if name == file and piece in texts[first - 1]]
                span = f"{first}-{last}" if last > first else str(first)
                rows.append((file, span, *(whys or ["**no reason known**"])[:1]))
    return pd.DataFrame(rows, columns=["file", "lines", "why"])


def main(by_file: Path, report: Path) -> int:
    table, missing = pd.read_csv(by_file)[[*COLUMNS]].rename(columns=COLUMNS), unreached(report)
    share = {of: 100 * table[f"{of} reached"].sum() / table[of].sum() for of in ("lines", "branches")}
    whats = {"lines": "lines of fmu-src reached", "branches": "branches reached"}
    figures = [{"figure": of, "measured": round(share[of], 1), "unit": "%", "what": what} for of, what in whats.items()]
    for name, rows in (("", table), ("_unreached", missing), ("_all", pd.DataFrame(figures))):
        rows.to_csv(DATA / f"coverage{name}.csv", index=False)
    unknown = missing["why"].str.startswith("**").sum()
    gone = [f"{name}: {piece}" for name, piece, _ in REASONS if piece not in (ROOT / name).read_text(encoding="utf-8")]
    print(f"{share['lines']:.1f} % of the lines of fmu-src are reached; {unknown} ranges without a reason.")
    print(*(f"A reason names code that is gone: {reason}." for reason in gone), sep="\n", end="\n" if gone else "")
    return int(share["lines"] < LEAST or unknown > 0 or len(gone) > 0)


if __name__ == "__main__":
    sys.exit(main(*map(Path, sys.argv[1:])))
