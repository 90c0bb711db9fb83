"""A worker's side: the FMU unpacked once, one instance, and chunks of wheels that come from the caller.

The caller uploads wheel.fmu with this package and the compiled march.c in it. Dask passes it to workers that join later
too, before they get any task. A worker loads zarr only to write its results itself; where it cannot reach the caller's
store, which has the caller's mark, they go back to the caller.
"""

import shutil
import subprocess
import zipfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from threading import Lock

from distributed import get_worker

from .instance import MARCH, Array, Instance, Result, run_block
from .plan import Study, StudyError

Region = tuple[slice, ...]  # of the results: the wheels of a chunk
MARK = "caller"  # the attribute by which a worker recognizes the caller's store
_turn = Lock()  # a worker's threads take turns at the instance


def run_chunk(
    upload: str, study: Study, place: str, mark: str, region: Region, points: Mapping[str, Array]
) -> Result | None:
    """Runs the wheels of a chunk and writes them; returns the results that could not be written from here.

    upload: name of the uploaded file; study: without its axes; place, mark: of the caller's store.
    """
    with _turn:
        result = run_block(instance(upload), study, points)
    try:
        write(place, mark, region, result)
    except Exception:  # noqa: BLE001 - no zarr, folder, permission, network or space: the caller tries, and reports
        return result
    return None


@cache
def instance(upload: str) -> Instance:
    """The only one of this process, unpacked in the worker's own folder, which Dask removes."""
    package = Path(get_worker().local_directory) / upload
    shutil.unpack_archive(package, package.with_suffix(""))
    return Instance(str(package.with_suffix("")))


def write(place: str, mark: str, region: Region, result: Result) -> None:
    """The columns of a region side by side, then the status; FileNotFoundError if the caller's mark is not there.

    Each file is renamed when it is complete. A chunk without status is run again, whatever else of it is there.
    """
    import zarr

    group = zarr.open_group(place, mode="r+")
    if group.attrs.get(MARK) != mark:
        raise FileNotFoundError(f"{place} does not have the mark of this caller.")
    shape = [part.stop - part.start for part in region]

    def put(name: str) -> None:
        group[name][region] = result[name].reshape(*shape, *result[name].shape[1:])

    with ThreadPoolExecutor(len(result)) as pool:  # the files of a remote store travel at the same time
        list(pool.map(put, result.keys() - {"status"}))
    put("status")


def pack(fmu: str | Path, path: Path) -> Path:
    """Writes the file to be uploaded: the FMU, with this package's sources and the loop over the steps, compiled."""
    library, source = path.with_name(MARCH), Path(__file__).with_name("march.c")
    try:
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", source, "-o", library], check=True)
    except FileNotFoundError:
        raise StudyError("A study needs a C compiler, cc, on the machine where it is started.") from None
    shutil.copy(fmu, path)
    with zipfile.ZipFile(path, "a") as package:
        package.write(library, MARCH)
        for source in Path(__file__).parent.glob("*.py"):
            package.write(source, f"{__package__}/{source.name}")
    return path
