#!/usr/bin/env python3
"""Measure the built FMU's accuracy and cost; write docs/results/accuracy.md and its figures.

Motions run through fmpy's FMU2Slave in this process; the trusted tables are ../shared/reference, everything else is
judged by tests/reference or by closed forms. Every conclusion is computed from the numbers it stands on.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from fmpy import extract, read_model_description

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests"))

from physics.product import Product  # noqa: E402
from plotting import style  # noqa: E402
from reports import accuracy_cost, accuracy_exact, accuracy_paper, accuracy_scenes  # noqa: E402
from reports.machine import build_folder, footer  # noqa: E402
from reports.markdown import document, number, table  # noqa: E402

FOLDER = ROOT / "docs" / "results"
INTRODUCTION = """How exact wheel.fmu is, and what a solution costs. All motions come out of the built FMU, driven by
fmpy; the default tolerance is that of `modelDescription.xml`. The paper's scenes are judged by the trusted tables
beside the project (`../shared/reference`), all other scenes by the independent reference of `tests/reference`
(quaternion, all reactions unknown) and by closed forms. The tests under `tests/physics` bound what is shown here."""


def main() -> int:
    style.use_style()
    FOLDER.mkdir(parents=True, exist_ok=True)
    unpacked = extract(str(build_folder() / "wheel.fmu"))
    product = Product(unpacked, read_model_description(unpacked))
    parts = []
    try:
        for report in (accuracy_paper, accuracy_scenes, accuracy_exact, accuracy_cost):
            parts += report.parts(product, FOLDER)
    finally:
        shutil.rmtree(unpacked)
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
