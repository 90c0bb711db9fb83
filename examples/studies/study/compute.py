"""Runs a study with Dask: a LocalCluster, or the cluster behind a scheduler's address.

The caller hands out chunks, about two seconds of work each. Workers write the results themselves where they reach the
store; else the results come back, and the caller writes them.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from functools import partial
from itertools import islice
from math import prod
from pathlib import Path
from resource import RUSAGE_SELF, getrusage

import dask
import numpy as np
import xarray as xr
import zarr
from distributed import Client, Future, LocalCluster, as_completed
from distributed.scheduler import KilledWorker
from fmpy import read_model_description
from fsspec.core import url_to_fs
from tqdm import tqdm

from .instance import Status
from .layout import provenance, template
from .measures import StudyError
from .plan import Study
from .results import open_results
from .runs import Result
from .store import MARK, Region, kept, missing, write
from .worker import Points, pack, run_chunk

SECONDS = 2.0  # of work in a chunk, a thousand times the caller's time to hand it out
RATE = 50  # chunks per second that the caller hands out at most: with more than 100 workers chunks are longer
FEWEST, LARGEST = 16, 2**25  # wheels, and bytes of a history, in a chunk
AHEAD = 2  # chunks per worker on their way
TRIED = 32  # wheels by which a chunk's size is chosen
PIECES = 16  # a chunk during which a worker died is divided into so many
PATIENCE = 60  # s for the first worker to appear
# Workers that a LocalCluster starts ignore Ctrl-C, which is for the caller; Dask runs this text in each of them.
DEAF = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"


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
    work: Callable[..., Result | None] = run_chunk,
) -> xr.Dataset:
    """Runs the wheels that are missing in `out`, a folder or a URL, and returns the results.

    workers    processes of the LocalCluster; all cores if None
    scheduler  address of a running Dask scheduler, tcp://host:port, instead of a LocalCluster
    client     an open Dask client, instead of both; it stays open
    chunk      wheels that are run and written together; about two seconds of work if None
    overwrite  discards the results that are there, also those of another study
    work       run by a worker for each chunk; for tests
    """
    if not Path(fmu).is_file():
        raise StudyError(f"There is no file {fmu}; ./scripts/run makes wheel.fmu.")
    content, description = Path(fmu).read_bytes(), read_model_description(str(fmu), validate=False)
    study.check(description)
    sha256 = hashlib.sha256(content).hexdigest()
    place, fingerprint = str(out) if "://" in str(out) else str(Path(out).resolve()), study.fingerprint(sha256)
    group = kept(place, fingerprint, overwrite)
    if group and not missing(group):
        return open_results(place)
    with nullcontext(client) if client else cluster(workers, scheduler) as user:
        upload, mark = f"wheel-{sha256[:16]}.zip", uuid.uuid4().hex
        task = partial(work, upload, study.common(), place, mark)
        with tempfile.TemporaryDirectory() as folder:
            user.upload_file(str(pack(content, Path(folder) / upload)))
        try:
            user.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise StudyError(f"There has been no worker for {PATIENCE} s.") from None
        if group is None:
            wheels = chunk or chunk_size(user, study, task)
            empty = template(study, description, wheels, provenance(study, description, sha256))
            empty.to_zarr(place, mode="w", compute=False, consolidated=False, zarr_format=3)
            group = zarr.open_group(place, mode="r+")
            group.attrs["fingerprint"] = fingerprint  # last: all is there
        group.attrs[MARK] = mark
        Caller(user, study, group, task, place, mark).run(quiet)
    return open_results(place)


@dataclass
class Caller:
    """The caller's side: hands out chunks, and writes the results that come back."""

    client: Client
    study: Study
    group: zarr.Group
    task: Callable[[Region, Points], Result | None]
    place: str
    mark: str

    def run(self, quiet: bool) -> None:
        """All missing chunks, with a progress bar; notes at the end, whatever its reason, the cost of this session."""
        status, begin = self.group["status"][:], time.perf_counter()
        done = int((status != Status.not_computed).sum())
        if done and not quiet:
            print(f"{done} of {status.size} wheels are there already.", file=sys.stderr)
        every = 0.2 if sys.stderr.isatty() else 10.0  # s
        with tqdm(total=status.size, initial=done, unit=" wheels", disable=quiet, mininterval=every) as bar:
            wheels = 0
            try:
                for region in self.finished():
                    wheels += count(region)
                    bar.update(count(region))
            finally:
                with suppress(OSError):  # of a full disk, which is reported already
                    self.note({"wheels": wheels, "seconds": time.perf_counter() - begin})

    def finished(self) -> Iterator[Region]:
        """The missing chunks as they are finished; those that killed a worker come last, in ever smaller pieces."""
        waiting, running, deadly, coming = iter(missing(self.group)), {}, [], as_completed(loop=self.client.loop)

        def hand_out() -> None:
            """Some chunks per worker are on their way; workers come and go."""
            for region in islice(waiting, max(0, AHEAD * max(1, len(self.client.nthreads())) - len(running))):
                running[future := self.submit(region)] = region
                coming.add(future)

        hand_out()
        for future in coming:
            region = running.pop(future)
            hand_out()
            if isinstance(future.exception(), KilledWorker):
                deadly.append(region)
            else:
                self.keep(region, future.result())
                yield region
        for region in deadly:
            self.narrow(region)
            yield region

    def submit(self, region: Region) -> Future:
        return self.client.submit(self.task, region, self.study.points(region), pure=False)

    def keep(self, region: Region, result: Result | None) -> None:
        """Writes the results that the worker could not write."""
        if result is not None:
            try:
                write(self.place, self.mark, region, result)
            except Exception as fault:
                raise StudyError(
                    f"{self.place} cannot be written ({fault}). The results so far are kept; "
                    "the same command continues from here."
                ) from fault

    def narrow(self, region: Region) -> None:
        """Runs a region during which a worker died, alone, then in pieces, until the wheels that kill it are known."""
        future = self.submit(region)
        if not isinstance(future.exception(), KilledWorker):
            self.keep(region, future.result())
        elif count(region) == 1:
            message = np.array(["The worker process died during this run."], object)
            self.keep(region, {"status": np.array([Status.failed]), "message": message})
        else:
            longest = int(np.argmax([part.stop - part.start for part in region]))
            whole = np.arange(region[longest].start, region[longest].stop)
            for part in np.array_split(whole, min(len(whole), PIECES)):
                self.narrow((*region[:longest], slice(part[0], part[-1] + 1), *region[longest + 1 :]))

    def note(self, took: dict[str, float]) -> None:
        """Adds a session to the attributes of the store: its work, and the memory and disk [MB] by its end."""
        files, root = url_to_fs(self.place)
        memory = self.client.run(peak_memory).values()
        took |= {"workers": len(memory), "caller_MB": peak_memory(), "worker_MB": max(memory, default=0)}
        took["disk_MB"] = files.du(root) // 1_000_000
        before = json.loads(self.group.attrs.get("sessions", "[]"))
        self.group.attrs["sessions"] = json.dumps([*before, took])  # as text, which NetCDF can keep too


