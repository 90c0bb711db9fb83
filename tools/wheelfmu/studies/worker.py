"""A worker's side: the FMU unpacked once, one instance, and chunks of wheels that come from the caller.

The caller uploads wheel.fmu with this package and the compiled march.c in it. Dask passes it to workers that join later
too, before they get any task. Wheels run one after the other, with fmi2Reset between them, never a second instance;
march.c steps along the communication points, where Python would take longer than the wheel. A start that several wheels
share runs once. A wheel that fails is a status with the FMU's message; nothing in run_block raises because of what a
wheel does. A worker loads zarr only to write its results itself; where it cannot reach the caller's store, which has
the caller's mark, they go back to the caller.
"""

import shutil
import subprocess
import zipfile
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from ctypes import CDLL, byref, c_size_t, c_uint, c_void_p
from functools import cache
from pathlib import Path
from threading import Lock
from time import perf_counter

import numpy as np
from distributed import get_worker
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2FMUstate
from numpy.typing import NDArray

from .plan import Status, Study, StudyError, can_change, counters_of

Array = NDArray[np.float64]
Result = dict[str, NDArray]
Values = Mapping[str, float]
# The fate of the wheel, its time [s], a row of samples at each time that is reached.
Run = tuple[Status, float | None, Array]
OK, WARNING, DISCARD = range(3)  # fmi2Status
LAST_SUCCESSFUL_TIME, TERMINATED = 2, 3  # fmi2StatusKind
MARCH = "march.library"  # march.c, compiled (Dask would take a .so for a module), beside the FMU's modelDescription.xml
NO_ROWS = np.empty((0, 0))
NUMBERS = {"Real": float, "Integer": int, "Boolean": int}
Region = tuple[slice, ...]  # of the results: the wheels of a chunk
MARK = "caller"  # the attribute by which a worker recognizes the caller's store
_turn = Lock()  # a worker's threads take turns at the instance
# Words of the FMU's message, for each end of a run.
ENDINGS = {
    "lies flat": Status.flat,
    "lifted off": Status.lifted_off,
    "needs a friction coefficient": Status.grip,
    "jams": Status.jammed,
}


class Instance:
    """The only instance of a worker, made by fmpy."""

    def __init__(self, folder: str) -> None:
        description = read_model_description(folder, validate=False)
        self.variables = {v.name: v for v in description.modelVariables}
        self.counters = counters_of(self.variables)
        self.messages: list[str] = []  # since the start of the run
        of = {"guid": description.guid, "modelIdentifier": description.coSimulation.modelIdentifier}
        self.fmu = FMU2Slave(unzipDirectory=folder, instanceName="wheel", **of)
        callbacks = fmi2CallbackFunctions()  # the logger of instantiate_fmu would stay that of the process
        callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self.fmu.instantiate(callbacks=callbacks)
        self.typed = cache(self._typed)
        self._snapshot = fmi2FMUstate()  # at branch_at
        self._kept: tuple | None = None  # values and messages of that start
        self._march = CDLL(str(Path(folder) / MARCH)).march

    def _log(self, _environment: object, _name: bytes, status: int, _category: bytes, text: bytes) -> None:
        if status != OK:
            self.messages.append(text.decode())

    def _typed(self, names: tuple[str, ...]) -> list[tuple[str, list[str], list[int]]]:
        """For each type among the names: the type, the names and their value references."""
        of = {kind: [name for name in names if self.variables[name].type == kind] for kind in NUMBERS}
        return [(kind, mine, [self.variables[n].valueReference for n in mine]) for kind, mine in of.items() if mine]

    def set(self, values: Values) -> None:
        for kind, names, references in self.typed(tuple(values)):
            getattr(self.fmu, f"set{kind}")(references, [NUMBERS[kind](values[name]) for name in names])

    def get(self, names: tuple[str, ...]) -> dict[str, float]:
        found = {}
        for kind, mine, references in self.typed(names):
            found |= zip(mine, getattr(self.fmu, f"get{kind}")(references), strict=True)
        return found

    def begin(self, values: Values, study: Study) -> Run:
        """To t = 0, or to `branch_at`: restored if the start that was kept last had these values, else run and kept.

        FMICallException if the FMU refuses a value.
        """
        fmu, start = self.fmu, (values, study.tolerance, study.branch_at)
        if self._kept and self._kept[0] == start:
            self.messages = [*self._kept[1]]
            fmu.setFMUstate(self._snapshot)
            return Status.reached, study.branch_at, NO_ROWS
        self._kept, self.messages = None, []
        try:
            fmu.reset()
        except FMICallException:  # after fmi2Fatal the standard allows no further call to an instance
            fmu.instantiate(callbacks=fmu.callbacks)
        self.set(values)
        fmu.setupExperiment(study.tolerance)
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        if study.branch_at is None:
            return Status.reached, 0.0, NO_ROWS
        run = self.march(np.array([0.0, study.branch_at]), ())
        if run[0] == Status.reached:
            fmu.fmi2GetFMUstate(fmu.component, byref(self._snapshot))
            self._kept = (start, [*self.messages])
        return run

    def march(self, times: Array, names: Sequence[str]) -> Run:
        """Steps along the times from times[0], the present one, and reads these Real variables at each."""
        rows, reached = np.empty((len(times), len(names))), c_size_t()
        references = (c_uint * len(names))(*(self.variables[name].valueReference for name in names))
        calls = self.fmu.dll.fmi2DoStep, self.fmu.dll.fmi2GetReal, c_void_p(self.fmu.component)
        way = times.ctypes, c_size_t(len(times)), references, c_size_t(len(names)), rows.ctypes, byref(reached)
        status = self._march(*calls, *way)
        end, fate = times[max(reached.value, 1) - 1], Status.reached if status <= WARNING else Status.failed
        if status == DISCARD:
            end, logged = self.fmu.getRealStatus(LAST_SUCCESSFUL_TIME), " ".join(self.messages)
            if self.fmu.getBooleanStatus(TERMINATED):
                fate = next((fate for words, fate in ENDINGS.items() if words in logged), fate)
        return fate, end, rows[: reached.value]

    def wheel(self, start: Values, change: Values, study: Study, times: Array) -> dict[str, object]:
        """All results of one wheel: NaN, of a counter -1, where the run has none."""
        begin, last = perf_counter(), {}
        asked = dict.fromkeys(
            [*self.counters, *study.sampled, *(n for m in study.parsed.values() for n in m.variables)]
        )
        try:
            run = self.begin(start, study)
            if run[0] == Status.reached:
                self.set(change)
                run = self.march(times, study.sampled)
        except FMICallException:
            run = Status.refused, np.nan, NO_ROWS
            self.messages = self.messages or ["A value is outside its limits."]
        else:
            with suppress(FMICallException):  # an instance that failed may be unable to answer
                last = self.get(tuple(asked))
        status, end, rows = run
        result = {"status": status, "message": " ".join(self.messages), "end_time": end}
        result["fmu_time"] = perf_counter() - begin
        result |= {name: last.get(name, -1) for name in self.counters}
        samples, t = dict(zip(study.sampled, rows.T, strict=False)) if rows.size else {}, times[: len(rows)]
        beyond = np.full(len(times) - len(t), np.nan)
        result |= {name: np.append(samples.get(name, []), beyond) for name in study.history}
        if samples and last and end > t[-1]:  # the end of a run is a sample too
            t, samples = np.append(t, end), {name: np.append(x, last[name]) for name, x in samples.items()}
        for name, measure in study.parsed.items():
            there = samples if measure.kind != "last" else last
            result[name] = measure.value(t, *(there[n] for n in measure.variables)) if there else np.nan
        return result | {"wall_time": perf_counter() - begin}


