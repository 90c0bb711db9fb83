"""The results of a study: one Zarr group (format 3) in a folder or behind a URL that fsspec knows.

Wheels are run and written chunk by chunk, the status of a chunk last, each file as one that is renamed when complete: a
chunk whose status is not there has not been run, whatever else of it is there. That is all it takes to go on after a
kill. The caller makes the group and leaves its mark; a worker that finds the mark there writes its chunks itself.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from itertools import product
from math import prod
from pathlib import Path

import numpy as np
import zarr
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray

from .instance import Status, counters_of
from .labels import label
from .measures import StudyError
from .plan import POINT, Study
from .runs import Job

Chunk = tuple[slice, ...]
TITLE = "A study with wheel.fmu"
MARK = "caller"  # the attribute by which a worker knows that it sees the caller's store
OWN = {
    "status": ("fate", "What became of the wheel"),
    "message": ("message", "What the FMU said"),
    "end_time": ("end of the run", "Time at which the run ended"),
    "wall_time": ("computing time", "Time that the run took"),
    "fmu_time": ("time in the FMU", "Time of wall_time spent in calls of the FMU"),
}


def chunk_shape(shape: Mapping[str, int], size: int, first: tuple[str, ...]) -> tuple[int, ...]:
    """Lengths of a chunk of at most `size` points: whole along the dimensions `first`, then along the last ones."""
    lengths = dict.fromkeys(shape, 1)
    for name in [*first, *reversed([n for n in shape if n not in first])]:
        lengths[name] = max(1, min(shape[name], size // prod(lengths.values())))
    return tuple(lengths.values())


@dataclass
class Store:
    """The Zarr group of one study, at a path or a URL."""

    place: str
    group: zarr.Group
    arrays: dict[str, zarr.Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.arrays = dict(self.group.arrays())

    @classmethod
    def open(cls, place: str, fingerprint: str, overwrite: bool) -> Store | None:
        """The kept results of this study; None if there are none or they are to be overwritten; else StudyError."""
        try:
            group = zarr.open_group(place, mode="r+")
        except (FileNotFoundError, ValueError):  # zarr's own error for a missing group is both
            if "://" in place or not Path(place).exists():
                return None
            raise StudyError(f"{place} exists and is no Zarr group; name another place by --out.") from None
        if overwrite or (group.attrs.get("title") == TITLE and "fingerprint" not in group.attrs):
            return None  # without its fingerprint: killed while it was made
        if group.attrs.get("fingerprint") != fingerprint:
            raise StudyError(
                f"{place} holds the results of another study or of another wheel.fmu; "
                "name another place by --out, or throw them away by --overwrite."
            )
        return cls(place, group)

    @classmethod
    def marked(cls, place: str, mark: str) -> Store:
        """The group with the caller's mark; an exception of whatever kind if it is not to be seen from here."""
        if cls.mark_at(place) != mark:
            raise FileNotFoundError(f"{place} is not the caller's.")
        return cls(place, zarr.open_group(place, mode="r+"))

    @staticmethod
    def mark_at(place: str) -> str | None:
        """The mark of the caller who works on it."""
        return zarr.open_group(place, mode="r").attrs.get(MARK)

    @classmethod
    def create(
        cls,
        place: str,
        study: Study,
        job: Job,
        description: ModelDescription,
        attributes: Mapping[str, object],
        size: int,
    ) -> Store:
        """A group with all coordinates and no results; what makes it a study's, its fingerprint, comes last."""
        group = zarr.open_group(place, mode="w", attributes={"title": TITLE})
        for name, values in study.axes.items():
            about = _about(description, name)
            _put_coordinate(group, name, name if study.grid else POINT, values, about)
        if job.history:
            _put_coordinate(group, "time", "time", np.array(job.times), {"units": "s", "long_name": "time"})
        chunks = chunk_shape(study.shape, size, tuple(n for n in job.late if n in study.shape))
        for name, (dtype, fill, about, timed) in _columns(job, description).items():
            extra = (len(job.times),) if timed else ()
            group.create_array(
                name,
                shape=(*study.shape.values(), *extra),
                chunks=(*chunks, *extra),
                dtype=dtype,
                fill_value=fill,
                dimension_names=(*study.shape, *(("time",) if timed else ())),
                attributes={k: v for k, v in about.items() if v},
            )
        if not study.grid:
            group.attrs["coordinates"] = " ".join(study.axes)
        group.attrs.update(attributes)
        return cls(place, group)

    def missing(self) -> list[Chunk]:
        """The chunks that have not been run, in order."""
        status = self.arrays["status"][:]
        return [chunk for chunk in self.chunks() if (status[chunk] == Status.not_computed).any()]

    def chunks(self) -> Iterator[Chunk]:
        """All chunks in order."""
        array = self.arrays["status"]
        starts = (range(0, n, step) for n, step in zip(array.shape, array.chunks, strict=True))
        for begin in product(*starts):
            ends = (min(b + step, n) for b, step, n in zip(begin, array.chunks, array.shape, strict=True))
            yield tuple(slice(b, e) for b, e in zip(begin, ends, strict=True))

    def has(self, chunk: Chunk) -> bool:
        """Whether the chunk has been run."""
        return bool((self.arrays["status"][chunk] != Status.not_computed).all())

    def write(self, chunk: Chunk, result: Mapping[str, NDArray], counters: list[str]) -> None:
        """All columns of a chunk side by side, then the status."""
        lengths = tuple(part.stop - part.start for part in chunk)
        columns = {name: values for name, values in result.items() if name not in ("status", "counters")}
        columns |= {name: result["counters"][:, k] for k, name in enumerate(counters)}

        def put(name: str, values: NDArray) -> None:
            kept = np.asarray(values.astype("T") if name == "message" else values)
            self.arrays[name][chunk] = kept.reshape(*lengths, *kept.shape[1:])

        with ThreadPoolExecutor(len(columns)) as pool:  # a remote store takes its time for each
            list(pool.map(put, columns, columns.values()))
        put("status", result["status"])


