"""What the tests of studies share: comparing results, and the command as a process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import xarray as xr
from study.runs import Runner

ROOT = Path(__file__).resolve().parents[3]
TIMED = ["wall_time", "fmu_time"]


def same(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two results agree to the bit, times of computing and who computed aside."""
    a, b = (one.drop_vars(TIMED).assign_attrs(caller="", sessions="").load() for one in (a, b))
    return a.identical(b)


def as_one_worker(runner: Runner, study: object, results: xr.Dataset) -> bool:
    """Whether results have the bits that one instance gives, one wheel after the other in this process."""
    grid = np.meshgrid(*study.axes.values(), indexing="ij")
    points = dict(zip(study.axes, (axis.ravel() for axis in grid), strict=True))
    alone = runner.run_block(study.job(runner.instance.description), points)
    counters = dict(zip(runner.instance.counters, alone.pop("counters").T, strict=True))
    shape = results["status"].shape
    return all(
        np.array_equal(results[name].values.reshape(np.shape(values)), values, equal_nan=values.dtype.kind == "f")
        and results[name].shape[: len(shape)] == shape
        for name, values in (alone | counters).items()
        if name not in TIMED
    )


def command(*options: object, **more: object) -> subprocess.Popen:
    """The command behind ./scripts/study, in the Python of the tests."""
    path = os.pathsep.join(str(ROOT / folder) for folder in ("examples/studies", "tools"))
    words = [sys.executable, "-m", "study", *map(str, options)]
    how = {"env": os.environ | {"PYTHONPATH": path}, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(words, **(how | more))
