"""Studies with wheel.fmu: many wheels at once, on all cores or on a Dask cluster, labelled with xarray, kept as Zarr.

    from study import Study
    study = Study(grid={"s": [0, 0.01, 0.03]}, measures={"lowest": "lowest"})
    results = study.run("results/lowest.zarr")

docs/studies.md is the guide. A worker needs this package, fmpy and numpy; only the caller needs xarray and zarr.
"""

from .instance import Status
from .plan import Study, StudyError

__all__ = ["Status", "Study", "StudyError"]
