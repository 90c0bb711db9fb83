"""Runs a study with Dask: a LocalCluster, or the cluster behind a scheduler's address.

The caller hands out the chunks of the results that have not been run. Workers write the results themselves where they
reach the store; else the results come back, and the caller writes them.
"""

import hashlib
import json
import math
import signal
import sys
import tempfile
import uuid
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import asdict, replace
from functools import partial
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from typing import TypeAlias

import dask
import numpy as np
import xarray as xr
import zarr
from dask.array.core import normalize_chunks, slices_from_chunks
from dask.system import CPU_COUNT
from distributed import Client, LocalCluster, as_completed
from distributed.deploy import Cluster
from distributed.scheduler import KilledWorker

from wheelfmu.fmu import values
from wheelfmu.fmu.outputs import alone
from wheelfmu.fmu.progress import bar
from wheelfmu.fmu.values import Fault

from .dataset import TITLE, axes_of, open_results, points, provenance, template
from .plan import Status, Study, description
from .worker import MARK, Region, Result, pack, run_chunk, write

Workers: TypeAlias = int | str | Cluster | None
FEWEST, LARGEST = 16, 2**25  # wheels, and bytes of a history, in a chunk
STEPS = 10_000_000  # between communication points, in a chunk
BATCH = 100  # chunks that the scheduler gets at a time; it hands them out as workers become free
PIECES = 16  # a chunk during which a worker died is divided into so many
PATIENCE = 1800  # s for the first worker to appear, on a loaded machine or in a cluster's queue
ANSWER = 300  # s for a scheduler to answer; the address may be wrong


def run(
    study: Study,
    out: str | Path,
    *,
    fmu: str | Path = "wheel.fmu",
    workers: Workers = None,
    chunk: int | None = None,
    overwrite: bool = False,
) -> xr.Dataset:
    """Runs the wheels that are missing in `out`, a folder or a URL, and returns the results.

    workers    processes of a LocalCluster, all cores if None; or a running Dask cluster, or its scheduler's address,
               tcp://host:port
    chunk      wheels that are run and written together; by the size of the study if None
    overwrite  discards the results that are there, also those of another study

    The progress bar is for terminals; the environment variable TQDM_DISABLE=1 hides it there.
    """
    fmu, place = Path(fmu), str(out) if "://" in str(out) else str(Path(out).resolve())
    if not fmu.is_file():
        raise Fault(f"There is no file {fmu}; ./scripts/run makes wheel.fmu.")
    study.check(values.variables(description(fmu)))
    with nullcontext() if "://" in place else alone(Path(place)):  # one caller at a time
        return fill(study, place, fmu, workers, chunk, overwrite)


def fill(study: Study, place: str, fmu: Path, workers: Workers, chunk: int | None, overwrite: bool) -> xr.Dataset:
    """The results with all their wheels."""
    sha256 = hashlib.sha256(fmu.read_bytes()).hexdigest()
    fingerprint = hashlib.sha256(json.dumps([asdict(study), sha256]).encode()).hexdigest()
    group, axes, variables = kept(place, fingerprint, overwrite), axes_of(study), values.variables(description(fmu))
    if there := int((group["status"][:] != Status.not_computed).sum()) if group else 0:
        print(f"{there} of {group['status'].size} wheels are there already.", file=sys.stderr)
        if there == group["status"].size:
            return open_results(place)
    if doubt := study.doubt(variables):
        print(f"study: warning: {doubt}", file=sys.stderr)
    crew = cluster(workers) if isinstance(workers, int | None) else nullcontext(workers)
    with crew as running, Client(running, timeout=ANSWER) as client:
        mark = uuid.uuid4().hex
        with tempfile.TemporaryDirectory() as folder:
            # A new name per run: workers still read modules from the file of an earlier run, which must not change.
            upload = pack(fmu, Path(folder) / f"wheel-{mark}.zip")
            client.upload_file(str(upload))
        client.wait_for_workers(1, timeout=PATIENCE)
        if group is None:
            empty = template(study, axes, variables, chunk or chunk_size(study, axes, len(client.nthreads())))
            empty.attrs = provenance(study, fmu) | {"fmu_sha256": sha256}
            empty.to_zarr(place, mode="w", compute=False, consolidated=False, zarr_format=3)
            group = zarr.open_group(place, mode="r+")
            group.attrs["fingerprint"] = fingerprint  # last: all is there
        group.attrs[MARK] = mark
        common = replace(study, grid={}, list={})
        common.parsed  # noqa: B018 - here, for a worker has no description of the variables
        task = partial(run_chunk, upload.name, common, place, mark)
        with bar(total=group["status"].size, initial=there, unit=" wheels", mininterval=0.2) as done:
            for region, result in finished(
                client, task, partial(points, axes), missing(group, [*map(str, axes.sizes)])
            ):
                if result is not None:
                    write(place, mark, region, result)
                done.update(math.prod(part.stop - part.start for part in region.values()))
    return open_results(place)


