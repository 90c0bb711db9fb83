"""Runs a study with Dask: an ordinary LocalCluster, or the cluster behind a scheduler's address.

The caller hands out blocks, a few per worker at a time, and writes each result when it comes; workers need no common
file system.
"""

from __future__ import annotations

import hashlib
import platform
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import CancelledError
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from importlib.metadata import version
from itertools import islice
from pathlib import Path
from threading import Event, Thread, current_thread, main_thread
from time import monotonic

import dask
import xarray as xr
from distributed import Client, LocalCluster, as_completed
from distributed.scheduler import KilledWorker
from fmpy import read_model_description
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray
from tqdm import tqdm

from .instance import Status, counters_of
from .plan import Study, StudyError
from .runs import Job, empty_result
from .store import Block, Store, study_attributes
from .worker import Points, pack, run_block

BLOCK = 256  # points: about a tenth of a second of work, a hundred times what handing it out costs
AHEAD = 3  # blocks per worker on their way
LOST = 60  # s without any worker after which a study gives up


@dataclass
class Caller:
    """The caller's side: hands out blocks, and writes what comes back."""

    client: Client
    study: Study
    job: Job
    store: Store
    upload: str
    counters: list[str]
    work: Callable[[str, Job, Points], dict[str, NDArray]]
    outstanding: set[object] = field(default_factory=set)

    def submit(self, block: Block | None, points: Points) -> object:
        future = self.client.submit(self.work, self.upload, self.job, points, pure=False)
        future.block = block
        self.outstanding.add(future)
        return future

    def run(self, bar: tqdm) -> None:
        """All blocks that are missing; those that killed a worker come last, point by point."""
        waiting = iter(self.store.missing())
        ahead = AHEAD * max(1, len(self.client.scheduler_info(n_workers=-1)["workers"]))
        first = [self.submit(b, self.store.points(self.study, b)) for b in islice(waiting, ahead)]
        deadly, coming = [], as_completed(first)
        for future in coming:
            self.outstanding.discard(future)
            if isinstance(future.exception(), KilledWorker):
                deadly.append(future.block)
            else:
                self._keep(future.block, future.result(), bar)
            block = next(waiting, None)
            if block is not None:
                coming.add(self.submit(block, self.store.points(self.study, block)))
        for block in deadly:
            self._keep(block, self._one_by_one(block), bar)

    def _keep(self, block: Block, result: Mapping[str, NDArray], bar: tqdm) -> None:
        self.store.write(block, result, self.counters)
        bar.update(len(result["status"]))

    def _one_by_one(self, block: Block) -> dict[str, NDArray]:
        """A block during which a worker died: one point at a time, so that the guilty one is known."""
        points = self.store.points(self.study, block)
        count = len(next(iter(points.values())))
        result = empty_result(self.job, count, len(self.counters))
        for i in range(count):
            future = self.submit(None, {name: column[i : i + 1] for name, column in points.items()})
            if isinstance(future.exception(), KilledWorker):
                result["status"][i], result["message"][i] = Status.failed, "The worker process died during this run."
            else:
                for name, values in future.result().items():
                    result[name][i] = values[0]
            self.outstanding.discard(future)
        return result


def run(
    study: Study,
    out: Path,
    *,
    fmu: str | Path = "wheel.fmu",
    workers: int | None = None,
    scheduler: str | None = None,
    client: Client | None = None,
    block: int = BLOCK,
    overwrite: bool = False,
    quiet: bool = False,
    work: Callable[[str, Job, Points], dict[str, NDArray]] = run_block,
) -> xr.Dataset:
    """Runs what is missing in `out` and returns the results.

    workers    processes of the LocalCluster; all cores if None
    scheduler  address of a running Dask scheduler, tcp://host:port, instead of a LocalCluster
    client     a Dask client that is open already, instead of both; it stays open
    block      points that are handed out and written together (fixed when the results are begun)
    work       what a worker does with a block; for tests
    """
    if not Path(fmu).is_file():
        raise StudyError(f"There is no file {fmu}; ./scripts/run makes wheel.fmu.")
    archive = Path(fmu).read_bytes()
    sha256 = hashlib.sha256(archive).hexdigest()
    description = read_model_description(str(fmu), validate=False)
    job = study.job(description)
    store = None if overwrite else Store.open(out, study.fingerprint(sha256))
    if store is None:
        shutil.rmtree(out, ignore_errors=True)
        store = Store.create(
            out, study, job, description, study_attributes(study, versions(description), sha256), block
        )
    if store.missing():
        opened = nullcontext(client) if client else cluster(workers, scheduler)
        with opened as user, progress(store, quiet) as bar:
            upload = send(user, archive, f"wheel-{sha256[:16]}.zip")
            caller = Caller(user, study, job, store, upload, counters_of(description), work)
            with watch(caller):
                caller.run(bar)
    return store.dataset()


def send(client: Client, fmu: bytes, name: str) -> str:
    """Uploads this package and the FMU as a file of that name to all workers, later ones included; returns the name."""
    with tempfile.TemporaryDirectory() as folder:
        client.upload_file(str(pack(fmu, Path(folder) / name)))
    return name


@contextmanager
def watch(caller: Caller) -> Iterator[None]:
    """Without any worker for LOST seconds, cancels what is waited for; StudyError instead of waiting for ever."""
    over = Event()

    def look() -> None:
        since = monotonic()
        while not over.wait(LOST / 20):
            if caller.client.nthreads():
                since = monotonic()
            elif monotonic() - since > LOST:
                caller.client.cancel(list(caller.outstanding), force=True)
                return

    watcher = Thread(target=look, daemon=True)
    watcher.start()
    try:
        yield
    except CancelledError:
        raise StudyError(f"There has been no worker for {LOST} s; started again, the study goes on.") from None
    finally:
        over.set()
        watcher.join()


@contextmanager
def cluster(workers: int | None, scheduler: str | None) -> Iterator[Client]:
    """A client of the scheduler at that address, or of a LocalCluster of its own with one thread per process."""
    if scheduler:
        with Client(scheduler, timeout="30s") as client:
            yield client
        return
    options = {"distributed.scheduler.allowed-failures": 1, "distributed.worker.profile.enabled": False}
    # A worker that died is started again by its nanny. LocalCluster would close it for good if, this long after a
    # death, it happened to be starting again after another one.
    options["distributed.deploy.lost-worker-timeout"] = "1000 hours"
    processes = {"n_workers": workers, "threads_per_worker": 1, "memory_limit": 0}
    with dask.config.set(options):
        with uninterrupted():
            local = LocalCluster(**processes, dashboard_address=":0", silence_logs="ERROR")
        with local, Client(local) as client:
            yield client


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Processes that are started meanwhile ignore Ctrl-C: it is for the caller, who then stops them."""
    if current_thread() is not main_thread():  # no other thread may change this
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def progress(store: Store, quiet: bool) -> Iterator[tqdm]:
    """A bar with the time left; where the output is no terminal, a line every ten seconds."""
    status = store.group["status"][:]
    done = int((status != Status.not_computed).sum())
    if done and not quiet:
        print(f"{done} of {status.size} wheels are there already.", file=sys.stderr)
    every = 0.2 if sys.stderr.isatty() else 10.0
    with tqdm(total=status.size, initial=done, unit=" wheels", disable=quiet, mininterval=every, smoothing=0.1) as bar:
        yield bar


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
