"""Shared by the tests of studies: a study, comparing results bit by bit, and work that workers do instead of theirs.

A worker imports this module, with the parts of the package that it gets: it has no checkout."""

import os

import numpy as np
import xarray as xr

from lab.studies import Study
from lab.studies.worker import Result, run_chunk

# 24 wheels of every fate: impossible ones, some that lie flat, one that lifts off, and those that roll on.
FATES = Study(
    grid={"theta_start": np.radians([15, 75, 200]), "s": [0.0, 0.03], "phi_dot_start": [-2, 0.0, -6.0, -40.0]},
    measures={"plane": "lowest", "lowest": "min(theta)", "down": "first(theta < 30deg)", "energy": "E"},
    history=["theta", "X_O"],
    stop_time=5.0,
    interval=0.05,
)


def same(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two results are bit-identical, computing times aside."""
    a, b = (one.drop_vars(("wall_time", "fmu_time")).load() for one in (a, b))
    return a.equals(b)


def die_at_upright(*task: object) -> Result:
    """As a worker does it, but the process dies where a wheel starts at exactly 1.5 rad."""
    if (task[-1]["theta_start"] == 1.5).any():
        os._exit(1)
    return run_chunk(*task)
