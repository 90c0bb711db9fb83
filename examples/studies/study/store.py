"""The results of a study on disk: one Zarr group (format 3), one chunk per block, readable at any time by xarray.

The status of a block is written last, each chunk as a file that is renamed when complete: a block whose status is not
there has not been run, whatever else of it is there. That is all it takes to go on after a kill.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from math import prod
from pathlib import Path

import numpy as np
import xarray as xr
import zarr
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray

from .instance import Status, counters_of
from .plan import POINT, Study, StudyError
from .runs import Job

Block = tuple[slice, ...]
MEANING = {
    "status": "What became of the wheel",
    "message": "What the FMU said",
    "end_time": "Time at which the run ended",
    "wall_time": "Time that the run took",
    "fmu_time": "Time of wall_time spent in calls of the FMU",
}


def chunk_shape(shape: Mapping[str, int], size: int, first: tuple[str, ...]) -> tuple[int, ...]:
    """Lengths of a block of at most `size` points: whole along the dimensions `first`, then along the last ones."""
    lengths = dict.fromkeys(shape, 1)
    for name in [*first, *reversed([n for n in shape if n not in first])]:
        lengths[name] = max(1, min(shape[name], size // prod(lengths.values())))
    return tuple(lengths.values())


@dataclass
class Store:
    """The Zarr group of one study."""

    path: Path
    group: zarr.Group

    @classmethod
    def open(cls, path: Path, fingerprint: str) -> Store | None:
        """The kept results of this very study, or None if there are none; StudyError if something else is there."""
        if not path.exists():
            return None
        try:
            group = zarr.open_group(path, mode="r+")
        except (zarr.errors.GroupNotFoundError, FileNotFoundError, ValueError):
            raise StudyError(f"{path} exists and is no Zarr group; choose another place for the results.") from None
        if group.attrs.get("fingerprint") != fingerprint:
            raise StudyError(
                f"{path} holds the results of another study or of another wheel.fmu; "
                "choose another place, or overwrite them."
            )
        return cls(path, group)

    @classmethod
    def create(
        cls,
        path: Path,
        study: Study,
        job: Job,
        description: ModelDescription,
        attributes: Mapping[str, object],
        size: int,
    ) -> Store:
        """An empty group with all coordinates; it gets its name when it is complete."""
        begun = path.with_name(path.name + ".new")
        shutil.rmtree(begun, ignore_errors=True)
        path.parent.mkdir(parents=True, exist_ok=True)
        group = zarr.open_group(begun, mode="w", attributes=dict(attributes))
        units = {v.name: v.unit for v in description.modelVariables if v.unit}
        meaning = {v.name: v.description for v in description.modelVariables}
        for name, values in study.axes.items():
            dimension = name if study.grid else POINT
            _put_coordinate(group, name, dimension, values, units.get(name, ""), meaning[name])
        if not study.grid:
            group.attrs["coordinates"] = " ".join(study.axes)
        if job.history:
            _put_coordinate(group, "time", "time", np.array(job.times), "s", "Time")
        chunks = chunk_shape(study.shape, size, tuple(n for n in job.late if n in study.shape))
        for name, (dtype, fill, attributes_of, timed) in _columns(job, description, units, meaning).items():
            extra = ("time",) if timed else ()
            group.create_array(
                name,
                shape=(*study.shape.values(), *(len(job.times) for _ in extra)),
                chunks=(*chunks, *(len(job.times) for _ in extra)),
                dtype=dtype,
                fill_value=fill,
                dimension_names=(*study.shape, *extra),
                attributes={k: v for k, v in attributes_of.items() if v},
            )
        begun.rename(path)
        return cls(path, zarr.open_group(path, mode="r+"))

    def missing(self) -> list[Block]:
        """The blocks that have not been run, in order."""
        status = self.group["status"][:]
        return [b for b in self.blocks() if (status[b] == Status.not_computed).any()]

    def blocks(self) -> Iterator[Block]:
        """All blocks in order."""
        array = self.group["status"]
        starts = (range(0, n, step) for n, step in zip(array.shape, array.chunks, strict=True))
        for begin in product(*starts):
            ends = (min(b + step, n) for b, step, n in zip(begin, array.chunks, array.shape, strict=True))
            yield tuple(slice(b, e) for b, e in zip(begin, ends, strict=True))

    def points(self, study: Study, block: Block) -> dict[str, NDArray[np.float64]]:
        """The values of the block's points, one column per axis."""
        if not study.grid:
            return {name: values[block[0]] for name, values in study.axes.items()}
        parts = [values[part] for values, part in zip(study.axes.values(), block, strict=True)]
        return dict(zip(study.axes, (m.ravel() for m in np.meshgrid(*parts, indexing="ij")), strict=True))

    def write(self, block: Block, result: Mapping[str, NDArray], counters: list[str]) -> None:
        """All columns of a block, the status last."""
        lengths = tuple(part.stop - part.start for part in block)
        columns = {name: values for name, values in result.items() if name not in ("status", "counters")}
        columns |= {name: result["counters"][:, k] for k, name in enumerate(counters)}
        for name, values in [*columns.items(), ("status", result["status"])]:
            array = self.group[name]
            kept = np.asarray(values.astype("T") if name == "message" else values)
            array[block] = kept.reshape(*lengths, *kept.shape[1:])

    def dataset(self) -> xr.Dataset:
        """The results, read when asked for."""
        return open_results(self.path)


