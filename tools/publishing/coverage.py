"""Data of docs/testing.md from gcovr's JSON: lines and branches of fmu-src, and why the rest is not reached.

A line or branch counts as reached if any instantiation of its function reaches it. Status 1 if less than 95 % of the
lines are reached, a line that is not has no reason below, or a reason names code that is gone.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pandas as pd

from publishing.markdown import ROOT

DATA = ROOT / "docs" / "results" / "data"
LEAST = 95.0  # per cent of lines
# What no test reaches: file, a piece of the text of the first line of a range, and why.
UNUSED = "a vector of SUNDIALS must have it; nothing calls it in the set-ups used here"
VECTOR = "fmu-src/solver/cvode_vector.cpp"
REASONS = (
    *((VECTOR, f"o.nv{name} = ", UNUSED) for name in ("getvectorid", "getlength", "prod", "addconst")),
    ("fmu-src/fmi/derivatives.cpp", "no allowed initial values", "each allowed start has allowed ones beside it"),
    ("fmu-src/fmi/model_exchange.cpp", "derivatives are not finite", "no such state was met"),
    ("fmu-src/solver/solver.cpp", "step_.set_point(stop,", "a stop time within rounding of a step's end: none was met"),
)


def share(hits: pd.Series) -> float:
    return round(100 * (hits > 0).mean(), 1)


def table(lines: pd.Series, branches: pd.Series) -> pd.DataFrame:
    """Per file: how many of its lines and branches are reached, and how many it has."""
    columns = {"lines": lines, "branches": branches}
    counts = {
        f"{name}{what}": hits.groupby("file").apply(count)
        for name, hits in columns.items()
        for what, count in ((" reached", lambda hits: (hits > 0).sum()), ("", len))
    }
    return pd.DataFrame(counts).astype("Int64").reset_index()


def unreached(lines: pd.Series) -> pd.DataFrame:
    """Ranges of lines that are not reached; lines without code join what they lie between."""
    rows = []
    for file, hits in lines.groupby("file"):
        missing, texts = hits == 0, (ROOT / str(file)).read_text(encoding="utf-8").splitlines()
        for _, numbers in hits[missing].groupby((missing != missing.shift()).cumsum()[missing]):
            first, last = numbers.index[0][1], numbers.index[-1][1]
            whys = [why for name, piece, why in REASONS if name == file and piece in texts[first - 1]]
            rows.append(
                (file, f"{first}-{last}" if last > first else str(first), *(whys or ["**no reason known**"])[:1])
            )
    return pd.DataFrame(rows, columns=["file", "lines", "why"])


def main(report: Path) -> int:
    files = json.loads(report.read_text(encoding="utf-8"))["files"]
    found = pd.json_normalize(files, "lines", "file")
    found = found.reindex(columns=["file", "line_number", "count", "branches", "gcovr/noncode"])
    found = found[found["gcovr/noncode"].isna()]
    lines = found.groupby(["file", "line_number"])["count"].sum()
    ways = found.explode("branches").dropna(subset="branches")
    ways = ways.assign(way=ways.groupby(level=0).cumcount(), count=[way["count"] for way in ways["branches"]])
    branches = ways.groupby(["file", "line_number", "way"])["count"].sum()
    missing = unreached(lines)
    figures = [
        ("lines", share(lines), "%", "lines of fmu-src reached"),
        ("branches", share(branches), "%", "branches reached"),
    ]
    all_of_it = pd.DataFrame(figures, columns=["figure", "measured", "unit", "what"])
    for name, rows in (("", table(lines, branches)), ("_unreached", missing), ("_all", all_of_it)):
        rows.to_csv(DATA / f"coverage{name}.csv", index=False)
    unknown = missing["why"].str.startswith("**").sum()
    gone = [f"{name}: {piece}" for name, piece, _ in REASONS if piece not in (ROOT / name).read_text(encoding="utf-8")]
    print(f"{share(lines)} % of the lines of fmu-src are reached; {unknown} ranges without a reason.")
    print(*(f"A reason names code that is gone: {reason}." for reason in gone), sep="\n", end="\n" if gone else "")
    return int(100 * (lines > 0).mean() < LEAST or unknown > 0 or len(gone) > 0)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
