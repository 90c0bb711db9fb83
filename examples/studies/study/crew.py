"""The workers of a study: those of a LocalCluster, or of the cluster behind a scheduler's address; they come and go."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager
from dataclasses import dataclass, field
from threading import Event, Thread, current_thread, main_thread
from time import monotonic

import dask
from distributed import Client, Future, LocalCluster

from .measures import StudyError

LOST = 60  # s without any worker after which a study gives up


@dataclass
class Crew:
    """Dask's client, what is on its way, and how many workers there are."""

    client: Client
    outstanding: set[Future] = field(default_factory=set)
    size: int = 1

    def submit(self, function: Callable, *args: object) -> Future:
        """Has a worker call the function."""
        future = self.client.submit(function, *args, pure=False)
        self.outstanding.add(future)
        return future

    def exception(self, future: Future) -> BaseException | None:
        """What came of it: None if it is well. The future is no longer on its way."""
        failed = future.exception()
        self.outstanding.discard(future)
        return failed

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Counts the workers; without any for LOST seconds, StudyError instead of waiting for ever."""
        over = Event()
        self.size = max(1, len(self.client.nthreads()))

        def look() -> None:
            since = monotonic()
            while not over.wait(LOST / 20):
                there = len(self.client.nthreads())
                self.size = max(1, there)
                if there:
                    since = monotonic()
                elif monotonic() - since > LOST:
                    self.client.cancel(list(self.outstanding), force=True)
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
    # Dask looks at itself so rarely that the caller's processor is free for a worker.
    options |= {"distributed.admin.tick.interval": "1s", "distributed.admin.system-monitor.interval": "10s"}
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
