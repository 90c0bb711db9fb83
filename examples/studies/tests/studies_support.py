"""Shared by the tests of studies: comparing results bit by bit."""

import xarray as xr


def same(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two results are bit-identical, computing times aside."""
    a, b = (one.drop_vars(("wall_time", "fmu_time")).load() for one in (a, b))
    return a.equals(b)
