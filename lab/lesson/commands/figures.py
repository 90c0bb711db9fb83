"""Redraws the README's pictures: docs/figures/paper_diagrams.png, and wheel_motion.webp, which is recorded from
results/wheel.html in headless Chromium."""

from argparse import Namespace

from wheelfmu.commands import processes, run
from wheelfmu.fmu.files import alone, deliver
from wheelfmu.fmu.paths import ROOT

NEEDS = ("lesson", "browser")


def main(_given: Namespace) -> None:
    figures, results = ROOT / "docs" / "figures", ROOT / "results"
    with alone(figures):
        run.main([])
        deliver(results / "paper_diagrams.png", figures / "paper_diagrams.png")
        motion = figures / "wheel_motion.webp"
        processes.check(*processes.python("lab.lesson.animation", results / "wheel.html", motion))
