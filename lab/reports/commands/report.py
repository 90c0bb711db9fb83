"""Measures accuracy, speed and more, and writes the pages of docs/results."""

import os
from argparse import Namespace

from lab.reports import options
from wheelfmu.commands.build import build
from wheelfmu.fmu.files import alone
from wheelfmu.fmu.paths import ROOT

reads = options.arguments
needs = options.needs


def main(given: Namespace) -> int:
    if not given.names:
        print(options.listing())
        return 0
    if not (given.render or given.check):
        build("release")
    os.environ["OMP_NUM_THREADS"] = "1"  # before numpy is loaded
    from lab.reports.__main__ import main as report

    with alone(ROOT / "docs" / "results"):
        return report(given)