def kept(place: str, fingerprint: str, overwrite: bool) -> zarr.Group | None:
    """The results of this study that are there; None if there are none or they are to be overwritten; or Fault."""
    try:
        group = zarr.open_group(place, mode="r+")
    except (FileNotFoundError, ValueError):  # zarr's own error for a missing group is both
        if "://" in place or not Path(place).exists():
            return None
        raise Fault(f"{place} exists and is not a Zarr group; choose another place (--out).") from None
    if overwrite or (group.attrs.get("title") == TITLE and "fingerprint" not in group.attrs):
        return None  # without its fingerprint: killed while it was made
    if group.attrs.get("fingerprint") != fingerprint:
        raise Fault(
            f"{place} holds the results of another study or of another wheel.fmu; choose another place (--out), "
            "or discard them (--overwrite, in Python overwrite=True)."
        )
    return group


def missing(group: zarr.Group, dims: list[str]) -> list[Region]:
    """The chunks that have not been run, in order."""
    status, codes = group["status"], group["status"][:]
    chunks = slices_from_chunks(normalize_chunks(status.chunks, status.shape))
    left = (parts for parts in chunks if (codes[parts] == Status.not_computed).any())
    return [dict(zip(dims, parts, strict=True)) for parts in left]


def finished(
    client: Client, task: Callable[..., Result | None], points_of: Callable[[Region], dict], regions: list[Region]
) -> Iterator[tuple[Region, Result | None]]:
    """The regions as they are finished, with the results that are not written yet.

    Those during which a worker died come last, in pieces and each alone, until the wheels that kill it are known.
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
            elif len(pieces := divided(region)) > 1 or len(batch) > 1:
                batches += [[piece] for piece in pieces]
            else:
                yield region, died(region)


def died(region: Region) -> Result:
    """The results of one wheel whose run has killed its worker."""
    shape, text = [1] * len(region), "The worker process died during this run."
    return {"status": np.full(shape, Status.failed, "i1"), "message": np.full(shape, text, "T")}


def divided(region: Region) -> list[Region]:
    """The region in pieces along its longest side; one wheel is one piece."""
    name = max(region, key=lambda name: region[name].stop - region[name].start)
    parts = np.array_split(range(region[name].start, region[name].stop), PIECES)
    return [{**region, name: slice(int(part[0]), int(part[-1]) + 1)} for part in parts if part.size]


def chunk_size(study: Study, axes: xr.Dataset, workers: int) -> int:
    """Wheels in a chunk: some seconds of work, with more than 100 workers longer, so that the caller keeps up; at least
    four chunks for each worker, so that they end together."""
    wheels, times = math.prod(axes.sizes.values()), len(study.times)
    some_seconds = STEPS // max(times, 1000) * max(1, workers // 100)
    history = 8 * times * len(study.history)  # bytes of a wheel
    return max(FEWEST, min(wheels // (4 * workers), some_seconds, LARGEST // max(history, 1)))


@contextmanager
def deaf() -> Iterator[None]:
    """Processes that are started inside never receive Ctrl-C: it is for the caller alone."""
    ensure_running()  # with a first process it would start inside, which unblocks the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def cluster(workers: int | None = None) -> Iterator[LocalCluster]:
    """A LocalCluster with one thread per process."""
    options = {"distributed.scheduler.allowed-failures": 1, "distributed.worker.profile.enabled": False}
    # Dask inspects itself so rarely that the caller's processor is free for a worker.
    options |= {"distributed.admin.tick.interval": "1s", "distributed.admin.system-monitor.interval": "10s"}
    # A nanny restarts a worker that died. LocalCluster would close it for good if, this long after a death, it happened
    # to be starting again after another one.
    options |= {"distributed.deploy.lost-worker-timeout": "1000 hours"}
    # On a loaded machine a worker logs an error where the cluster closes during its heartbeat.
    processes = {"n_workers": 0, "threads_per_worker": 1, "memory_limit": 0, "silence_logs": "CRITICAL"}
    with dask.config.set(options), ExitStack() as stack:
        with deaf():
            local = stack.enter_context(LocalCluster(**processes, dashboard_address=":0"))
        count = workers or CPU_COUNT
        local.scale(count)
        local.wait_for_workers(count, timeout=PATIENCE)
        yield local
