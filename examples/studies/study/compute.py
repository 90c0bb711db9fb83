"""Runs a study with Dask: a LocalCluster, or the cluster behind a scheduler's address.

The caller hands out chunks, about two seconds of work each. Workers write the results themselves where they reach the
store; else the results come back, and the caller writes them.
"""

import hashlib
import json
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import asdict, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from resource import RUSAGE_SELF, getrusage

import dask
import numpy as np
import xarray as xr
import zarr
from dask.array.core import normalize_chunks, slices_from_chunks
from distributed import Client, LocalCluster, as_completed
from distributed.scheduler import KilledWorker
from fmpy import read_model_description
from fsspec.core import url_to_fs
from tqdm import tqdm

from .dataset import TITLE, Points, axes_of, open_results, points, provenance, template
from .instance import Result
from .plan import Status, Study, StudyError
from .worker import MARK, Region, pack, run_chunk, write

Task = Callable[[Region, Points], Result | None]
SECONDS = 2.0  # of work in a chunk, a thousand times the caller's time to hand it out
RATE = 50  # chunks per second that are handed out at most: with more than 100 workers chunks are longer
FEWEST, LARGEST = 16, 2**25  # wheels, and bytes of a history, in a chunk
BATCH = 100  # chunks that the scheduler gets at a time; it hands them out as workers become free
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
    description = read_model_description(str(fmu), validate=False)
    study.check({v.name: v for v in description.modelVariables})
    sha256 = hashlib.sha256(Path(fmu).read_bytes()).hexdigest()
    fingerprint = hashlib.sha256(json.dumps([asdict(study), sha256]).encode()).hexdigest()
    place, mark = str(out) if "://" in str(out) else str(Path(out).resolve()), uuid.uuid4().hex
    group = kept(place, fingerprint, overwrite)
    if group and not missing(group):
        return open_results(place)
    axes = axes_of(study)
    with nullcontext(client) if client else cluster(workers, scheduler) as user:
        with tempfile.TemporaryDirectory() as folder:
            upload = pack(fmu, Path(folder) / f"wheel-{sha256[:16]}.zip")
            user.upload_file(str(upload))
        task = partial(work, upload.name, replace(study, grid={}, list={}, sample={}), place, mark)
        try:
            user.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise StudyError(f"There has been no worker for {PATIENCE} s.") from None
        if group is None:
            empty = template(study, axes, description, chunk or chunk_size(user, study, axes, task))
            empty.attrs = provenance(study, description, sha256)
            empty.to_zarr(place, mode="w", compute=False, consolidated=False, zarr_format=3)
            group = zarr.open_group(place, mode="r+")
            group.attrs["fingerprint"] = fingerprint  # last: all is there
        group.attrs[MARK] = mark
        status, begin = group["status"][:], time.perf_counter()
        done = before = int((status != Status.not_computed).sum())
        if done and not quiet:
            print(f"{done} of {status.size} wheels are there already.", file=sys.stderr)
        every = 0.2 if sys.stderr.isatty() else 10.0  # s
        with tqdm(total=status.size, initial=done, unit=" wheels", disable=quiet, mininterval=every) as bar:
            try:
                for region, result in finished(user, task, partial(points, study, axes), missing(group)):
                    keep(place, mark, region, result)
                    bar.update(status[region].size)
                    done += status[region].size
            finally:
                with suppress(OSError):  # of a full disk, which is reported already
                    note(user, place, group, {"wheels": done - before, "seconds": time.perf_counter() - begin})
    return open_results(place)


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


def finished(
    client: Client, task: Task, points_of: Callable[[Region], Points], regions: list[Region]
) -> Iterator[tuple[Region, Result | None]]:
    """The regions as they are finished, with the results that are not written yet.

    Those during which a worker died come last, alone and then in pieces, until the wheels that kill it are known.
    """
    batches = [regions]
    while batches:
        batch = batches.pop()
        futures = client.map(task, batch, [*map(points_of, batch)], pure=False, batch_size=BATCH)
        waiting = dict(zip(futures, batch, strict=True))
        for future in as_completed(futures, loop=client.loop):
            region = waiting.pop(future)
            if not isinstance(future.exception(), KilledWorker):
                yield region, future.result()
            elif len(batch) > 1:
                batches.append([region])
            elif len(pieces := divided(region)) > 1:
                batches += [[piece] for piece in pieces]
            else:
                message = np.array(["The worker process died during this run."], "T")
                yield region, {"status": np.array([Status.failed]), "message": message}


def divided(region: Region) -> list[Region]:
    """The region in pieces along its longest side."""
    k = int(np.argmax([part.stop - part.start for part in region]))
    edges = np.unique(np.linspace(region[k].start, region[k].stop, PIECES + 1).astype(int)).tolist()
    return [(*region[:k], slice(*ends), *region[k + 1 :]) for ends in pairwise(edges)]


def keep(place: str, mark: str, region: Region, result: Result | None) -> None:
    """Writes the results that the worker could not write."""
    if result is not None:
        try:
            write(place, mark, region, result)
        except Exception as fault:
            raise StudyError(
                f"{place} cannot be written ({fault}). The results so far are kept; "
                "the same command continues from here."
            ) from fault


def note(client: Client, place: str, group: zarr.Group, took: dict[str, float]) -> None:
    """Adds a session to the attributes of the store: its work, and the memory and disk [MB] by its end."""
    files, root = url_to_fs(place)
    memory = client.run(peak_memory).values()
    took |= {"workers": len(memory), "caller_MB": peak_memory(), "worker_MB": max(memory, default=0)}
    took["disk_MB"] = files.du(root) // 1_000_000
    before = json.loads(group.attrs.get("sessions", "[]"))
    group.attrs["sessions"] = json.dumps([*before, took])  # as text, which NetCDF can keep too


def peak_memory() -> int:
    """The largest memory [MB] that this process has had."""
    return getrusage(RUSAGE_SELF).ru_maxrss // 1000


def chunk_seconds(workers: int) -> float:
    """Work [s] in a chunk."""
    return max(SECONDS, workers / RATE)


def chunk_size(client: Client, study: Study, axes: Points, task: Task) -> int:
    """Wheels in a chunk, by the time that a worker takes for some of them, drawn at random."""
    everywhere = points(study, axes, (slice(None),) * (len(axes) if study.grid else 1))
    columns = np.broadcast_arrays(*everywhere.values())
    total, history = columns[0].size, 8 * len(study.times) * len(study.history)  # wheels; bytes
    some = np.random.default_rng(0).choice(total, min(total, TRIED), replace=False)
    tried = {name: column.flat[some] for name, column in zip(axes, columns, strict=True)}
    trial = client.submit(task, (), tried, pure=False)  # no store has its mark yet, so the results come back
    if isinstance(trial.exception(), KilledWorker):
        return FEWEST
    workers, seconds = len(client.nthreads()), float(np.nanmean(trial.result()["wall_time"]))
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
