"""The labelled dataset of a study: empty before any wheel has run, opened, drawn, exported, summarized."""

import json
import math
import platform
import re
from collections.abc import Collection, Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path

import dask.array as da
import numpy as np
import xarray as xr
import zarr
from fmpy.model_description import ModelDescription

from wheelfmu.fmu import outputs

from .plan import OWN, PLANE_ANGLE, POINT, SLIP, Status, Study, counters_of
from .worker import Array, Region

TITLE = "A study with wheel.fmu"
ANGLE = "angle to the ground"
SIZE = ("m", "r_0", "r")
GREEK = {"psi": "ψ", "theta": "θ", "phi": "φ", "omega": "ω", "lambda": "λ", "mu": "μ", "tau": "τ"}
SYMBOLS = {  # in labels, by the text of a measure
    rf"\s*(lowest|min\({PLANE_ANGLE}\))\s*": f"smallest {ANGLE}",
    rf"\b{PLANE_ANGLE}\b": ANGLE,
    rf"^\s*({SLIP}|max\({SLIP}\))\s*$": "largest slip",
    r"^\s*slid\s*$": "time of sliding",
    r"\b(\w+)_start\b": r"initial \1",
    **{rf"\b{name}(?![a-z])": symbol for name, symbol in GREEK.items()},
    r"\b(\w)_ddot": "\\1\N{COMBINING DIAERESIS}",
    r"\b(\w)_dot": "\\1\N{COMBINING DOT ABOVE}",
}
PLANE = "Angle of the wheel's plane to the ground, from 0 to 90 deg on either side: 90 deg - |theta - 90 deg|"

SPEED = "Speed of the slip: of the wheel's material point at the contact over the ground, 0 while it rolls"


def axes_of(study: Study) -> xr.Dataset:
    """The values that vary: each a dimension of a grid, or all along the wheels of a list; and moments that follow."""
    axes = xr.Dataset(coords={name: (name if study.grid else POINT, values) for name, values in study.varied.items()})
    if not study.body:
        return axes
    from wheelfmu.fmu.values import moments

    size = {name: study.values[name] for name in SIZE if name in study.values}
    size |= {name: axes[name] for name in SIZE if name in axes.coords}
    return axes.assign_coords(moments(study.body, **size))


def doubtful(study: Study, axes: xr.Dataset, description: ModelDescription) -> str:
    """One sentence if there are wheels that no body can be, with their number; else nothing."""
    from wheelfmu.fmu.values import MOMENTS, doubt

    names = (*SIZE, *MOMENTS)
    fixed = {v.name: float(v.start) for v in description.modelVariables if v.name in names} | study.values
    columns = [axes.coords[name] if name in axes.coords else xr.DataArray(fixed[name]) for name in names]
    rows = zip(*(column.values.ravel().tolist() for column in xr.broadcast(*columns)), strict=True)
    said = [doubt(dict(zip(names, row, strict=True))) for row in rows]
    wheels, found = math.prod(axes.sizes.values()), [text for text in said if text]
    return f"{len(found) * wheels // len(said)} of {wheels} wheels cannot exist. The first: {found[0]}" if found else ""


def sample(bounds: Mapping[str, tuple[float, float]], count: int, seed: int = 0) -> dict[str, Array]:
    """A list of wheels for a study: a Latin hypercube between the lowest and the highest value of each name."""
    from scipy.stats import qmc  # slow to load

    unit = qmc.LatinHypercube(len(bounds), rng=seed).random(count)
    return dict(zip(bounds, qmc.scale(unit, *zip(*bounds.values(), strict=True)).T, strict=True))


def points(axes: xr.Dataset, region: Region) -> dict[str, Array]:
    """The values of a region of the results, by name: arrays to be broadcast against each other."""
    part = axes.isel(dict(zip(axes.sizes, region, strict=True)))
    return {name: values.variable.set_dims([*axes.sizes]).values for name, values in part.coords.items()}


