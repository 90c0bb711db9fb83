"""Shared by the tests of studies: comparing results bit by bit, and the command as a process."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import xarray as xr
from study import Study
from study.runs import Runner

ROOT = Path(__file__).resolve().parents[3]
TIMED = ("wall_time", "fmu_time")


def single(runner: Runner, study: Study) -> dict[str, np.ndarray]:
    """All wheels of a study by one instance, one after the other in this process, in the order of its results."""
    study.check(runner.instance.description)
    return runner.run_block(study.common(), study.points())


def equal(a: Mapping[str, np.ndarray], b: Mapping[str, np.ndarray]) -> bool:
    """Whether two results of one instance are bit-identical, computing times aside."""
    return all(np.array_equal(a[n], b[n], equal_nan=a[n].dtype.kind == "f") for n in a if n not in TIMED)


def same(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two datasets are bit-identical, computing times and sessions aside."""
    a, b = (one.drop_vars(TIMED).assign_attrs(caller="", sessions="").load() for one in (a, b))
    return a.identical(b)


def as_one_worker(runner: Runner, study: Study, results: xr.Dataset) -> bool:
    """Whether a dataset is bit-identical to the results of one instance."""
    found = single(runner, study)
    shape = tuple(study.shape.values())
    return set(found) == set(results.data_vars) and equal(
        {name: values.reshape(*shape, *values.shape[1:]) for name, values in found.items()},
        {name: results[name].values for name in found},
    )


def command(*options: object, **more: object) -> subprocess.Popen:
    """The command behind ./scripts/study, in the Python of the tests."""
    path = os.pathsep.join(str(ROOT / folder) for folder in ("examples/studies", "tools"))
    words = [sys.executable, "-m", "study", *map(str, options)]
    how = {"env": os.environ | {"PYTHONPATH": path}, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(words, **(how | more))
