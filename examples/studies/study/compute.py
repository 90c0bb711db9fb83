"""Runs a study with Dask: an ordinary LocalCluster, or the cluster behind a scheduler's address.

The caller hands out chunks, some seconds of work at a time. Workers write the results themselves where they see the
store; else the results come back, and the caller writes them.
"""

from __future__ import annotations

import hashlib
import platform
import tempfile
import uuid
from collections import deque
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass
from importlib.metadata import version
from math import prod
from pathlib import Path

import numpy as np
import xarray as xr
from distributed import Client, Future, as_completed
from distributed.scheduler import KilledWorker
from fmpy import read_model_description
from fmpy.model_description import ModelDescription

from .crew import Crew, cluster
from .instance import Status, counters_of
from .measures import StudyError
from .plan import Study
from .results import open_results
from .runs import empty_result
from .session import Session, session
from .store import MARK, Chunk, Store, study_attributes
from .worker import Errand, Part, Result, pace, pack, run_parts

SECONDS = 2.0  # of work in a task, a thousand times what handing it out costs the caller
RATE = 50  # tasks per second that the caller hands out at most: with more than 100 workers tasks are longer
CHUNK = 1.0  # s of work in a chunk, whose writing takes some ms
FEWEST, LARGEST = 16, 2**25  # wheels, and bytes of a history, in a chunk
AHEAD = 2  # tasks per worker on their way
PIECES = 16  # a chunk during which a worker died is divided into so many


