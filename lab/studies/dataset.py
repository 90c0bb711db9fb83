"""The labelled dataset of a study: empty before any wheel has run, opened, drawn, exported, summarized."""

import json
import platform
import re
from collections.abc import Collection, Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from xml.etree import ElementTree

import dask.array as da
import numpy as np
import xarray as xr
import zarr

from wheelfmu.fmu import outputs
from wheelfmu.fmu.values import Variable, moments

from .plan import OWN, PLANE, POINT, QUANTITIES, SIZE, SLIP, Status, Study, counters_of, description
from .worker import Array, Region

TITLE = "A study with wheel.fmu"
ANGLE = "angle to the ground"
GREEK = {"psi": "ψ", "theta": "θ", "phi": "φ", "omega": "ω", "lambda": "λ", "mu": "μ", "tau": "τ"}
SYMBOLS = {  # in labels, by the text of a measure
    rf"\s*(lowest|min\({PLANE}\))\s*": f"smallest {ANGLE}",
    rf"\b{PLANE}\b": ANGLE,
    rf"^\s*({SLIP}|max\({SLIP}\))\s*$": "largest slip",
    r"^\s*slid\s*$": "time of sliding",
    r"\b(\w+)_start\b": r"initial \1",
    **{rf"\b{name}(?![a-z])": symbol for name, symbol in GREEK.items()},
    r"\b(\w)_ddot": "\\1\N{COMBINING DIAERESIS}",
    r"\b(\w)_dot": "\\1\N{COMBINING DOT ABOVE}",
}


def axes_of(study: Study) -> xr.Dataset:
    """The values that vary: each a dimension of a grid, or all along the wheels of a list; and moments that follow."""
    axes = xr.Dataset(coords={name: (name if study.grid else POINT, values) for name, values in study.varied.items()})
    if not study.body:
        return axes
    size = {name: x for name, x in {**study.values, **axes.coords}.items() if name in SIZE}
    return axes.assign_coords(moments(study.body, **size))


def sample(bounds: Mapping[str, tuple[float, float]], count: int, seed: int = 0) -> dict[str, Array]:
    """A list of wheels for a study: a Latin hypercube between the lowest and the highest value of each name."""
    from scipy.stats import qmc  # slow to load

    unit = qmc.LatinHypercube(len(bounds), rng=seed).random(count)
    return dict(zip(bounds, qmc.scale(unit, *zip(*bounds.values(), strict=True)).T, strict=True))


def points(axes: xr.Dataset, region: Region) -> dict[str, Array]:
    """The values of a region of the results, by name: arrays to be broadcast against each other."""
    return {name: x.variable.set_dims([*axes.sizes]).values for name, x in axes.isel(region).coords.items()}


def template(study: Study, axes: xr.Dataset, variables: Mapping[str, Variable], size: int) -> xr.Dataset:
    """All coordinates, and columns that hold nothing yet, in chunks of at most `size` wheels."""
    about = {name: (v.unit, label(name), v.description) for name, v in {**variables, **QUANTITIES}.items()}
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


def attributes(unit: str, name: str, meaning: str) -> dict[str, str]:
    """Those that are not empty."""
    return {k: v for k, v in (("units", unit), ("long_name", name), ("description", meaning)) if v}


def label(text: str) -> str:
    """The short label of a variable, or of a measure of variables, for axes and legends: `initial θ`."""
    for pattern, symbol in SYMBOLS.items():
        text = re.sub(pattern, symbol, text)
    return re.sub(r"\d+\.\d{5,}(?!\d*e)", lambda found: f"{float(found[0]):.4g}", text)


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
