#!/usr/bin/env python3
"""Measure the built FMU's accuracy and cost; write docs/results/accuracy.md and its figures.

Motions run through fmpy's FMU2Slave in this process; the truth is tests/reference (the tables of the paper's scenes are
kept there) or a closed form. Every conclusion is computed from the numbers it stands on.
"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from plotting import style  # noqa: E402
from reports import accuracy_cost, accuracy_exact, accuracy_paper, accuracy_scenes  # noqa: E402
from reports.machine import build_folder, footer  # noqa: E402
from reports.markdown import document, number, table  # noqa: E402
from support.motion import Library  # noqa: E402

FOLDER = ROOT / "docs" / "results"
INTRODUCTION = """How exact wheel.fmu is, and what a solution costs. All motions come out of the built FMU, driven by
fmpy; the default tolerance is that of `modelDescription.xml`. The paper's scenes are judged by tables kept
in `tests/reference`, all other scenes by the same independent reference (quaternion, all reactions unknown) and by
closed forms. The tests under `tests/physics` bound what is shown here."""


def main() -> int:
    style.use_style()
    FOLDER.mkdir(parents=True, exist_ok=True)
    product = Library.unpacked(build_folder() / "wheel.fmu")
    parts = []
    try:
        for report in (accuracy_paper, accuracy_scenes, accuracy_exact, accuracy_cost):
            parts += report.parts(product, FOLDER)
    finally:
        product.remove()
    checks = [check for part in parts for check in part.checks]
    missed = [check for check in checks if not check.met]
    verdict = "All are met." if not missed else "Not met: " + "; ".join(check.figure for check in missed) + "."
    rows = [(c.figure, f"{c.relation} {number(c.asked)}", c.measured, "yes" if c.met else "**no**") for c in checks]
    summary = f"## Asked and measured\n\n{verdict}\n\n" + table(["figure", "asked", "measured", "met"], rows)
    sections = [INTRODUCTION, summary, *(part.text for part in parts), footer("scripts/accuracy")]
    target = FOLDER / "accuracy.md"
    target.write_text(document("Accuracy and cost of wheel.fmu", sections))
    print(f"Wrote {target.relative_to(ROOT)}. {verdict}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