def template(study: Study, axes: xr.Dataset, description: ModelDescription, size: int) -> xr.Dataset:
    """All coordinates, and columns that hold nothing yet, in chunks of at most `size` wheels."""
    variables = {v.name: v for v in description.modelVariables}
    about = {name: (v.unit, label(name), v.description) for name, v in variables.items()}
    about |= {PLANE_ANGLE: ("rad", ANGLE, PLANE), SLIP: ("m/s", SLIP, SPEED)}
    chunks = da.core.normalize_chunks("auto", tuple(axes.sizes.values()), limit=size, dtype="i1")
    columns = OWN | {name: (-1, "i8", *about[name]) for name in counters_of(variables)}
    for name, measure in study.parsed.items():
        (unit, _, meaning), text = about[measure.quantity], study.measures[name]
        unit = "s" if measure.kind in ("<", ">", "lasting") else unit
        columns[name] = (np.nan, "f8", unit, label(text), f"{meaning}; {text}")
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
        coordinates["time"] = ("time", study.times, attributes("s", "time", ""))
    return xr.Dataset(results, coordinates)


def attributes(unit: str | None, name: str, description: str | None) -> dict[str, str]:
    """Those that are not empty."""
    return {k: v for k, v in (("units", unit), ("long_name", name), ("description", description)) if v}


def label(text: str) -> str:
    """The short label of a variable, or of a measure of variables, for axes and legends: `initial θ`."""
    for pattern, symbol in SYMBOLS.items():
        text = re.sub(pattern, symbol, text)
    return re.sub(r"\d+\.\d{5,}(?!\d*e)", lambda found: f"{float(found[0]):.4g}", text)


def provenance(study: Study, description: ModelDescription, fmu_sha256: str) -> dict[str, object]:
    """With the axes all that is needed to repeat the study: its definition, the FMU's hash, and versions."""
    definition = {name: value for name, value in asdict(study).items() if name not in ("grid", "list")}
    versions = {f"{name}_version": version(name) for name in ("fmpy", "numpy", "dask", "xarray", "zarr")}
    versions |= {"python_version": platform.python_version(), "platform": f"{platform.system()} {platform.machine()}"}
    fmu = {"fmu_sha256": fmu_sha256, "fmu_guid": description.guid, "fmu_version": description.version or ""}
    return {"title": TITLE, "study": json.dumps(definition), "varied": [*study.varied]} | fmu | versions


def open_results(place: Path | str) -> xr.Dataset:
    """The results of a study, labelled; read when asked for."""
    results = xr.open_zarr(place, consolidated=False, chunks=None)
    return results[[*OWN, *sorted(results.data_vars.keys() - OWN.keys())]]


def study_of(results: xr.Dataset) -> Study:
    """The study whose results these are."""
    columns = {name: results[name].values.tolist() for name in results.attrs["varied"]}
    kind = "list" if POINT in results.sizes else "grid"
    return Study(**json.loads(results.attrs["study"]), **{kind: columns})


def in_degrees(results: xr.Dataset) -> xr.Dataset:
    """A copy for plots: angles in degrees, coordinates too; rates stay in rad/s."""
    turned = results.copy()
    for name, values in results.variables.items():
        if values.attrs.get("units") == "rad":
            turned[name] = np.degrees(results[name]).assign_attrs(values.attrs | {"units": "deg"})
    return turned


def curves(values: xr.DataArray, x: str, hue: str) -> list:
    """Draws a line for each value of hue, values over x, with the legend beside the axes, where no line runs."""
    lines = values.plot.line(x=x, hue=hue)
    legend = lines[0].axes.get_legend()
    legend.set(loc="center left", bbox_to_anchor=(1.0, 0.5), frame_on=False)
    for text in legend.texts:
        text.set_text(f"{float(text.get_text()):g}")
    return lines


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
    with outputs.fresh(path) as new:
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
