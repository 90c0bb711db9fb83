"""Shared by the tests of studies: a study, and comparing results bit by bit."""

import numpy as np
import xarray as xr

from wheelfmu.studies import Study

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