def count(region: Region) -> int:
    """The number of wheels in a region."""
    return prod(part.stop - part.start for part in region)


def peak_memory() -> int:
    """The largest memory [MB] that this process has had."""
    return getrusage(RUSAGE_SELF).ru_maxrss // 1000


def chunk_seconds(workers: int) -> float:
    """Work [s] in a chunk."""
    return max(SECONDS, workers / RATE)


def chunk_size(client: Client, study: Study, task: Callable[[Region, Points], Result | None]) -> int:
    """Wheels in a chunk, by the time that a worker takes for some of them, drawn at random."""
    lengths, workers = tuple(study.shape.values()), len(client.nthreads())
    total, history = prod(lengths), 8 * len(study.times) * len(study.history)  # wheels; bytes
    some = np.unravel_index(np.random.default_rng(0).choice(total, min(total, TRIED), replace=False), lengths)
    points = {name: values[k] for (name, values), k in zip(study.axes.items(), some * len(study.axes), strict=False)}
    trial = client.submit(task, (), points, pure=False)  # no store has its mark yet, so the results come back
    if isinstance(trial.exception(), KilledWorker):
        return FEWEST
    seconds = float(np.nanmean(trial.result()["wall_time"]))
    most = min(total // (4 * workers), LARGEST // max(history, 1), int(chunk_seconds(workers) / seconds))
    return max(FEWEST, most)


@contextmanager
def cluster(workers: int | None, scheduler: str | None) -> Iterator[Client]:
    """A client of the scheduler at that address, or of a LocalCluster with one thread per process."""
    if scheduler:
        with Client(scheduler, timeout="30s") as client:
            yield client
        return
    options = {"distributed.scheduler.allowed-failures": 1, "distributed.worker.profile.enabled": False}
    # Dask inspects itself so rarely that the caller's processor is free for a worker.
    options |= {"distributed.admin.tick.interval": "1s", "distributed.admin.system-monitor.interval": "10s"}
    # A nanny restarts a worker that died. LocalCluster would close it for good if, this long after a death, it happened
    # to be starting again after another one.
    options |= {"distributed.deploy.lost-worker-timeout": "1000 hours", "distributed.worker.preload": [DEAF]}
    processes = {"n_workers": workers, "threads_per_worker": 1, "memory_limit": 0, "silence_logs": "ERROR"}
    with dask.config.set(options), LocalCluster(**processes, dashboard_address=":0") as local, Client(local) as client:
        yield client
