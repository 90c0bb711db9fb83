"""How fast studies run here, how two workers compare with one, and what a thousand would do.

`./scripts/study scaling` measures and writes a page; `--publish` writes it into docs/results/studies.md and its data.
Each measured study takes some seconds. One round is thrown away, then runs with one and with two workers take turns,
and the median counts. The estimate for n workers is n times one worker's speed, lowered by what the second worker lost,
unless the caller would be busy all the time handing out tasks. `./scripts/study million` gives the page's last table.
"""

from __future__ import annotations

import os
import platform
import shutil
import tempfile
from datetime import UTC, datetime
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

import numpy as np
import pandas as pd
from study import Study

REPEATS = 3
STATE, EXTREME = {"measures": {"theta_end": "theta"}}, {"measures": {"lowest": "lowest"}}
ASKED = {  # what is asked, and of how many wheels
    "state at the end": (STATE, 48_000),
    "state at the end, with friction": (STATE | {"values": {"s": 0.03}}, 9_600),
    "lowest angle over steps of 0.1 s": (EXTREME | {"interval": 0.1}, 24_000),
    "lowest angle over steps of 0.01 s": (EXTREME | {"interval": 0.01}, 24_000),
}
MILLION = "study_million.csv"


def part_of_the_map(asked: dict[str, object], wheels: int) -> Study:
    """Wheels between 10 and 89 degrees, 0.5 and 12 rad/s, 10 s each."""
    angles = np.radians(np.linspace(10, 89, wheels // 80))
    return Study(grid={"theta_start": angles, "phi_dot_start": -np.linspace(0.5, 12, 80)}, **asked)


def timed(study: Study, fmu: Path, folder: Path, **how: object) -> tuple[float, float, float]:
    """Wheels per second, the share of the workers' time spent in the FMU, and the caller's time on a processor."""
    begin, busy = perf_counter(), process_time()
    results = study.run(folder / "timed.zarr", fmu=fmu, overwrite=True, quiet=True, **how)
    seconds, busy = perf_counter() - begin, process_time() - busy
    return (
        results["status"].size / seconds,
        float(results["fmu_time"].sum() / results["wall_time"].sum()),
        busy / seconds,
    )


def speeds(fmu: Path, folder: Path) -> tuple[pd.DataFrame, float]:
    """Wheels per second with 1 and 2 workers for what is asked of a run; seconds of the caller for a task."""
    from study.crew import cluster  # here, so that the workers do not load it

    rows = {(what, n): [] for what in ASKED for n in (1, 2)}
    with cluster(1, None) as one, cluster(2, None) as two:
        for turn in range(REPEATS + 1):
            for what, (asked, wheels) in ASKED.items():
                for n, client in ((1, one), (2, two)):
                    speed = timed(part_of_the_map(asked, wheels if turn else 800), fmu, folder, client=client)
                    if turn:
                        rows[what, n].append(speed)
        part = list(np.zeros((8, 100)))  # the axes of a task
        begin = process_time()
        two.gather(two.map(len, [part] * 500, pure=False))
        task = (process_time() - begin) / 500
    table = [(what, n, *(median(values) for values in zip(*runs, strict=True))) for (what, n), runs in rows.items()]
    return pd.DataFrame(table, columns=["asked", "workers", "wheels_per_s", "fmu_share", "caller_busy"]), task


def estimate(table: pd.DataFrame, task: float) -> pd.DataFrame:
    """Wheels per second of many workers for each question, and how busy the caller would be."""
    from study.compute import task_seconds

    rows = []
    for what in ASKED:
        one, two = table[table["asked"] == what]["wheels_per_s"]
        for workers in (10, 100, 1000):
            busy = task * workers / task_seconds(workers)
            rows.append((what, workers, workers * one * min(1.0, two / (2 * one)) * min(1.0, 1 / busy), busy))
    return pd.DataFrame(rows, columns=["asked", "workers", "wheels_per_s", "caller_busy"])


def markdown(table: pd.DataFrame) -> str:
    """A table with headings; numbers below one as percentages, others rounded."""
    shown = [
        [f"{v:.1%}" if isinstance(v, float) and v < 1 else f"{v:,.0f}" if not isinstance(v, str) else v for v in row]
        for row in table.itertuples(index=False)
    ]
    names = [name.replace("_per_s", "/s").replace("_MB", " [MB]").replace("_", " ") for name in table.columns]
    return "\n".join("| " + " | ".join(line) + " |" for line in [names, ["---"] * len(names), *shown])


def measure(fmu: Path, folder: Path) -> list[Path]:
    """Measures, and writes studies.md and data/study_speed.csv, data/study_estimate.csv; returns their paths."""
    load, data, scratch = os.getloadavg()[0], folder / "data", Path(tempfile.mkdtemp(prefix="scaling-"))
    try:
        table, task = speeds(fmu, scratch)
    finally:
        shutil.rmtree(scratch)
    guess = estimate(table, task)
    data.mkdir(parents=True, exist_ok=True)
    table.to_csv(data / "study_speed.csv", index=False, float_format="%.4g")
    guess.to_csv(data / "study_estimate.csv", index=False, float_format="%.4g")
    ratios = table.pivot(index="asked", columns="workers", values="wheels_per_s").loc[[*ASKED]]
    million = data / MILLION
    page = PAGE.format(
        speeds=markdown(table),
        gained="; ".join(f"{row[2] / row[1]:.2f} ({what})" for what, row in ratios.iterrows()),
        guess=markdown(guess),
        task=1e3 * task,
        million=markdown(pd.read_csv(million)) if million.exists() else "Not measured: `./scripts/study million` does.",
        cores=os.cpu_count(),
        load=load,
        busy=BUSY if load > 1 else "",
        system=platform.system(),
        machine=platform.machine(),
        date=datetime.now(UTC).date(),
        python=platform.python_version(),
    )
    (folder / "studies.md").write_text(page)
    return [folder / "studies.md", data / "study_speed.csv", data / "study_estimate.csv"]


BUSY = """
Other programs kept the processors busy meanwhile (see the load below), so all speeds here are too low, and so is the
gain of the second worker."""
PAGE = """# How fast studies run

Parts of the map of fates: wheels of 10 s with start values between 10 and 89 degrees, 0.5 and 12 rad/s. The figures are
medians of runs with one and with two workers in turn; the start of the workers is left out, the writing of the results
is not. The share is the part of a worker's time that is spent in calls of the FMU; the caller is busy for the part of
the time in which it occupies a processor, Dask's scheduler included.

{speeds}

Two workers against one: {gained} times as fast.{busy}

## A million wheels

One study of free wheels, stopped and continued: one row for each time that it was started and not killed. The states at
the end are kept, with the FMU's counters and messages. Memory is the largest of a process, and the disk is what the
results occupy at the end.

{million}

## A thousand workers, estimated

Wheels do not wait for each other, and workers write their results themselves, so workers add up until the caller, which
hands out every task, is busy all the time. A task is two seconds of work, and longer with more than a hundred workers.
Measured here: it takes {task:.2f} ms of the caller and Dask's scheduler. The estimate is therefore:

{guess}

Not in the estimate: the network, the store that all write to, and the time until a scheduler has a thousand workers.

---

Made by `./scripts/study scaling --publish` on {date}. {system} {machine}, {cores} processors, load {load:.1f} at the
start, Python {python}.
"""
