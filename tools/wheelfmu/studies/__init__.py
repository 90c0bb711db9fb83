"""Studies with wheel.fmu: many wheels at once, on all cores or on a Dask cluster, labelled with xarray, kept as Zarr.

    from wheelfmu.studies import Study
    study = Study(grid={"s": [0, 0.01, 0.03]}, measures={"lowest": "lowest"})
    results = study.run("results/lowest.zarr")

docs/studies.md is the guide. `plan` and the command's arguments need Python alone, a worker Dask, fmpy and numpy (and
zarr, to write its results itself), the caller also xarray.
"""

from .plan import Status, Study, StudyError

__all__ = ["Status", "Study", "StudyError"]
