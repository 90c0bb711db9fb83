"""The dataset of a study before any wheel has run: its dimensions, chunks, units and labels."""

from __future__ import annotations

import json
import platform
import re
from importlib.metadata import version

import dask.array as da
import numpy as np
import xarray as xr
from fmpy.model_description import ModelDescription, ScalarVariable

from .instance import Status, can_change, counters_of
from .measures import PLANE_ANGLE, Measure
from .plan import POINT, Study
from .store import TITLE

GREEK = {"psi": "ψ", "theta": "θ", "phi": "φ", "omega": "ω", "lambda": "λ", "mu": "μ", "tau": "τ"}
DOTS = {"_ddot": "\N{COMBINING DIAERESIS}", "_dot": "\N{COMBINING DOT ABOVE}"}
LOWEST, ANGLE = "smallest angle to the ground", "angle to the ground"
MEANING = {
    "last": "at the end of the run",
    "min": "smallest value at the communication points and the end of the run",
    "max": "largest value at the communication points and the end of the run",
    "mean": "mean over time",
}
PLANE = "Angle of the wheel's plane to the ground, from 0 to 90 deg on either side: 90 deg - |theta - 90 deg|"
OWN = {  # results of every study: empty value, type, unit, label, description
    "status": (int(Status.not_computed), "i1", "", "fate", "Fate of the wheel"),
    "message": ("", np.dtypes.StringDType(), "", "message", "Messages of the FMU"),
    "end_time": (np.nan, "f8", "s", "end of the run", "Time at which the run ended"),
    "wall_time": (np.nan, "f8", "s", "computing time", "Computing time of the run"),
    "fmu_time": (np.nan, "f8", "s", "time in the FMU", "Part of wall_time spent in calls of the FMU"),
}


def template(study: Study, description: ModelDescription, size: int, attributes: dict[str, object]) -> xr.Dataset:
    """All coordinates, and columns that hold nothing yet, in chunks of at most `size` wheels."""
    variables = {v.name: v for v in description.modelVariables}
    # Wheels that share a start stay in one chunk.
    late = [n for n in study.shape if study.branch_at is not None and study.grid and can_change(description, n)]
    shared = np.prod([study.shape[n] for n in late], dtype=int) <= size
    whole = [-1 if n in late and shared else "auto" for n in study.shape]
    chunks = da.core.normalize_chunks(whole, tuple(study.shape.values()), limit=size, dtype="i1")

    def about(name: str) -> dict[str, str]:
        return texts(variables[name].unit, label(name), variables[name].description)

    def column(fill: object, dtype: object, attributes: dict[str, object], timed: bool = False) -> xr.Variable:
        lengths = (*study.shape.values(), *[len(study.times)] * timed)
        nothing = da.full(lengths, fill, dtype=dtype, chunks=(*chunks, *[-1] * timed))
        return xr.Variable((*study.shape, *["time"] * timed), nothing, attributes, {"fill_value": fill})

    columns = {name: column(fill, dtype, texts(*about)) for name, (fill, dtype, *about) in OWN.items()}
    fates = [status for status in Status if status != Status.not_computed]
    columns["status"].attrs |= {"flag_values": [*map(int, fates)], "flag_meanings": " ".join(s.name for s in fates)}
    columns |= {name: column(-1, "i8", about(name)) for name in counters_of(description)}
    columns |= {name: column(np.nan, "f8", measured(m, variables[m.variable])) for name, m in study.parsed.items()}
    columns |= {name: column(np.nan, "f8", about(name), timed=True) for name in study.history}
    coordinates = {n: (n if study.grid else POINT, axis, about(n)) for n, axis in study.axes.items()}
    if study.history:
        coordinates["time"] = ("time", study.times, {"units": "s", "long_name": "time"})
    return xr.Dataset(columns, coordinates, {"title": TITLE, **attributes})


def texts(unit: str | None, name: str, description: str | None) -> dict[str, str]:
    """The attributes of a variable that are not empty."""
    return {k: v for k, v in (("units", unit), ("long_name", name), ("description", description)) if v}


def measured(measure: Measure, variable: ScalarVariable) -> dict[str, str]:
    """Unit, label and description of a measure of that variable."""
    quantity = PLANE if measure.quantity == PLANE_ANGLE else variable.description
    meaning = MEANING.get(measure.kind) or f"first time {'below' if measure.kind == '<' else 'above'} {measure.limit:g}"
    return texts("s" if measure.is_time else variable.unit, label(measure.text), f"{quantity}; {meaning}")


def label(text: str) -> str:
    """The short label of a variable, or of a measure of variables, for axes and legends: `θ at the start`."""
    if text.strip() in ("lowest", f"min({PLANE_ANGLE})"):
        return LOWEST
    return re.sub(r"[A-Za-z]\w*", lambda found: _symbol(found[0]), text)


def _symbol(name: str) -> str:
    if name == PLANE_ANGLE:
        return ANGLE
    name, start = re.subn(r"_start$", "", name)
    first, dot, rest = re.fullmatch(r"([A-Za-z]+)((?:_d?dot)?)(\w*)", name).groups()
    return GREEK.get(first, first) + DOTS.get(dot, "") + rest + (" at the start" if start else "")


def provenance(study: Study, description: ModelDescription, fmu_sha256: str) -> dict[str, object]:
    """All that is needed to repeat the study: its definition, its seed, the FMU's hash, and versions."""
    spec = study.spec()
    spec.pop("axes")
    versions = {f"{name}_version": version(name) for name in ("fmpy", "numpy", "dask", "xarray", "zarr")}
    versions |= {"python_version": platform.python_version(), "platform": f"{platform.system()} {platform.machine()}"}
    fmu = {"fmu_sha256": fmu_sha256, "fmu_guid": description.guid, "fmu_version": description.version or ""}
    return fmu | {"seed": study.seed, "study": json.dumps(spec)} | versions
