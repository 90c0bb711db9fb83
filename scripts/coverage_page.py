#!/usr/bin/env python3
"""docs/results/coverage.md out of gcovr's JSON: lines and branches of fmu-src, and why the rest is not reached.

A line or branch counts as reached if any instantiation of its function reaches it. Status 1 if less than 95 % of the
lines are reached, or a line that is not has no reason below.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "results" / "coverage.md"
LEAST = 95.0  # per cent of lines

# What no test reaches: file, a piece of the first line's text, and why. A reason holds for the range that starts there.
SHORT = "only where there is no memory left: tests/robustness/faults"
CHECKED = "CVodeInit refuses a vector without this operation, and calls none of it in the set-ups used here"
ASKED = "SUNDIALS asks for it only when it is built with its own error checks"
FMI, INTEGRATOR = "fmu-src/fmi/", "fmu-src/integrator/"
REASONS: tuple[tuple[str, str, str], ...] = (
    (FMI + "fmu_state.cpp", "out of memory", SHORT),
    (FMI + "fmu_state.cpp", "the solver does not", "CVODE would have to refuse a restart; nothing tried leads there"),
    (
        INTEGRATOR + "step.cpp",
        "solution.restart(t, data(self.y)",
        "only an input's slope of 1e30 N m/s at the tolerance 1e-13 led there, of all that were tried",
    ),
    (INTEGRATOR + "state_vector.h", "WHEEL_PREDICT(11)", "above the highest order set in integrator.cpp"),
    (INTEGRATOR + "state_vector.cpp", "N_Vector_ID id", ASKED),
    (INTEGRATOR + "state_vector.cpp", "double norm(", CHECKED),
    (INTEGRATOR + "state_vector.cpp", "void add_constant(", CHECKED),
    (INTEGRATOR + "state_vector.cpp", "double dot(", ASKED),
    (INTEGRATOR + "state_vector.cpp", "double least(", CHECKED),
)


@dataclass
class File:
    """One source file: hits by line number, and by branch of a line."""

    name: str
    lines: dict[int, int] = field(default_factory=dict)
    branches: dict[tuple[int, int], int] = field(default_factory=dict)

    def take(self, line: dict) -> None:
        number = line["line_number"]
        self.lines[number] = self.lines.get(number, 0) + line["count"]
        for i, branch in enumerate(b for b in line.get("branches", []) if not b.get("throw")):
            self.branches[number, i] = self.branches.get((number, i), 0) + branch["count"]

    def missing(self) -> list[tuple[int, int]]:
        """Ranges of lines that are not reached; lines without code join what they lie between."""
        ranges = []
        for reached, numbers in groupby(sorted(self.lines), key=lambda n: self.lines[n] > 0):
            if not reached:
                inside = list(numbers)
                ranges.append((inside[0], inside[-1]))
        return ranges

    def reason(self, first: int) -> str | None:
        text = (ROOT / self.name).read_text().splitlines()[first - 1]
        return next((why for name, piece, why in REASONS if name == self.name and piece in text), None)


def read(report: Path) -> list[File]:
    files = []
    for entry in json.loads(report.read_text())["files"]:
        file = File(entry["file"])
        for line in entry["lines"]:
            if not line.get("gcovr/noncode"):
                file.take(line)
        files.append(file)
    return sorted((f for f in files if f.lines), key=lambda f: f.name)


def share(hits: list[int]) -> str:
    reached = sum(hit > 0 for hit in hits)
    return f"{reached} of {len(hits)} ({100 * reached / len(hits):.1f} %)" if hits else ""


def table(files: list[File]) -> list[str]:
    rows = ["| file | lines | branches |", "|---|---|---|"]
    rows += [f"| {f.name} | {share([*f.lines.values()])} | {share([*f.branches.values()])} |" for f in files]
    lines = [hit for f in files for hit in f.lines.values()]
    branches = [hit for f in files for hit in f.branches.values()]
    return [*rows, f"| **all** | **{share(lines)}** | **{share(branches)}** |"]


def unreached(files: list[File]) -> tuple[list[str], int]:
    """The table of what is not reached, and how many ranges in it have no reason."""
    rows, unknown = ["| file | lines | why |", "|---|---|---|"], 0
    for f in files:
        for first, last in f.missing():
            why = f.reason(first)
            unknown += why is None
            rows.append(f"| {f.name} | {first}{f'-{last}' * (last > first)} | {why or '**no reason known**'} |")
    return rows, unknown


def main(report: Path) -> int:
    files = read(report)
    rows, unknown = unreached(files)
    lines = [
        "# Coverage of fmu-src by the tests",
        "",
        "Made by `scripts/coverage`: gcov through gcovr, by the tests of contract, partners and equations, the quick",
        "ones of physics, and the fuzzer's corpus. A line counts as reached if one instantiation of its template is.",
        "Branches are the compiler's: each way of each comparison, in state_vector.h once per place of inlining.",
        "",
        *table(files),
        "",
        "## What no test reaches",
        *rows,
    ]
    PAGE.write_text("\n".join(lines) + "\n")
    hits = [hit for f in files for hit in f.lines.values()]
    percent = 100 * sum(hit > 0 for hit in hits) / len(hits)
    print(f"{share(hits)} of the lines of fmu-src are reached; {unknown} ranges without a reason.")
    return int(percent < LEAST or unknown > 0)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
