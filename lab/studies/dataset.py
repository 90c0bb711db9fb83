"""The labelled dataset of a study: empty before any wheel has run, opened, exported, summarized."""

import json
import platform
from collections.abc import Collection, Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree

import dask.array as da
import numpy as np
import xarray as xr
import zarr

from wheelfmu.fmu import files
from wheelfmu.fmu.values import Variable

from .names import QUANTITIES, counters_of, description
from .plan import OWN, POINT, Status, Study
from .worker import Array

TITLE = "A study with wheel.fmu"
Region = tuple[slice, ...]  # of the results: the wheels of a chunk, in the order of the dimensions


def axes_of(study: Study) -> xr.Dataset:
    """The values that vary: each a dimension of a grid, or all along the wheels of a list."""
    return xr.Dataset(coords={name: (name if study.grid else POINT, values) for name, values in study.varied.items()})


def points(axes: xr.Dataset, region: Region = ()) -> dict[str, Array]:
    """The values of a region of the results, all if none is given, by name: to be broadcast against each other."""
    part = axes.isel(dict(zip(axes.sizes, region, strict=False)))
    return {name: x.variable.set_dims([*axes.sizes]).values for name, x in part.coords.items()}


def template(study: Study, axes: xr.Dataset, variables: Mapping[str, Variable], size: int) -> xr.Dataset:
    """All coordinates, and columns that hold nothing yet, in chunks of at most `size` wheels."""
    about = {name: (v.unit, v.description) for name, v in {**variables, **QUANTITIES}.items()}
    chunks = da.core.normalize_chunks("auto", tuple(axes.sizes.values()), limit=size, dtype="i1")
    columns = OWN | {name: (-1, "i8", *about[name]) for name in counters_of(variables)}
    for name, measure in study.parsed.items():
        unit, meaning = about[measure.quantity]
        unit = "s" if measure.kind in ("<", ">", "lasting") else unit
        columns[name] = (np.nan, "f8", unit, f"{meaning}; {study.measures[name]}")
    columns |= {name: (np.nan, "f8", *about[name]) for name in study.history}
    results = {}
    for name, (nothing, dtype, *texts) in columns.items():
        sizes = {**axes.sizes, **({"time": len(study.times)} if name in study.history else {})}
        empty = da.full(tuple(sizes.values()), nothing, dtype=dtype, chunks=(*chunks, -1)[: len(sizes)])
        results[name] = xr.Variable([*sizes], empty, attributes(*texts), {"fill_value": nothing})
    fates = [status for status in Status if status != Status.not_computed]
    results["status"].attrs |= {"flag_values": [*map(int, fates)], "flag_meanings": " ".join(s.name for s in fates)}
    coordinates = {name: values.assign_attrs(attributes(*about[name])) for name, values in axes.coords.items()}
    if study.history:
        coordinates["time"] = ("time", study.times, attributes("s", ""))
    return xr.Dataset(results, coordinates)


def attributes(unit: str, meaning: str) -> dict[str, str]:
    """Those that are not empty."""
    return {key: text for key, text in (("units", unit), ("description", meaning)) if text}


def provenance(study: Study, fmu: Path) -> dict[str, object]:
    """With the axes all that is needed to repeat the study: its definition, the FMU's hash, and versions."""
    definition = {name: value for name, value in asdict(study).items() if name not in ("grid", "list")}
    about = ElementTree.fromstring(description(fmu))
    versions = {f"{name}_version": version(name) for name in ("fmpy", "numpy", "dask", "xarray", "zarr")}
    versions |= {"python_version": platform.python_version(), "platform": f"{platform.system()} {platform.machine()}"}
    versions |= {"fmu_guid": about.get("guid", ""), "fmu_version": about.get("version", "")}
    return {"title": TITLE, "study": json.dumps(definition), "varied": [*study.varied]} | versions


def open_results(place: Path | str) -> xr.Dataset:
    """The results of a study, labelled; read when asked for."""
    results = xr.open_zarr(place, consolidated=False, chunks=None)
    return results[[*OWN, *sorted(results.data_vars.keys() - OWN.keys())]]


def study_of(results: xr.Dataset) -> Study:
    """The study whose results these are."""
    columns = {name: results[name].values.tolist() for name in results.attrs["varied"]}
    varied = {"list" if POINT in results.sizes else "grid": columns}
    return Study(**json.loads(results.attrs["study"]) | varied)


def in_degrees(results: xr.Dataset) -> xr.Dataset:
    """A copy for plots: angles in degrees, coordinates too; rates stay in rad/s."""
    turned = results.copy()
    for name, values in results.variables.items():
        if values.attrs.get("units") == "rad":
            turned[name] = np.degrees(results[name]).assign_attrs(values.attrs | {"units": "deg"})
    return turned


def exported(place: str, more: Collection[str] = ()) -> set[str]:
    """The names of the files that were written beside these results, with those that will be."""
    try:
        group = zarr.open_group(place, mode="r+" if more else "r")
    except (OSError, ValueError):  # nothing is there, or nothing of zarr's
        return set()
    names = {*group.attrs.get("exports", ()), *more}
    if more:
        group.attrs["exports"] = sorted(names)
    return names


def export(results: xr.Dataset, path: Path) -> Path:
    """Writes a copy as NetCDF (.nc), or as a table (.csv) with one row per wheel (and time)."""
    with files.fresh(path) as new:
        if path.suffix == ".nc":
            packed = {n: {"zlib": True} for n in results.data_vars if results[n].dtype.kind in "fiu"}
            results.drop_encoding().to_netcdf(new, encoding=packed)
        else:
            rows = results.to_dataframe().reset_index()
            rows.assign(status=[Status(code).name for code in rows["status"]]).to_csv(new, index=False)
    return path


def summarize(results: xr.Dataset, seconds: float) -> str:
    """Counts per status, the first message of those that were not run, and speed.

    seconds: of this call, with the start of workers and writing. The speed is that of the runs themselves.
    """
    status = results["status"].values
    lines = [f"{status.size} wheels; this call took {seconds:.1f} s:"]
    for code, found in zip(*np.unique(status, return_counts=True), strict=True):
        lines.append(f"  {found:8d} {Status(code).name.replace('_', ' ')}")
        if code in (Status.refused, Status.failed):
            lines.append(f"           first: {results['message'].values[status == code][0]}")
    speed, share = 1 / results["wall_time"].mean(), 100 * results["fmu_time"].sum() / results["wall_time"].sum()
    lines.append(f"{speed:.0f} wheels per second and worker, {share:.0f} % of the time inside the FMU.")
    return "\n".join(lines)
