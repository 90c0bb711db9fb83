"""How fast studies run here, how two workers compare with one, and what a thousand would do.

`./scripts/study scaling` measures and writes a table; `--publish` writes it into docs/results/studies.md and its data.
The measured study is a part of the map of fates. One run is thrown away, then runs with one and with two workers take
turns, and the median counts. The estimate for n workers is the smaller of two speeds: n times one worker's, lowered by
what the second worker lost; and the speed at which the caller can hand out blocks and write their results.
"""

from __future__ import annotations

import os
import platform
import shutil
import tempfile
from datetime import UTC, datetime
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
import pandas as pd
from study import Study

REPEATS = 3
ASKED = {
    "state at the end": {"measures": {"theta_end": "theta"}},
    "extremes over steps of 0.1 s": {"measures": {"lowest": "lowest"}, "interval": 0.1},
    "extremes over steps of 0.01 s": {"measures": {"lowest": "lowest"}, "interval": 0.01},
}
BLOCKS = (256, 4096)


def part_of_the_map(**asked: object) -> Study:
    """5,120 wheels between 10 and 90 degrees, 0.5 and 12 rad/s, 10 s each."""
    grid = {"theta_start": np.radians(np.linspace(10, 89, 64)), "phi_dot_start": -np.linspace(0.5, 12, 80)}
    return Study(grid=grid, **asked)


def timed(study: Study, fmu: Path, folder: Path, **how: object) -> tuple[float, float]:
    """Wheels per second, and the share of the workers' time spent in the FMU."""
    begin = perf_counter()
    results = study.run(folder / "timed.zarr", fmu=fmu, overwrite=True, quiet=True, **how)
    seconds = perf_counter() - begin
    return results["status"].size / seconds, float(results["fmu_time"].sum() / results["wall_time"].sum())


def speeds(fmu: Path, folder: Path) -> tuple[pd.DataFrame, float]:
    """Wheels per second with 1 and 2 workers for what is asked of a run; seconds to hand out an empty task."""
    from study.compute import cluster  # here, so that the workers do not load it

    rows = {(what, n): [] for what in ASKED for n in (1, 2)}
    with cluster(1, None) as one, cluster(2, None) as two:
        for turn in range(REPEATS + 1):
            for what, asked in ASKED.items():
                for n, client in ((1, one), (2, two)):
                    speed = timed(part_of_the_map(**asked), fmu, folder, client=client)
                    if turn:
                        rows[what, n].append(speed)
        begin = perf_counter()
        two.gather(two.map(abs, range(500), pure=False))
        task = (perf_counter() - begin) / 500
    table = [(what, n, *(median(values) for values in zip(*runs, strict=True))) for (what, n), runs in rows.items()]
    return pd.DataFrame(table, columns=["asked", "workers", "wheels_per_s", "fmu_share"]), task


def writing_time(fmu: Path, folder: Path, block: int) -> float:
    """Seconds that the caller takes to write the results of one block."""
    from fmpy import read_model_description
    from study.instance import counters_of
    from study.runs import empty_result
    from study.store import Store

    description = read_model_description(str(fmu), validate=False)
    study = Study(list={"s": np.zeros(8 * block)})
    job, counters = study.job(description), counters_of(description)
    store = Store.create(folder / f"written_{block}.zarr", study, job, description, {}, block)
    result = empty_result(job, block, len(counters))
    for name in ("wall_time", "fmu_time", "end_time", "theta_end"):
        result[name][:] = np.random.default_rng(1).random(block)  # numbers that do not compress, like real ones
    times = []
    for place in store.blocks():
        begin = perf_counter()
        store.write(place, result, counters)
        times.append(perf_counter() - begin)
    return median(times)


def estimate(table: pd.DataFrame, task: float, writing: dict[int, float]) -> pd.DataFrame:
    """Wheels per second of many workers for the study that looks every 0.01 s, and what limits them."""
    finest = table[table["asked"] == [*ASKED][-1]].set_index("workers")["wheels_per_s"]
    kept = min(1.0, finest[2] / (2 * finest[1]))
    rows = []
    for workers in (10, 100, 1000):
        for block, seconds in writing.items():
            work, caller = workers * finest[1] * kept, block / (task + seconds)
            limit = "the workers" if work < caller else "the caller, which writes every block"
            rows.append((workers, block, min(work, caller), limit))
    return pd.DataFrame(rows, columns=["workers", "block", "wheels_per_s", "limited_by"])


def markdown(table: pd.DataFrame) -> str:
    """A table with headings; numbers below one as percentages, others rounded."""
    shown = [
        [f"{v:.0%}" if isinstance(v, float) and v < 1 else f"{v:,.0f}" if not isinstance(v, str) else v for v in row]
        for row in table.itertuples(index=False)
    ]
    lines = [
        [name.replace("_per_s", "/s").replace("_", " ") for name in table.columns],
        ["---"] * table.shape[1],
        *shown,
    ]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def measure(fmu: Path, folder: Path) -> list[Path]:
    """Measures, and writes studies.md and data/study_speed.csv, data/study_estimate.csv; returns their paths."""
    load = os.getloadavg()[0]
    scratch = Path(tempfile.mkdtemp(prefix="scaling-"))
    try:
        table, task = speeds(fmu, scratch)
        writing = {block: writing_time(fmu, scratch, block) for block in BLOCKS}
    finally:
        shutil.rmtree(scratch)
    guess = estimate(table, task, writing)
    data = folder / "data"
    data.mkdir(parents=True, exist_ok=True)
    table.to_csv(data / "study_speed.csv", index=False, float_format="%.4g")
    guess.to_csv(data / "study_estimate.csv", index=False, float_format="%.4g")
    ratios = table.pivot(index="asked", columns="workers", values="wheels_per_s").loc[[*ASKED]]
    gained = "; ".join(f"{row[2] / row[1]:.2f} ({what})" for what, row in ratios.iterrows())
    page = PAGE.format(
        speeds=markdown(table),
        gained=gained,
        guess=markdown(guess),
        task=1e3 * task,
        write=" and ".join(f"{1e3 * s:.1f} ms ({b:,} wheels)" for b, s in writing.items()),
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

Part of the map of fates: 5,120 wheels, 10 s each, with start values between 10 and 89 degrees, 0.5 and 12 rad/s. The
figures are medians of runs with one and with two workers in turn; the start of the workers is left out, the writing of
the results is not. The share is the part of a worker's time that is spent in calls of the FMU.

{speeds}

Two workers against one: {gained} times as fast.{busy}
The caller works too: on two processors it takes a part of the second one, the larger the shorter the runs are.

## A thousand workers, estimated

Wheels do not wait for each other, so workers add up until the caller, which hands out every block and writes its
results, is busy all the time. Measured here: handing out an empty task takes {task:.1f} ms, writing a block {write}.
For the last row above the estimate is therefore:

{guess}

With many workers, make the blocks larger (`block=` of `Study.run`). Not in the estimate: the network, and the time
until a scheduler has a thousand workers.

---

Made by `./scripts/study scaling --publish` on {date}. {system} {machine}, {cores} processors, load {load:.1f} at the
start, Python {python}.
"""