def _put_coordinate(group: zarr.Group, name: str, dimension: str, values: NDArray, about: Mapping[str, str]) -> None:
    shape = {"shape": values.shape, "dtype": values.dtype, "dimension_names": (dimension,)}
    group.create_array(name, **shape, attributes={k: v for k, v in about.items() if v})[:] = values


def _about(description: ModelDescription, name: str) -> dict[str, str]:
    variable = next(v for v in description.modelVariables if v.name == name)
    return {"units": variable.unit or "", "long_name": label(name), "description": variable.description}


def _columns(job: Job, description: ModelDescription) -> dict[str, tuple]:
    """Name of each result -> type, value where nothing is known, attributes, whether it has a time axis."""
    nan = float("nan")
    codes = [s for s in Status if s != Status.not_computed]
    flags = {"flag_values": [int(s) for s in codes], "flag_meanings": " ".join(s.name for s in codes)}
    about = {name: {"long_name": short, "description": text} for name, (short, text) in OWN.items()}
    columns = {name: ("f8", nan, {"units": "s", **texts}, False) for name, texts in about.items()}
    columns["status"] = ("i1", int(Status.not_computed), flags | about["status"], False)
    columns["message"] = (np.dtypes.StringDType(), "", about["message"], False)
    for name in counters_of(description):
        columns[name] = ("i8", -1, _about(description, name), False)
    for name, measure in job.measures.items():
        read = _about(description, measure.variable)
        texts = {"long_name": label(measure.text), "description": f"{measure.text}: {read['description']}"}
        columns[name] = ("f8", nan, {"units": "s" if measure.is_time else read["units"], **texts}, False)
    for name in job.history:
        columns[name] = ("f8", nan, _about(description, name), True)
    return columns


def study_attributes(study: Study, versions: Mapping[str, str], fmu_sha256: str) -> dict[str, object]:
    """What makes the results repeatable: the study, its seed, the FMU's hash, and versions."""
    spec = study.spec()
    spec.pop("axes")
    repeat = {"fmu_sha256": fmu_sha256, "seed": study.seed, "study": json.dumps(spec), **versions}
    return repeat | {"fingerprint": study.fingerprint(fmu_sha256)}
