"""Axle and car: docs/results/vehicles.md by the studies of examples/vehicles, which write data and page themselves."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from support.paths import ROOT
from vehicles import vehicle_report

from .page import Report
from .partners import fmus


def study(report: Report) -> None:
    """the studies of axle and car"""
    if not report.quick:
        vehicle_report.write(fmus(report), report.folder, report.options["tools"])
        return
    for table in vehicle_report.TABLES:
        shutil.copy(ROOT / "docs" / "results" / "data" / f"{table}.csv", report.folder / "data")
    vehicle_report.axle_steps(fmus(report), report.folder)


def page(folder: Path) -> None:
    vehicle_report.page(folder)


PARTS: dict[Callable[[Report], None], float] = {study: 600}
