"""A worker's side: the FMU unpacked once, one instance, and tasks of some chunks of points that come from the caller.

The caller uploads one zip file with this package, wheel.fmu and the compiled march.c. Dask hands it to workers that
join later too, before they get any task. A worker loads zarr only to write its results itself; where it cannot see the
caller's store, they go back to the caller.
"""

from __future__ import annotations

import subprocess
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from threading import Lock
from time import perf_counter
from typing import NamedTuple

import numpy as np
from distributed import get_worker
from numpy.typing import NDArray

from .instance import MARCH
from .measures import StudyError
from .runs import Job, Runner

Points = Mapping[str, NDArray[np.float64]]
Result = dict[str, NDArray]
FMU = "wheel.fmu"  # its name inside the uploaded file
_runners: dict[str, Runner] = {}  # by the name of the uploaded file; one process works for one worker
_stores: dict[tuple[str, str], object] = {}  # by place and mark
_turn = Lock()  # a worker's threads take turns at the instance


class Errand(NamedTuple):
    """What is the same for all tasks of a study: the uploaded file, and where the store is, if workers may write."""

    upload: str
    job: Job
    place: str
    mark: str


class Part(NamedTuple):
    """A chunk of the store, and the values of its axes: of a grid they are combined, else they are columns."""

    chunk: tuple[slice, ...]
    axes: Points
    grid: bool

    @property
    def points(self) -> Points:
        if not self.grid:
            return self.axes
        columns = (axis.ravel() for axis in np.meshgrid(*self.axes.values(), indexing="ij"))
        return dict(zip(self.axes, columns, strict=True))


def run_parts(errand: Errand, parts: Sequence[Part]) -> tuple[list[Result | None], float]:
    """Runs some chunks and writes them; for each None if it is written, else its results. And the seconds per wheel."""
    with _turn:
        runner, store = runner_of(errand.upload), reach(errand.place, errand.mark)
        returned, wheels, begin = [], 0, perf_counter()
        for part in parts:
            if store and store.has(part.chunk):  # by a worker that died before it could tell
                returned.append(None)
                continue
            result = runner.run_block(errand.job, part.points)
            wheels += len(result["status"])
            returned.append(None if store and written(store, part.chunk, result, runner) else result)
        return returned, (perf_counter() - begin) / max(wheels, 1)


def pace(errand: Errand, points: Points, seconds: float) -> float:
    """Seconds per wheel, from the first of these points."""
    with _turn:
        runner, begin = runner_of(errand.upload), perf_counter()
        result = runner.run_block(errand.job, points, enough=lambda: perf_counter() - begin > seconds)
        return float(np.nanmean(result["wall_time"]))


def reach(place: str, mark: str) -> object | None:
    """The caller's store, if this worker sees it; else None, whatever the reason."""
    if not place:
        return None
    try:
        from .store import Store

        if (place, mark) not in _stores:
            _stores[place, mark] = Store.marked(place, mark)
        elif Store.mark_at(place) != mark:  # thrown away meanwhile
            return None
        return _stores[place, mark]
    except Exception:  # noqa: BLE001 - no zarr, no such folder, no permission, no network: the caller writes
        return None


def written(store: object, chunk: tuple[slice, ...], result: Result, runner: Runner) -> bool:
    """Whether the chunk could be written from here; if not, the caller tries, and says why it cannot."""
    try:
        store.write(chunk, result, runner.instance.counters)
    except Exception:  # noqa: BLE001
        return False
    return True


def runner_of(upload: str) -> Runner:
    """The instance made of the uploaded file of that name."""
    if upload not in _runners:
        _runners[upload] = Runner(unpack(Path(get_worker().local_directory), upload))
    return _runners[upload]


def unpack(scratch: Path, upload: str) -> str:
    """The folder of the unpacked FMU, inside the worker's own folder, which Dask removes; march.c compiled in it."""
    folder = tempfile.mkdtemp(prefix="wheel-", dir=scratch)
    with zipfile.ZipFile(scratch / upload) as package, zipfile.ZipFile(BytesIO(package.read(FMU))) as archive:
        archive.extractall(folder)
        package.extract(MARCH, folder)
    return folder


def pack(fmu: bytes, path: Path) -> Path:
    """Writes the file to be uploaded: this package's sources, the FMU and the loop over the steps."""
    here = Path(__file__).parent
    with zipfile.ZipFile(path, "w") as package, tempfile.TemporaryDirectory() as folder:
        package.writestr(FMU, fmu)
        package.write(compiled(Path(folder)), MARCH)
        for source in sorted(here.glob("*.py")):
            package.write(source, f"{here.name}/{source.name}")
    return path


def compiled(folder: Path) -> Path:
    """march.c as a library in that folder."""
    library, source = folder / MARCH, Path(__file__).with_name("march.c")
    command = ["cc", "-O2", "-shared", "-fPIC", source, "-o", library]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True)
    except FileNotFoundError:
        raise StudyError("A study needs a C compiler, cc, on the machine that it is started from.") from None
    return library
