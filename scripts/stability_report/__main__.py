"""python -m stability_report: runs every study and writes docs/results/stability.md with its figures."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from plotting import style  # noqa: E402
from robustness import checks, drift, long_runs, regularized  # noqa: E402
from robustness.sweep import sweep  # noqa: E402
from robustness.verdicts import judge_case  # noqa: E402
from support.motion import Library  # noqa: E402

from . import figures  # noqa: E402
from .isolated import Broken, call, call_each  # noqa: E402
from .page import page  # noqa: E402
from .report import Results  # noqa: E402

THRESHOLD = 200.0  # decay number of the automatic rule, fmu-src/wheel/scene.cpp
DEADLINE = 120.0  # s for one case at all tolerances; the slowest needs ten


def say(text: str) -> None:
    print(text, flush=True)


def run_sweep(library: Library, results: Results, only: str) -> None:
    cases = [case for case in sweep() if only in str(case)]
    for case, verdicts in call_each(lambda c: judge_case(library, c), cases, DEADLINE):
        results.sweep[str(case)] = (case, verdicts)
        good = not isinstance(verdicts, Broken) and all(v.holds for v in verdicts)
        say(f"  {'as expected' if good else 'NOT AS EXPECTED'}: {case}")


def run_study(name: str, work: Callable[[], Any], deadline: float) -> Any:
    before = perf_counter()
    answer = call(lambda _: work(), None, deadline)
    if isinstance(answer, Broken):
        raise SystemExit(f"stability: {name} {answer}")
    say(f"  {name}: {perf_counter() - before:.0f} s")
    return answer


def run_studies(library: Library, results: Results, full_day: bool) -> None:
    for group, check in checks.GROUPS.items():
        results.contract[group] = call(lambda _, check=check: check(library), None, DEADLINE)
    results.regularized = run_study("regularized law", lambda: regularized.study(library), 300)
    results.crossings = run_study("choice of method", lambda: regularized.crossings(library), 300)
    results.long_runs = run_study("long runs", lambda: long_runs.study(library, full_day), 600)
    results.resolved = run_study("an hour of slips", lambda: long_runs.resolved(library), 300)
    results.drifts = run_study("constraint drift", lambda: drift.study(library), 300)


def write(results: Results, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    style.use_style()
    figures.draw_sweep(results.verdicts(), folder / "stability_sweep.png")
    figures.draw_regularized(results.regularized, folder / "stability_regularized.png")
    figures.draw_crossings(results.crossings, THRESHOLD, folder / "stability_methods.png")
    figures.draw_long(results.long_runs, folder / "stability_long.png")
    figures.draw_drift(results.drifts, folder / "stability_drift.png")
    (folder / "stability.md").write_text(page(results, THRESHOLD))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    default = Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release")) / "wheel.fmu"
    parser.add_argument("--fmu", type=Path, default=default)
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "results")
    parser.add_argument("--only", default="", help="cases whose name contains this text; the sweep alone, no report")
    parser.add_argument("--short", action="store_true", help="leave the runs of 24 h out")
    arguments = parser.parse_args()
    before, results = perf_counter(), Results()
    library = Library.unpacked(arguments.fmu)
    run_sweep(library, results, arguments.only)
    if not arguments.only:
        run_studies(library, results, not arguments.short)
        results.seconds = perf_counter() - before
        write(results, arguments.out)
        say(f"Written: {arguments.out / 'stability.md'}")
    library.remove()
    faults = results.faults()
    say("\n".join(faults) or "All as expected.")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
