"""Runs a study with Dask: a LocalCluster, or the cluster behind a scheduler's address.

The caller hands out the chunks of the results that have not been run. Workers write the results themselves where they
reach the store; else the results come back, and the caller writes them.
"""

import hashlib
import json
import math
import sys
import tempfile
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path

import dask
import numpy as np
import xarray as xr
import zarr
from dask.array.core import normalize_chunks, slices_from_chunks
from distributed import Client, LocalCluster, as_completed
from distributed.deploy import Cluster
from distributed.scheduler import KilledWorker
from fmpy import read_model_description
from fmpy.model_description import ModelDescription
from tqdm import tqdm

from wheelfmu.fmu.outputs import alone

from .dataset import TITLE, axes_of, doubtful, open_results, points, provenance, template
from .plan import Status, Study, StudyError
from .worker import MARK, Region, Result, pack, run_chunk, write

FEWEST, LARGEST = 16, 2**25  # wheels, and bytes of a history, in a chunk
STEPS = 10_000_000  # between communication points, in a chunk
BATCH = 100  # chunks that the scheduler gets at a time; it hands them out as workers become free
PIECES = 16  # a chunk during which a worker died is divided into so many
PATIENCE = 1800  # s for the first worker to appear, on a loaded machine or in a cluster's queue
ANSWER = 300  # s for a scheduler to answer; the address may be wrong
# Workers that a LocalCluster starts ignore Ctrl-C, which is for the caller; Dask runs this text in each of them.
DEAF = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"


def run(
    study: Study,
    out: str | Path,
    *,
    fmu: str | Path = "wheel.fmu",
    workers: int | str | Cluster | None = None,
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
    if not Path(fmu).is_file():
        raise StudyError(f"There is no file {fmu}; ./scripts/run makes wheel.fmu.")
    description = read_model_description(str(fmu), validate=False)
    study.check({v.name: v for v in description.modelVariables})
    place = str(out) if "://" in str(out) else str(Path(out).resolve())
    with nullcontext() if "://" in place else alone(Path(place)):
        return fill(study, place, Path(fmu), description, workers, chunk, overwrite)


def fill(
    study: Study,
    place: str,
    fmu: Path,
    description: ModelDescription,
    workers: int | str | Cluster | None,
    chunk: int | None,
    overwrite: bool,
) -> xr.Dataset:
    """The results with all their wheels, by one caller at a time."""
    sha256 = hashlib.sha256(fmu.read_bytes()).hexdigest()
    fingerprint = hashlib.sha256(json.dumps([asdict(study), sha256]).encode()).hexdigest()
    mark, group = uuid.uuid4().hex, kept(place, fingerprint, overwrite)
    if there := int((group["status"][:] != Status.not_computed).sum()) if group else 0:
        print(f"{there} of {group['status'].size} wheels are there already.", file=sys.stderr)
        if there == group["status"].size:
            return open_results(place)
    axes = axes_of(study)
    if doubt := doubtful(study, axes, description):
        print(f"study: warning: {doubt}", file=sys.stderr)
    crew = cluster(workers) if isinstance(workers, int | None) else nullcontext(workers)
    with crew as running, Client(running, timeout=ANSWER) as client:
        with tempfile.TemporaryDirectory() as folder:
            # A new name per run: workers still read modules from the file of an earlier run, which must not change.
            upload = pack(fmu, Path(folder) / f"wheel-{mark}.zip")
            client.upload_file(str(upload))
        client.wait_for_workers(1, timeout=PATIENCE)
        if group is None:
            empty = template(study, axes, description, chunk or chunk_size(study, axes, len(client.nthreads())))
            empty.attrs = provenance(study, description, sha256)
            empty.to_zarr(place, mode="w", compute=False, consolidated=False, zarr_format=3)
            group = zarr.open_group(place, mode="r+")
            group.attrs["fingerprint"] = fingerprint  # last: all is there
        group.attrs[MARK] = mark
        common = replace(study, grid={}, list={}, measures=study.restated({}))
        task = partial(run_chunk, upload.name, common, place, mark)
        quiet = {} if sys.stderr.isatty() else {"disable": True}  # else by TQDM_DISABLE
        with tqdm(total=group["status"].size, initial=there, unit=" wheels", mininterval=0.2, **quiet) as bar:
            for region, result in finished(client, task, partial(points, axes), missing(group)):
                if result is not None:
                    write(place, mark, region, result)
                bar.update(math.prod(part.stop - part.start for part in region))
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
                yield region, {"status": Status.failed, "message": "The worker process died during this run."}


def divided(region: Region) -> list[Region]:
    """The region in pieces along its longest side; one wheel is one piece."""
    k = int(np.argmax([part.stop - part.start for part in region]))
    parts = [part.tolist() for part in np.array_split(range(region[k].start, region[k].stop), PIECES) if part.size]
    return [(*region[:k], slice(part[0], part[-1] + 1), *region[k + 1 :]) for part in parts]


def chunk_size(study: Study, axes: xr.Dataset, workers: int) -> int:
    """Wheels in a chunk: some seconds of work, with more than 100 workers longer, so that the caller keeps up; at least
    four chunks for each worker, so that they end together."""
    wheels, times = math.prod(axes.sizes.values()), len(study.times)
    some_seconds = STEPS // max(times, 1000) * max(1, workers // 100)
    history = 8 * times * len(study.history)  # bytes of a wheel
    return max(FEWEST, min(wheels // (4 * workers), some_seconds, LARGEST // max(history, 1)))


@contextmanager
def cluster(workers: int | None = None) -> Iterator[LocalCluster]:
    """A LocalCluster with one thread per process."""
    options = {"distributed.scheduler.allowed-failures": 1, "distributed.worker.profile.enabled": False}
    # Dask inspects itself so rarely that the caller's processor is free for a worker.
    options |= {"distributed.admin.tick.interval": "1s", "distributed.admin.system-monitor.interval": "10s"}
    # A nanny restarts a worker that died. LocalCluster would close it for good if, this long after a death, it happened
    # to be starting again after another one.
    options |= {"distributed.deploy.lost-worker-timeout": "1000 hours", "distributed.worker.preload": [DEAF]}
    # On a loaded machine a worker logs an error where the cluster closes during its heartbeat.
    processes = {"n_workers": workers, "threads_per_worker": 1, "memory_limit": 0, "silence_logs": "CRITICAL"}
    with dask.config.set(options), LocalCluster(**processes, dashboard_address=":0") as local:
        yield local
