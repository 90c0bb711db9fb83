"""The results of a study for the caller: a labelled dataset, copies in other formats, a summary."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.lines import Line2D

from .instance import Status


def open_results(place: Path | str) -> xr.Dataset:
    """The results of a study, labelled; read when asked for."""
    results = xr.open_zarr(place, consolidated=False, chunks=None)
    first = ["status", "message", "end_time"]
    return results[[*first, *sorted(set(results.data_vars) - set(first))]]


def in_degrees(results: xr.Dataset) -> xr.Dataset:
    """A copy for plots: angles in degrees, coordinates too; rates stay in rad/s."""
    turned = results.copy()
    for name, values in results.variables.items():
        if values.attrs.get("units") == "rad":
            turned[name] = np.degrees(results[name]).assign_attrs(values.attrs | {"units": "deg"})
    return turned


def curves(values: xr.DataArray, x: str, hue: str) -> list[Line2D]:
    """Draws values over x, one line for each value of hue, with the legend beside the axes, where no line runs."""
    lines = values.plot.line(x=x, hue=hue, add_legend=False)
    about = values[hue].attrs
    title = about["long_name"] + (f" [{about['units']}]" if "units" in about else "")
    names = [f"{value:g}" for value in values[hue].values]
    lines[0].axes.legend(lines, names, title=title, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return lines


def export(results: xr.Dataset | pd.DataFrame, path: Path) -> Path:
    """Writes a copy as NetCDF (.nc), or as a table (.csv) with one row per wheel (and time)."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".nc":
        packed = {n: {"zlib": True} for n in results.data_vars if results[n].dtype.kind in "fiu"}
        results.drop_encoding().to_netcdf(path, encoding=packed)
    elif isinstance(results, pd.DataFrame):
        results.to_csv(path, index=False, float_format="%.6g", lineterminator="\n")
    else:
        rows = results.to_dataframe().reset_index()
        rows["status"] = [Status(code).name for code in rows["status"]]
        rows.to_csv(path, index=False)
    return path


def summarize(results: xr.Dataset, seconds: float) -> str:
    """Counts per status, the first message of those that were not run, and speed.

    The speed is of the runs themselves, summed over the workers; `seconds` is the time of this call, workers' start and
    writing included, which may have run only a part of the study.
    """
    status = results["status"].values
    lines = [f"{status.size} wheels in {seconds:.1f} s:"]
    for code, found in zip(*np.unique(status, return_counts=True), strict=True):
        lines.append(f"  {found:8d} {Status(code).name.replace('_', ' ')}")
        if code in (Status.refused, Status.failed):
            lines.append(f"           first: {results['message'].values[status == code][0]}")
    wall, inside = results["wall_time"].values, float(results["fmu_time"].sum())
    if (total := np.nansum(wall)) > 0:
        speed, share = np.isfinite(wall).sum() / total, 100 * inside / total
        lines.append(f"{speed:.0f} wheels per second and worker, {share:.0f} % of the time inside the FMU.")
    return "\n".join(lines)
