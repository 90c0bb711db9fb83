"""Studies with wheel.fmu: many wheels at once, on all cores or on a Dask cluster, labelled with xarray, kept as Zarr.

    from study import Study
    study = Study(grid={"s": [0, 0.01, 0.03]}, measures={"lowest": "lowest"})
    results = study.run("results/lowest.zarr")

docs/studies.md is the guide. Nothing is loaded before it is used: `plan` and the command's arguments need Python alone,
a worker fmpy and numpy (and zarr, to write its results itself), the caller also Dask and xarray.
"""

import sys
from importlib import import_module
from pathlib import Path

from .plan import Status, Study, StudyError

sys.path.append(str(Path(__file__).resolve().parents[2] / "python"))  # of the values that a user types
__all__ = ["Status", "Study", "StudyError", "curves", "in_degrees"]


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"The package study has no {name}.")
    return getattr(import_module(".dataset", __name__), name)
