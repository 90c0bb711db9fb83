"""./scripts/report NAME…|all: measures, and writes docs/results/NAME.md, its pictures and docs/results/data/NAME*.csv.

These files are kept under version control; then the figures in all pages are filled in from the data.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from time import monotonic

import figures_in_pages
from support.motion import Library
from support.paths import ROOT, build_folder

from .page import Report

NAMES = ("accuracy", "stability", "speed", "inputs", "partners")
Part = Callable[[Report], None]


class Progress:
    """Says what is being done, and how long the rest takes at the pace so far."""

    def __init__(self, parts: list[tuple[str, Part, float]]) -> None:
        self.total, self.done, self.begin = sum(seconds for *_, seconds in parts), 0.0, monotonic()

    def say(self, text: str) -> None:
        spent = monotonic() - self.begin
        pace = spent / self.done if self.done else 1.0
        print(f"[{spent:4.0f} s, {pace * (self.total - self.done):4.0f} s left] {text}", file=sys.stderr, flush=True)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/report", description=__doc__)
    parser.add_argument("names", nargs="+", metavar="NAME", choices=(*NAMES, "all"), help=", ".join((*NAMES, "all")))
    parser.add_argument("--quick", action="store_true", help="fewer cases, into build/report: to see that it works")
    parser.add_argument("--against", default="", metavar="REVISION", help="speed: also measure this older version")
    return parser.parse_args()


def parts_of(names: list[str]) -> list[tuple[str, Part, float]]:
    found = []
    for name in names:
        parts: dict[Part, float] = import_module(f".{name}", __package__).PARTS
        found += [(name, part, seconds) for part, seconds in parts.items()]
    return found


def main() -> int:
    options = arguments()
    names = list(NAMES) if "all" in options.names else list(dict.fromkeys(options.names))
    folder = ROOT / "build" / "report" / "quick" if options.quick else ROOT / "docs" / "results"
    folder.mkdir(parents=True, exist_ok=True)
    library, parts = Library.unpacked(build_folder() / "wheel.fmu"), parts_of(names)
    progress = Progress(parts)
    reports = {name: Report(name, library, folder, options.quick, {"against": options.against}) for name in names}
    for i, (name, part, seconds) in enumerate(parts):
        progress.say(f"{name}: {(part.__doc__ or part.__name__).splitlines()[0]}")
        part(reports[name])
        progress.done += seconds
        if i + 1 == len(parts) or parts[i + 1][0] != name:
            say_result(reports[name])
    library.remove()
    if not options.quick:
        sys.argv = sys.argv[:1]
        figures_in_pages.main()
    return int(any(report.missed for report in reports.values()))


def say_result(report: Report) -> None:
    path = report.write()
    missed = "; ".join(f"{f.what}: {f.measured:.3g} {f.unit}, asked {f.asked:g}" for f in report.missed)
    print(f"Wrote {Path(path).relative_to(ROOT)}. " + (f"Not met: {missed}." if missed else "All is as asked."))


if __name__ == "__main__":
    sys.exit(main())
