"""How fast studies run here, how two workers compare with one, and what a thousand would do.

Each measured study takes some seconds. One round is thrown away, then runs with one and with two workers take turns,
and the median counts. The estimate for n workers is n times one worker's speed, lowered by what the second worker lost,
unless the caller would be busy all the time handing out tasks.
"""

from __future__ import annotations

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
COLUMNS = ["wheels_per_s", "fmu_share", "caller_busy"]
FEW = 800  # wheels


def timed(what: str, wheels: int, folder: Path, client: object) -> tuple[float, float, float]:
    """Of wheels between 10 and 89 degrees, 0.5 and 12 rad/s, 10 s each: COLUMNS."""
    from study import Study

    angles = np.radians(np.linspace(10, 89, wheels // 80))
    study = Study(grid={"theta_start": angles, "phi_dot_start": -np.linspace(0.5, 12, 80)}, **ASKED[what][0])
    begin, busy = perf_counter(), process_time()
    how = {"fmu": build_folder() / "wheel.fmu", "overwrite": True, "quiet": True}
    results = study.run(folder / "timed.zarr", client=client, **how)
    seconds, busy = perf_counter() - begin, process_time() - busy
    share = float(results["fmu_time"].sum() / results["wall_time"].sum())
    return results["status"].size / seconds, share, busy / seconds


@part(300)
def speeds(report: Report) -> None:
    """one and two workers in turn"""
    from study.compute import cluster

    rows: dict[tuple[str, int], list[tuple[float, ...]]] = {(what, n): [] for what in ASKED for n in (1, 2)}
    with TemporaryDirectory() as folder, cluster(1, None) as one, cluster(2, None) as two:
        for turn in range(2 if report.quick else REPEATS + 1):
            for what, n in rows:
                wheels = ASKED[what][1] if turn and not report.quick else FEW
                found = timed(what, wheels, Path(folder), (one, two)[n - 1])
                rows[what, n] += [found] * (turn > 0)
        part = list(np.zeros((8, 100)))  # the axes of a task
        begin = process_time()
        two.gather(two.map(len, [part] * 500, pure=False))
        task = (process_time() - begin) / 500
    medians = {key: np.median(runs, axis=0) for key, runs in rows.items()}
    table = pd.DataFrame([(*key, *row) for key, row in medians.items()], columns=["asked", "workers", *COLUMNS])
    report.table("speed", table)
    report.table("estimate", estimate(table, task))
    report.figures(task=1e3 * task)


def estimate(table: pd.DataFrame, task: float) -> pd.DataFrame:
    """Wheels per second of many workers for each question, and how busy the caller would be."""
    from study.compute import chunk_seconds

    rows = []
    for what in ASKED:
        one, two = table[table["asked"] == what]["wheels_per_s"]
        for workers in (10, 100, 1000):
            busy = task * workers / chunk_seconds(workers)
            rows.append((what, workers, workers * one * min(1.0, two / (2 * one)) * min(1.0, 1 / busy), busy))
    return pd.DataFrame(rows, columns=["asked", "workers", "wheels_per_s", "caller_busy"])


def views(tables: Tables) -> Tables:
    """Columns in words."""
    return {name: rows.rename(columns=words) for name, rows in tables.items()}


def words(column: str) -> str:
    return column.replace("_per_s", "/s").replace("_MB", ", MB").replace("_", " ")
