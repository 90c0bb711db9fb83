"""Studies with wheel.fmu: many wheels at once, on all cores or on a Dask cluster, labelled with xarray, kept as Zarr.

    from lab.studies import Study
    study = Study(grid={"s": [0, 0.01, 0.03]}, measures={"lowest": "lowest"})
    results = study.run("results/lowest.zarr")

README.md is the guide. `plan` and the command's arguments need Python alone, a worker Dask, fmpy and numpy.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from wheelfmu.fmu.values import Fault as StudyError

from . import plan
from .plan import Status

if TYPE_CHECKING:
    import xarray

__all__ = ["Status", "Study", "StudyError"]


class Study(plan.Study):
    """A study that a program runs."""

    def run(self, out: str | Path, **how: Any) -> xarray.Dataset:
        """Runs the wheels that are missing in `out` (a Zarr folder or its URL) and returns the results.

        overwrite=True discards results of another study that are there; compute.run lists all options.
        """
        from .compute import run  # not for a worker, and slow to load

        return run(self, out, **how)