def run_block(fmu: Instance, study: Study, points: Mapping[str, Array]) -> Result:
    """The outcomes of wheels whose values by name are broadcast against each other, in their common shape.

    Of the study only what all its wheels have in common is used.
    """
    columns = np.broadcast_arrays(*points.values())
    late = [name for name in points if study.branch_at is not None and can_change(fmu.variables[name])]
    changes = [dict(zip(points, row, strict=True)) for row in zip(*(x.ravel().tolist() for x in columns), strict=True)]
    starts = [{n: change.pop(n) for n in points if n not in late} | study.values for change in changes]
    order = sorted(range(len(starts)), key=lambda i: [*starts[i].values()] if late else i)  # a shared start in a row
    times = np.array(study.times)
    wheels = {i: fmu.wheel(starts[i], changes[i], study, times) for i in order}

    def column(name: str) -> NDArray:
        values = np.array([wheels[i][name] for i in range(len(starts))], "T" if name == "message" else None)
        return values.reshape(*columns[0].shape, *values.shape[1:])

    return {name: column(name) for name in wheels[0]}


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
    """The only one of a study in this process, unpacked in the worker's own folder, which Dask removes."""
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
    others = result.keys() - {"status"}
    with ThreadPoolExecutor(len(result)) as pool:  # the files of a remote store travel at the same time
        list(pool.map(lambda name: group[name].set_basic_selection(region, result[name]), others))
    group["status"][region] = result["status"]


# The package as a worker gets it: studies alone, and where the whole is installed also that.
JOINED = "from pkgutil import extend_path\n\n__path__ = extend_path(__path__, __name__)\n"


def pack(fmu: str | Path, path: Path) -> Path:
    """Writes the file to be uploaded: the FMU, with this package's sources and the loop over the steps, compiled."""
    library, source = path.with_name(MARCH), Path(__file__).with_name("march.c")
    if not shutil.which("cc"):
        raise StudyError("A study needs a C compiler, cc, on the machine where it is started.")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", source, "-o", library], check=True)
    shutil.copy(fmu, path)
    with zipfile.ZipFile(path, "a") as package:
        package.write(library, MARCH)
        package.writestr("wheelfmu/__init__.py", JOINED)
        for source in Path(__file__).parent.glob("*.py"):
            package.write(source, f"wheelfmu/studies/{source.name}")
    return path
