"""What a caller tells while it works, and what it notes in the store when it ends: one session of perhaps several."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from resource import RUSAGE_SELF, getrusage
from time import perf_counter

from fsspec.core import url_to_fs
from tqdm import tqdm

from .crew import Crew
from .instance import Status
from .store import Store


class Session:
    """A bar with the time left, and the number of wheels that were run."""

    def __init__(self, bar: tqdm) -> None:
        self.bar, self.wheels = bar, 0

    def update(self, wheels: int) -> None:
        self.wheels += wheels
        self.bar.update(wheels)


@contextmanager
def session(crew: Crew, store: Store, quiet: bool) -> Iterator[Session]:
    """Tells how far it is, without a terminal every 10 s; when it ends, for whatever reason, notes what it took."""
    status = store.arrays["status"][:]
    done = int((status != Status.not_computed).sum())
    if done and not quiet:
        print(f"{done} of {status.size} wheels are there already.", file=sys.stderr)
    begin, every = perf_counter(), 0.2 if sys.stderr.isatty() else 10.0
    with tqdm(total=status.size, initial=done, unit=" wheels", disable=quiet, mininterval=every, smoothing=0.1) as bar:
        now = Session(bar)
        try:
            yield now
        finally:
            took = {"wheels": now.wheels, "seconds": perf_counter() - begin, "workers": crew.size}
            with suppress(OSError):  # of a full disk, of which the caller hears already
                note(crew, store, took)


def note(crew: Crew, store: Store, took: dict[str, float]) -> None:
    """Adds a session to the attributes of the store: its work, and the memory and disk [MB] by its end."""
    files, root = url_to_fs(store.place)
    workers = crew.client.run(peak_memory).values()
    took |= {"caller_MB": peak_memory(), "worker_MB": max(workers, default=0), "disk_MB": files.du(root) // 1_000_000}
    before = json.loads(store.group.attrs.get("sessions", "[]"))
    store.group.attrs["sessions"] = json.dumps([*before, took])  # as text, which NetCDF can keep too


def peak_memory() -> int:
    """The largest memory [MB] that this process has had."""
    return getrusage(RUSAGE_SELF).ru_maxrss // 1000