def open_results(path: Path | str) -> xr.Dataset:
    """The results of a study, labelled; read when asked for."""
    results = xr.open_zarr(path, consolidated=False, chunks=None)
    first = ["status", "message", "end_time"]
    return results[[*first, *sorted(set(results.data_vars) - set(first))]]


def export(results: xr.Dataset, path: Path) -> Path:
    """Writes a copy beside the Zarr folder, as NetCDF (.nc) or as a table with one row per wheel (.csv)."""
    if path.suffix == ".nc":
        packed = {n: {"zlib": True} for n in results.data_vars if results[n].dtype.kind in "fiu"}
        results.drop_encoding().to_netcdf(path, encoding=packed)
    else:
        rows = results.to_dataframe().reset_index()
        rows["status"] = [Status(code).name for code in rows["status"]]
        rows.to_csv(path, index=False)
    return path


def _put_coordinate(group: zarr.Group, name: str, dimension: str, values: NDArray, unit: str, meaning: str) -> None:
    array = group.create_array(
        name,
        shape=values.shape,
        dtype=values.dtype,
        dimension_names=(dimension,),
        attributes={"units": unit, "long_name": meaning},
    )
    array[:] = values


def _columns(job: Job, description: ModelDescription, units: Mapping[str, str], meaning: Mapping[str, str]) -> dict:
    """Name of each result -> type, value where nothing is known, attributes, whether it has a time axis."""
    nan = float("nan")
    codes = [s for s in Status if s != Status.not_computed]
    flags = {"flag_values": [int(s) for s in codes], "flag_meanings": " ".join(s.name for s in codes)}
    columns = {name: ("f8", nan, {"units": "s", "long_name": text}, False) for name, text in MEANING.items()}
    columns["status"] = ("i1", int(Status.not_computed), flags | {"long_name": MEANING["status"]}, False)
    columns["message"] = (np.dtypes.StringDType(), "", {"long_name": MEANING["message"]}, False)
    for name in counters_of(description):
        columns[name] = ("i8", -1, {"long_name": meaning[name]}, False)
    for name, measure in job.measures.items():
        unit = "s" if measure.is_time else units.get(measure.variable, "")
        columns[name] = ("f8", nan, {"units": unit, "long_name": measure.text}, False)
    for name in job.history:
        columns[name] = ("f8", nan, {"units": units.get(name, ""), "long_name": meaning[name]}, True)
    return columns


def study_attributes(study: Study, versions: Mapping[str, str], fmu_sha256: str) -> dict[str, object]:
    """What makes the results repeatable: the study, its seed, the FMU's hash, and versions."""
    spec = study.spec()
    spec.pop("axes")
    return {
        "title": "A study with wheel.fmu",
        "fingerprint": study.fingerprint(fmu_sha256),
        "fmu_sha256": fmu_sha256,
        "seed": study.seed,
        "study": json.dumps(spec),
        **versions,
    }
