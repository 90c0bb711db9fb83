"""Runs a study with Dask: a LocalCluster, or the cluster behind a scheduler's address.

The caller hands out the chunks of the results that have not been run, and writes each as it comes back. Zarr renames
each file when it is complete. The status of a chunk is written last: without it a chunk is run again, whatever else of
it is there.
"""

import hashlib
import json
import math
import signal
import sys
import tempfile
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import asdict, replace
from itertools import islice, product
from multiprocessing.resource_tracker import ensure_running
from pathlib import Path
from typing import TypeAlias

import dask
import numpy as np
import xarray as xr
import zarr
from dask.array.core import normalize_chunks, slices_from_chunks
from dask.system import CPU_COUNT
from distributed import Client, Future, LocalCluster, as_completed
from distributed.deploy import Cluster
from distributed.scheduler import KilledWorker

from wheelfmu.fmu.outputs import alone
from wheelfmu.fmu.progress import bar
from wheelfmu.fmu.values import Fault

from .dataset import TITLE, Region, axes_of, open_results, points, provenance, template
from .names import variables_of
from .plan import Status, Study
from .worker import Result, pack, run_chunk

Workers: TypeAlias = int | str | Cluster | None
FEWEST, LARGEST = 16, 2**25  # wheels, and bytes of a history, in a chunk
STEPS = 10_000_000  # between communication points, in a chunk
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
    fmu, place = Path(fmu), str(out).removeprefix("file://")
    place = place if "://" in place else str(Path(place).resolve())
    if not fmu.is_file():
        raise Fault(f"There is no file {fmu}; ./scripts/run makes wheel.fmu.")
    study.check(variables_of(fmu))
    with nullcontext() if "://" in place else alone(Path(place)):  # one caller at a time
        return fill(study, place, fmu, workers, chunk, overwrite)


def fill(study: Study, place: str, fmu: Path, workers: Workers, chunk: int | None, overwrite: bool) -> xr.Dataset:
    """The results with all their wheels."""
    sha256 = hashlib.sha256(fmu.read_bytes()).hexdigest()
    fingerprint = hashlib.sha256(json.dumps([asdict(study), sha256]).encode()).hexdigest()
    group, axes, variables = kept(place, fingerprint, overwrite), axes_of(study), variables_of(fmu)
    if there := int((group["status"][:] != Status.not_computed).sum()) if group else 0:
        print(f"{there} of {group['status'].size} wheels are there already.", file=sys.stderr)
        if there == group["status"].size:
            return open_results(place)
    if doubt := study.doubt(variables):
        print(f"study: warning: {doubt}", file=sys.stderr)
    crew = cluster(workers) if isinstance(workers, int | None) else nullcontext(workers)
    with crew as running, Client(running, timeout=ANSWER) as client:
        upload = sent(client, fmu)
        client.wait_for_workers(1, timeout=PATIENCE)
        if group is None:
            empty = template(study, axes, variables, chunk or chunk_size(study, axes, len(client.nthreads())))
            empty.attrs = provenance(study, fmu) | {"fmu_sha256": sha256}
            empty.to_zarr(place, mode="w", compute=False, consolidated=False, zarr_format=3)
            group = zarr.open_group(place, mode="r+")
            group.attrs["fingerprint"] = fingerprint  # last: all is there
        common = replace(study, grid={}, list={})
        common.parsed  # noqa: B018 - here, for a worker has no description of the variables

        def submit(region: Region) -> object:
            return client.submit(run_chunk, upload, common, points(axes, region), pure=False)

        with bar(total=group["status"].size, initial=there, unit=" wheels", mininterval=0.2) as done:
            for region, result in finished(client, submit, missing(group)):
                for name in sorted(result, key="status".__eq__):
                    group[name][region] = result[name]
                done.update(result["status"].size)
    return open_results(place)


def sent(client: Client, fmu: Path) -> str:
    """The name under which workers have the FMU and this package.

    A new one per run: workers still read modules from the file of an earlier run, which must not change.
    """
    with tempfile.TemporaryDirectory() as folder:
        upload = pack(fmu, Path(folder) / f"wheel-{uuid.uuid4().hex}.zip")
        client.upload_file(str(upload))
    return upload.name


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


def missing(group: zarr.Group) -> list[Region]:
    """The chunks that have not been run, in order."""
    status, codes = group["status"], group["status"][:]
    chunks = slices_from_chunks(normalize_chunks(status.chunks, status.shape))
    return [region for region in chunks if (codes[region] == Status.not_computed).any()]


def finished(client: Client, submit: Callable, regions: list[Region]) -> Iterator[tuple[Region, Result]]:
    """The regions with their results, as they come; two for each worker are on their way.

    Regions during which a worker died come last, wheel by wheel, until those that kill it are known.
    """
    left, suspects = iter(regions), []
    sent: dict[Future, Region] = {}
    done = as_completed(loop=client.loop)

    def fill_up() -> None:
        many = max(1, 2 * len(client.nthreads()))  # one where every worker starts again
        for region in islice(left, max(0, many - len(sent))):
            future = submit(region)
            sent[future] = region
            done.add(future)

    fill_up()
    for future in done:
        region = sent.pop(future)
        fill_up()
        if isinstance(future.exception(), KilledWorker):
            suspects.append(region)
        else:
            yield region, future.result()
    for region in suspects:
        for place in product(*(range(part.start, part.stop) for part in region)):
            wheel = tuple(slice(k, k + 1) for k in place)
            future = submit(wheel)
            yield wheel, died(wheel) if isinstance(future.exception(), KilledWorker) else future.result()


def died(region: Region) -> Result:
    """The results of one wheel whose run has killed its worker."""
    shape, text = [1] * len(region), "The worker process died during this run."
    return {"status": np.full(shape, Status.failed, "i1"), "message": np.full(shape, text, "T")}


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
    with dask.config.set(options):
        with deaf():
            local = LocalCluster(**processes, dashboard_address=":0")
        with local:
            count = workers or CPU_COUNT
            local.scale(count)
            local.wait_for_workers(count, timeout=PATIENCE)
            yield local
