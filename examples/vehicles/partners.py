"""Builds the partners, runs every example, writes docs/results/partners.md, inputs.md, figures and the picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from . import driven, figures, inputs, picture, report, ssp, suspended
from .build import ROOT, build_all


def package_errors(package: Path, truth: dict[str, np.ndarray]) -> list[tuple[float, float]]:
    """Error of fmpy's run of the SSP package at some steps."""
    return [(h, suspended.package_distance(package, h, truth)) for h in suspended.STEPS[1:4]]


def main() -> None:
    """All of it."""
    folder = ROOT / "build" / "examples"
    fmus = build_all(folder)
    drive = driven.run(fmus)
    figures.draw_drive(drive, report.RESULTS / "partners_driven.png")
    truth = suspended.together()
    found = suspended.convergence(fmus, truth)
    launch = suspended.coupled(fmus, 0.000625, "derivatives", grid=0.005)
    figures.draw_launch(launch, found, report.RESULTS / "partners_suspended.png")
    picture.draw(ROOT / "docs" / "figures" / "vehicle")
    errors = package_errors(ssp.build(suspended.system(fmus), folder), truth)
    written = (
        report.write_partners(fmus, driven.judge(drive), found, truth, errors),
        report.write_inputs(inputs.measure(fmus["wheel"])),
    )
    for path in written:
        print(f"Wrote {path.relative_to(ROOT)}.")


if __name__ == "__main__":
    main()
