"""A worker's side: the FMU unpacked once, one instance, and blocks of points that come from the caller.

The caller uploads one zip file with this package and wheel.fmu. Dask hands it to workers that join later too, before
they get any block. A worker loads neither xarray nor zarr.
"""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from threading import Lock

import numpy as np
from distributed import get_worker
from numpy.typing import NDArray

from .runs import Job, Runner

Points = Mapping[str, NDArray[np.float64]]
FMU = "wheel.fmu"  # its name inside the uploaded file
_runners: dict[str, Runner] = {}  # by the name of the uploaded file; one process works for one worker
_turn = Lock()  # a worker's threads take turns at the instance


def run_block(upload: str, job: Job, points: Points) -> dict[str, NDArray]:
    """The outcomes of some points, by the FMU in the uploaded file of that name."""
    with _turn:
        if upload not in _runners:
            _runners[upload] = Runner(unpack(Path(get_worker().local_directory), upload))
        return _runners[upload].run_block(job, points)


def unpack(scratch: Path, upload: str) -> str:
    """The folder of the unpacked FMU, inside the worker's own folder, which Dask removes."""
    folder = tempfile.mkdtemp(prefix="wheel-", dir=scratch)
    with zipfile.ZipFile(scratch / upload) as package, zipfile.ZipFile(BytesIO(package.read(FMU))) as archive:
        archive.extractall(folder)
    return folder


def pack(fmu: bytes, path: Path) -> Path:
    """Writes the file to be uploaded: this package's sources and the FMU."""
    here = Path(__file__).parent
    with zipfile.ZipFile(path, "w") as package:
        package.writestr(FMU, fmu)
        for source in sorted(here.glob("*.py")):
            package.write(source, f"{here.name}/{source.name}")
    return path