@dataclass
class Caller:
    """The caller's side: hands out chunks, and keeps what comes back."""

    crew: Crew
    study: Study
    store: Store
    errand: Errand
    counters: list[str]
    work: Callable[[Errand, list[Part]], tuple[list[Result | None], float]]
    session: Session
    pace: float | None = None  # s per wheel, of the last tasks

    def run(self) -> None:
        """All chunks that are missing; those that killed a worker come last, in ever smaller pieces."""
        waiting, deadly = deque(self.store.missing()), []
        coming = as_completed(loop=self.crew.client.loop)
        while waiting or self.crew.outstanding:
            while waiting and len(self.crew.outstanding) < AHEAD * self.crew.size:
                coming.add(self.submit([self.part(chunk) for chunk in self.next(waiting)]))
            future = next(coming)
            if isinstance(self.crew.exception(future), KilledWorker):
                deadly += future.parts
            else:
                returned, seconds = future.result()
                self.pace = seconds if self.pace is None else (self.pace + seconds) / 2
                for part, result in zip(future.parts, returned, strict=True):
                    self.keep(part.chunk, result)
        for part in deadly:
            if not self.store.has(part.chunk):  # written before the worker died
                self.keep(part.chunk, self.narrowed(part))

    def submit(self, parts: list[Part]) -> Future:
        future = self.crew.submit(self.work, self.errand, parts)
        future.parts = parts
        return future

    def part(self, chunk: Chunk) -> Part:
        """A chunk with the values that a worker needs to run it."""
        pieces = chunk if self.study.grid else chunk * len(self.axes)
        axes = {name: axis[piece] for (name, axis), piece in zip(self.axes.items(), pieces, strict=True)}
        return Part(chunk, axes, bool(self.study.grid))

    def __post_init__(self) -> None:
        self.axes = self.study.axes

    def next(self, waiting: deque[Chunk]) -> list[Chunk]:
        """The next chunks for one worker: about SECONDS of work, less towards the end, so that all end together."""
        most, seconds = max(1, len(waiting) // (2 * self.crew.size)), task_seconds(self.crew.size)
        chunks, work = [], 0.0
        while waiting and len(chunks) < most and work < seconds:
            chunks.append(waiting.popleft())
            work += seconds if self.pace is None else self.pace * size(chunks[-1])
        return chunks

    def keep(self, chunk: Chunk, result: Result | None) -> None:
        """Writes what the worker could not write."""
        if result is not None:
            try:
                self.store.write(chunk, result, self.counters)
            except Exception as fault:
                raise StudyError(
                    f"{self.store.place} cannot be written ({fault}); what is there stays, the same command goes on."
                ) from fault
        self.session.update(size(chunk))

    def narrowed(self, part: Part) -> Result:
        """A chunk during which a worker died, in ever smaller pieces, so that the guilty wheels are known.

        Pieces of one wheel run one at a time: a worker takes innocent tasks with it.
        """
        points, count = part.points, size(part.chunk)
        result, pieces = empty_result(self.errand.job, count, len(self.counters)), [np.arange(count)]
        while pieces:
            rows = pieces.pop()
            for piece in np.array_split(rows, min(len(rows), PIECES)):
                columns = {name: column[piece] for name, column in points.items()}
                future = self.crew.submit(self.work, self.errand._replace(place=""), [Part((), columns, False)])
                if not isinstance(self.crew.exception(future), KilledWorker):
                    for name, values in future.result()[0][0].items():
                        result[name][piece] = values
                elif len(piece) > 1:
                    pieces.append(piece)
                else:
                    result["status"][piece] = Status.failed
                    result["message"][piece] = "The worker process died during this run."
        return result


def task_seconds(workers: int) -> float:
    """Work [s] in a task."""
    return max(SECONDS, workers / RATE)


def size(chunk: Chunk) -> int:
    """The number of wheels in a chunk."""
    return prod(part.stop - part.start for part in chunk)


def run(
    study: Study,
    out: str | Path,
    *,
    fmu: str | Path = "wheel.fmu",
    workers: int | None = None,
    scheduler: str | None = None,
    client: Client | None = None,
    chunk: int | None = None,
    overwrite: bool = False,
    quiet: bool = False,
    work: Callable[[Errand, list[Part]], tuple[list[Result | None], float]] = run_parts,
) -> xr.Dataset:
    """Runs what is missing in `out`, a folder or a URL, and returns the results.

    workers    processes of the LocalCluster; all cores if None
    scheduler  address of a running Dask scheduler, tcp://host:port, instead of a LocalCluster
    client     a Dask client that is open already, instead of both; it stays open
    chunk      wheels that are run and written together; about a second of work if None
    work       what a worker does with a task; for tests
    """
    if not Path(fmu).is_file():
        raise StudyError(f"There is no file {fmu}; ./scripts/run makes wheel.fmu.")
    archive = Path(fmu).read_bytes()
    sha256 = hashlib.sha256(archive).hexdigest()
    description = read_model_description(str(fmu), validate=False)
    place = str(out) if "://" in str(out) else str(Path(out).resolve())
    errand = Errand(f"wheel-{sha256[:16]}.zip", study.job(description), place, uuid.uuid4().hex)
    about = study_attributes(study, versions(description), sha256)
    store = Store.open(place, about["fingerprint"], overwrite)
    if store and not store.missing():
        return open_results(place)
    with nullcontext(client) if client else cluster(workers, scheduler) as user:
        send(user, archive, errand.upload)
        crew = Crew(user)
        with crew.watched():
            if store is None:
                wheels = chunk or chunk_size(crew, study, errand)
                store = Store.create(place, study, errand.job, description, about, wheels)
            store.group.attrs[MARK] = errand.mark
            with session(crew, store, quiet) as now:
                Caller(crew, study, store, errand, counters_of(description), work, now).run()
    return open_results(place)


def chunk_size(crew: Crew, study: Study, errand: Errand) -> int:
    """Wheels of about a second of work, by some of the study that a worker runs first."""
    lengths, count = study.shape.values(), prod(study.shape.values())
    some = np.random.default_rng(0).choice(count, min(count, 256), replace=False)
    index = np.unravel_index(some, tuple(lengths)) if study.grid else [some] * len(study.axes)
    points = {name: axis[k] for (name, axis), k in zip(study.axes.items(), index, strict=True)}
    trial = crew.submit(pace, errand, points, CHUNK / 10)
    if isinstance(crew.exception(trial), KilledWorker):
        return FEWEST
    history = 8 * len(errand.job.times) * len(errand.job.history)
    most = min(count // (4 * crew.size), LARGEST // max(history, 1))
    return max(FEWEST, min(int(CHUNK / trial.result()), most))


def send(client: Client, fmu: bytes, name: str) -> None:
    """Uploads this package and the FMU as a file of that name to all workers, later ones included."""
    with tempfile.TemporaryDirectory() as folder:
        client.upload_file(str(pack(fmu, Path(folder) / name)))


def versions(description: ModelDescription) -> dict[str, str]:
    """Versions of all that the numbers may depend on."""
    packages = ("fmpy", "numpy", "dask", "xarray", "zarr")
    return {
        "fmu_guid": description.guid,
        "fmu_version": description.version or "",
        "python_version": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
        **{f"{name}_version": version(name) for name in packages},
    }
