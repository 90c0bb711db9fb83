"""A worker's side: the FMU unpacked once, one instance, and chunks of wheels that come from the caller.

The caller uploads one zip file with this package, wheel.fmu and the compiled march.c. Dask passes it to workers that
join later too, before they get any task. A worker loads zarr only to write its results itself; where it cannot reach
the caller's store, they go back to the caller.
"""

from __future__ import annotations

import subprocess
import tempfile
import zipfile
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from threading import Lock

import numpy as np
from distributed import get_worker
from numpy.typing import NDArray

from .instance import MARCH
from .measures import StudyError
from .plan import Study
from .runs import Result, Runner

Points = Mapping[str, NDArray[np.float64]]
FMU = "wheel.fmu"  # its name inside the uploaded file
_runners: dict[str, Runner] = {}  # by the name of the uploaded file; one process works for one worker
_turn = Lock()  # a worker's threads take turns at the instance


def run_chunk(
    upload: str, study: Study, place: str, mark: str, region: tuple[slice, ...], points: Points
) -> Result | None:
    """Runs the wheels of a chunk and writes them; returns the results that could not be written from here.

    upload: name of the uploaded file; study: without its axes; place, mark: of the caller's store.
    """
    with _turn:
        result = runner_of(upload).run_block(study, points)
    try:
        from .store import write

        write(place, mark, region, result)
    except Exception:  # noqa: BLE001 - no zarr, folder, permission, network or space: the caller tries, and reports
        return result
    return None


def runner_of(upload: str) -> Runner:
    """The instance made of the uploaded file of that name, unpacked in the worker's own folder, which Dask removes."""
    if upload not in _runners:
        scratch = Path(get_worker().local_directory)
        folder = tempfile.mkdtemp(prefix="wheel-", dir=scratch)
        with zipfile.ZipFile(scratch / upload) as package, zipfile.ZipFile(BytesIO(package.read(FMU))) as fmu:
            fmu.extractall(folder)
            package.extract(MARCH, folder)
        _runners[upload] = Runner(folder)
    return _runners[upload]


def pack(fmu: bytes, path: Path) -> Path:
    """Writes the file to be uploaded: this package's sources, the FMU and the loop over the steps."""
    here = Path(__file__).parent
    with zipfile.ZipFile(path, "w") as package, tempfile.TemporaryDirectory() as folder:
        package.writestr(FMU, fmu)
        package.write(compiled(Path(folder)), MARCH)
        for source in sorted(here.glob("*.py")):
            package.write(source, f"{here.name}/{source.name}")
    return path


def compiled(folder: Path) -> Path:
    """march.c as a library in that folder."""
    library, source = folder / MARCH, Path(__file__).with_name("march.c")
    command = ["cc", "-O2", "-shared", "-fPIC", source, "-o", library]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True)
    except FileNotFoundError:
        raise StudyError("A study needs a C compiler, cc, on the machine where it is started.") from None
    return library
