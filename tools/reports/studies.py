"""How fast studies run here, how two workers compare with one, and what a thousand would do.

Each measured study takes some seconds. One round is thrown away, then runs with one and with two workers take turns,
and the median counts. The estimate for n workers is n times one worker's speed, lowered by what the second worker lost,
unless the caller would be busy all the time handing out tasks.
"""

from __future__ import annotations

from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, process_time

import numpy as np
import pandas as pd
from support.paths import build_folder

from .page import Report, Tables, part

REPEATS = 3
STATE, EXTREME = {"measures": {"theta_end": "theta"}}, {"measures": {"lowest": "lowest"}}
ASKED = {  # what is asked, and of how many wheels
    "state at the end": (STATE, 96_000),
    "state at the end, with friction": (STATE | {"values": {"s": 0.03}}, 19_200),
    "lowest angle over steps of 0.1 s": (EXTREME | {"interval": 0.1}, 48_000),
    "lowest angle over steps of 0.01 s": (EXTREME | {"interval": 0.01}, 48_000),
}
FEW = 800  # wheels


def timed(what: str, wheels: int, folder: Path, workers: object) -> dict[str, float]:
    """Of wheels between 10 and 89 degrees, 0.5 and 12 rad/s, 10 s each."""
    from study import Study

    angles = np.radians(np.linspace(10, 89, wheels // 80))
    study = Study(grid={"theta_start": angles, "phi_dot_start": -np.linspace(0.5, 12, 80)}, **ASKED[what][0])
    begin, busy = perf_counter(), process_time()
    results = study.run(folder / "timed.zarr", fmu=build_folder() / "wheel.fmu", workers=workers, overwrite=True)
    seconds, busy = perf_counter() - begin, process_time() - busy
    share = float(results["fmu_time"].sum() / results["wall_time"].sum())
    return {"wheels_per_s": results["status"].size / seconds, "fmu_share": share, "caller_busy": busy / seconds}


@part(300)
def speed(report: Report) -> dict[str, object]:
    """one and two workers in turn; the estimate for many"""
    from distributed import Client
    from study.compute import cluster, most

    runs = []
    with TemporaryDirectory() as folder, cluster(1) as one, cluster(2) as two, Client(two) as client:
        turns = range(2 if report.quick else REPEATS + 1)
        for turn, (what, (_, wheels)), (n, workers) in product(turns, ASKED.items(), ((1, one), (2, two))):
            found = timed(what, wheels if turn and not report.quick else FEW, Path(folder), workers)
            runs += [{"asked": what, "workers": n} | found] * (turn > 0)
        part = list(np.zeros((8, 100)))  # the axes of a task
        begin = process_time()
        client.gather(client.map(len, [part] * 500, pure=False))
        task = (process_time() - begin) / 500
    table = pd.DataFrame(runs).groupby(["asked", "workers"], sort=False).median()
    wheels = table["wheels_per_s"].unstack(sort=False)
    alone, estimate = np.minimum(wheels[1], wheels[2] / 2), []
    for what, n in product(ASKED, (10, 100, 1000)):
        busy = task * n * wheels[1][what] / most(1000, n)
        speed = n * alone[what] * min(1.0, 1 / busy)
        estimate.append({"asked": what, "workers": n, "wheels_per_s": speed, "caller_busy": busy})
    return {"speed": table.reset_index(), "estimate": estimate, "task": 1e3 * task}


def views(tables: Tables) -> Tables:
    """Columns in words."""
    words = {"wheels_per_s": "wheels/s", "fmu_share": "fmu share", "caller_busy": "caller busy"}
    return {name: rows.rename(columns=words) for name, rows in tables.items()}
