"""A study of 1000 x 1000 wheels: how long it takes, and how much memory and disk.

`./scripts/study million` runs it, in one to three minutes on two cores. `--publish` writes the data of
docs/studies.md, one row for each time that it was started and not killed.
"""

import json

import numpy as np
import pandas as pd
import xarray as xr
from study import Study

study = Study(
    grid={
        "theta_start": np.radians(np.linspace(10, 89, 1000)),
        "phi_dot_start": -np.linspace(0.5, 12, 1000),  # rad/s
    },
)


def table(results: xr.Dataset) -> pd.DataFrame:
    """One row for each time that the study was started and not killed."""
    return pd.DataFrame(json.loads(results.attrs["sessions"]))
