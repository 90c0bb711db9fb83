"""A worker's side: the FMU unpacked once, one instance, and blocks of points that come from the caller.

A worker loads neither xarray nor zarr.
"""

from __future__ import annotations

import shutil
import tempfile
import zipfile
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from threading import Lock

import numpy as np
from distributed import Worker, WorkerPlugin, get_worker
from numpy.typing import NDArray

from .runs import Job, Runner

Points = Mapping[str, NDArray[np.float64]]


class FmuPlugin(WorkerPlugin):
    """Gives a worker process the unpacked FMU and its one instance; a lock keeps the worker's threads apart."""

    def __init__(self, archive: bytes, sha256: str) -> None:
        self.archive, self.name = archive, f"wheel-{sha256}"
        self.lock, self.runner = None, None

    def setup(self, worker: Worker) -> None:
        self.lock = Lock()
        self.folder = Path(tempfile.mkdtemp(prefix="wheel-", dir=worker.local_directory))
        zipfile.ZipFile(BytesIO(self.archive)).extractall(self.folder)
        self.runner = Runner(str(self.folder))

    def teardown(self, worker: Worker) -> None:
        if self.runner:
            self.runner.close()
            shutil.rmtree(self.folder, ignore_errors=True)


def run_block(plugin: str, job: Job, points: Points) -> dict[str, NDArray]:
    """On a worker: the outcomes of some points."""
    fmu = get_worker().plugins[plugin]
    with fmu.lock:
        return fmu.runner.run_block(job, points)
