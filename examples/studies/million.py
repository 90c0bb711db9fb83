"""A study of 1000 x 1000 wheels: how long it takes, and how much memory and disk.

`./scripts/study million` runs it, in one to three minutes on two cores. `--publish` writes the data of docs/studies.md.
"""

from os import cpu_count
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage
from time import perf_counter

import numpy as np
import pandas as pd
import xarray as xr
from fsspec.core import url_to_fs
from study import Study

BEGIN = perf_counter()
study = Study(
    grid={
        "theta_start": np.radians(np.linspace(10, 89, 1000)),
        "phi_dot_start": -np.linspace(0.5, 12, 1000),  # rad/s
    },
)


def table(results: xr.Dataset) -> pd.DataFrame:
    """Time since the start of the command, the largest memory of the caller and of a worker, disk space."""
    files, place = url_to_fs(results.encoding["source"])
    row = {"wheels": results["status"].size, "seconds": perf_counter() - BEGIN, "workers": cpu_count()}
    for name, processes in (("caller_MB", RUSAGE_SELF), ("worker_MB", RUSAGE_CHILDREN)):
        row[name] = getrusage(processes).ru_maxrss // 1000
    return pd.DataFrame([row | {"disk_MB": files.du(place) // 1_000_000}])
