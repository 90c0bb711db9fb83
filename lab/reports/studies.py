"""How fast studies run, for `speed`: wheels per second with one and with two workers, in turn; the median counts."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd

from wheelfmu.fmu.paths import build_folder

from .page import Report, part

REPEATS = 3
LOWEST: dict[str, Any] = {"measures": {"lowest": "lowest"}}
ASKED: dict[str, tuple[dict[str, Any], int]] = {  # what is asked, and of how many wheels
    "state at the end": ({"measures": {"theta_end": "theta"}}, 96_000),
    "state at the end, with friction": ({"measures": {"theta_end": "theta"}, "values": {"s": 0.03}}, 19_200),
    "lowest angle over steps of 0.1 s": (LOWEST | {"interval": 0.1}, 48_000),
    "lowest angle over steps of 0.01 s": (LOWEST | {"interval": 0.01}, 48_000),
}
FEW = 800  # wheels


def rate(what: str, wheels: int, folder: Path, workers: object) -> dict[str, float]:
    """Of wheels between 10 and 89 degrees, 0.5 and 12 rad/s, 10 s each."""
    from lab.studies import Study

    angles = np.radians(np.linspace(10, 89, wheels // 80))
    study = Study(grid={"theta_start": angles, "phi_dot_start": -np.linspace(0.5, 12, 80)}, **ASKED[what][0])
    begin = perf_counter()
    results = study.run(folder / "timed.zarr", fmu=build_folder() / "wheel.fmu", workers=workers, overwrite=True)
    share = float(results["fmu_time"].sum() / results["wall_time"].sum())
    return {"wheels/s": results["status"].size / (perf_counter() - begin), "FMU share": share}


@part(250)
def studies(report: Report) -> pd.DataFrame:
    """studies with one and with two workers"""
    from lab.studies.compute import cluster

    runs = []
    with TemporaryDirectory() as folder, cluster(1) as one, cluster(2) as two:
        turns = range(2 if report.quick else REPEATS + 1)  # the first one warms up
        for turn, (what, (_, wheels)), (n, workers) in product(turns, ASKED.items(), ((1, one), (2, two))):
            found = rate(what, wheels if turn and not report.quick else FEW, Path(folder), workers)
            runs += [{"asked": what, "workers": n} | found] * (turn > 0)
    return pd.DataFrame(runs).groupby(["asked", "workers"], sort=False).median().reset_index()
