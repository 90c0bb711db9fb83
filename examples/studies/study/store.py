"""The results of a study on disk: one Zarr group (format 3) in a folder or behind a URL that fsspec supports.

Wheels are run and written chunk by chunk, the status of a chunk last, each file as one that is renamed when complete: a
chunk that has no status is run again, whatever else of it is there. Nothing more is needed to resume after a kill. The
caller makes the group and leaves its mark; a worker that finds the mark writes its chunks itself.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import zarr
from dask.array.core import normalize_chunks, slices_from_chunks

from .instance import Status
from .measures import StudyError
from .runs import Result

Region = tuple[slice, ...]
TITLE = "A study with wheel.fmu"
MARK = "caller"  # the attribute by which a worker recognizes the caller's store


def kept(place: str, fingerprint: str, overwrite: bool) -> zarr.Group | None:
    """The results of this study that are there; None if there are none or they are to be overwritten; or StudyError."""
    try:
        group = zarr.open_group(place, mode="r+")
    except (FileNotFoundError, ValueError):  # zarr's own error for a missing group is both
        if "://" in place or not Path(place).exists():
            return None
        raise StudyError(f"{place} exists and is not a Zarr group; choose another place (--out).") from None
    if overwrite or (group.attrs.get("title") == TITLE and "fingerprint" not in group.attrs):
        return None  # without its fingerprint: killed while it was made
    if group.attrs.get("fingerprint") != fingerprint:
        raise StudyError(
            f"{place} holds the results of another study or of another wheel.fmu; choose another place (--out), "
            "or discard them (--overwrite, in Python overwrite=True)."
        )
    return group


def missing(group: zarr.Group) -> list[Region]:
    """The chunks that have not been run, in order."""
    status, codes = group["status"], group["status"][:]
    chunks = slices_from_chunks(normalize_chunks(status.chunks, status.shape))
    return [region for region in chunks if (codes[region] == Status.not_computed).any()]


def write(place: str, mark: str, region: Region, result: Result) -> None:
    """The columns of a region side by side, then the status; FileNotFoundError if the caller's mark is not there."""
    group = zarr.open_group(place, mode="r+")
    if group.attrs.get(MARK) != mark:
        raise FileNotFoundError(f"{place} does not have the mark of this caller.")
    shape = [part.stop - part.start for part in region]

    def put(name: str) -> None:
        values = result[name].astype("T") if name == "message" else result[name]
        group[name][region] = values.reshape(*shape, *values.shape[1:])

    columns = [name for name in result if name != "status"]
    with ThreadPoolExecutor(len(columns)) as pool:  # the files of a remote store travel at the same time
        list(pool.map(put, columns))
    put("status")
