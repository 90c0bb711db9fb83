"""Studies with wheel.fmu: many wheels at once, on all cores or on a Dask cluster, labelled with xarray, kept as Zarr.

    from study import Study
    study = Study(grid={"s": [0, 0.01, 0.03]}, measures={"lowest": "lowest"})
    results = study.run("results/lowest.zarr")

docs/studies.md is the guide. Nothing is loaded before it is used: `options` needs Python alone, a worker fmpy and numpy
(and zarr, to write its results itself), the caller also Dask and xarray.
"""

from importlib import import_module

_PLACES = {
    "Status": "instance",
    "Study": "plan",
    "StudyError": "measures",
    "in_degrees": "results",
    "curves": "results",
}
__all__ = ["Status", "Study", "StudyError", "curves", "in_degrees"]


def __getattr__(name: str) -> object:
    if name not in _PLACES:
        raise AttributeError(f"The package study has no {name}.")
    return getattr(import_module(f".{_PLACES[name]}", __name__), name)
