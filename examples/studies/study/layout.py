"""The dataset of a study before any wheel has run: its dimensions, chunks, units and labels."""

from __future__ import annotations

import json
import platform
import re
from importlib.metadata import version

import dask.array as da
import numpy as np
import xarray as xr
from fmpy.model_description import ModelDescription

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
OWN = {
    "message": ("message", "Messages of the FMU"),
    "end_time": ("end of the run", "Time at which the run ended"),
    "wall_time": ("computing time", "Computing time of the run"),
    "fmu_time": ("time in the FMU", "Part of wall_time spent in calls of the FMU"),
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
        v = variables[name]
        return {
            k: text
            for k, text in (("units", v.unit), ("long_name", label(name)), ("description", v.description))
            if text
        }

    def column(fill: object, texts: dict[str, object], dtype: object = "f8", timed: bool = False) -> xr.Variable:
        lengths = (*study.shape.values(), *[len(study.times)] * timed)
        nothing = da.full(lengths, fill, dtype=dtype, chunks=(*chunks, *[-1] * timed))
        return xr.Variable((*study.shape, *["time"] * timed), nothing, texts, {"fill_value": fill})

    codes = [s for s in Status if s != Status.not_computed]
    flags = {"flag_values": [int(s) for s in codes], "flag_meanings": " ".join(s.name for s in codes)}
    texts = {name: {"long_name": short, "description": text} for name, (short, text) in OWN.items()}
    fate = {"long_name": "fate", "description": "Fate of the wheel"}
    columns = {name: column(np.nan, {"units": "s", **texts[name]}) for name in texts if name != "message"}
    columns["message"] = column("", texts["message"], np.dtypes.StringDType())
    columns["status"] = column(int(Status.not_computed), flags | fate, "i1")
    columns |= {name: column(-1, about(name), "i8") for name in counters_of(description)}
    columns |= {name: column(np.nan, measured(m, about(m.variable))) for name, m in study.parsed.items()}
    columns |= {name: column(np.nan, about(name), timed=True) for name in study.history}
    coordinates = {n: (n if study.grid else POINT, axis, about(n)) for n, axis in study.axes.items()}
    if study.history:
        coordinates["time"] = ("time", study.times, {"units": "s", "long_name": "time"})
    return xr.Dataset(columns, coordinates, {"title": TITLE, **attributes})


def measured(measure: Measure, variable: dict[str, str]) -> dict[str, str]:
    """Unit, label and description of a measure, from those of its variable."""
    quantity = PLANE if measure.quantity == PLANE_ANGLE else variable.get("description", "")
    meaning = MEANING.get(measure.kind) or f"first time {'below' if measure.kind == '<' else 'above'} {measure.limit:g}"
    units = {"units": "s"} if measure.is_time else {k: v for k, v in variable.items() if k == "units"}
    return units | {"long_name": label(measure.text), "description": f"{quantity}; {meaning}"}


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
    packages = ("fmpy", "numpy", "dask", "xarray", "zarr")
    return {
        "fmu_sha256": fmu_sha256,
        "fmu_guid": description.guid,
        "fmu_version": description.version or "",
        "seed": study.seed,
        "study": json.dumps(spec),
        "python_version": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
        **{f"{name}_version": version(name) for name in packages},
    }
