"""A worker's side: the FMU unpacked once, one instance, and chunks of wheels that come from the caller.

The caller uploads wheel.fmu with this package and the compiled march.c in it. Dask passes it to workers that join later
too, before they get any task. Wheels run one after the other, with fmi2Reset between them, never a second instance;
march.c steps along the communication points, where Python would take longer than the wheel. A wheel that fails is a
status with the FMU's message; nothing in run_block raises because of what a wheel does.
"""

import shutil
import subprocess
import zipfile
from collections.abc import Mapping, Sequence
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
from fmpy.fmi2 import FMU2Slave
from numpy.typing import NDArray

from wheelfmu.fmu import values as shared
from wheelfmu.fmu.driver import DISCARD, LAST_SUCCESSFUL_TIME, OK, TERMINATED, WARNING, FMU2Wheel
from wheelfmu.fmu.values import Fault

from .names import counters_of
from .plan import Status, Study

Array = NDArray[np.float64]
Result = dict[str, NDArray]
Values = Mapping[str, float]
# The fate of the wheel, its time [s], a row of samples at each time that is reached.
Run = tuple[Status, float, Array]
MARCH = "march.library"  # march.c, compiled (Dask would take a .so for a module), beside the FMU's modelDescription.xml
NO_ROWS = np.empty((0, 0))
NUMBERS = {"Real": float, "Integer": int, "Boolean": int}
_turn = Lock()  # a worker's threads take turns at the instance
# Words of the FMU's message, for each end of a run.
ENDINGS = {
    "lies flat": Status.flat,
    "lifted off": Status.lifted_off,
    "needs a friction coefficient": Status.grip,
    "jams": Status.jammed,
}


class FMU2Raising(FMU2Wheel):
    """An instance that raises FMICallException where a call fails."""

    _call = FMU2Slave._call


class Instance:
    """The only instance of a worker."""

    def __init__(self, folder: str) -> None:
        self.fmu = FMU2Raising(folder, read_model_description(folder, validate=False)).new()
        self.variables = self.fmu.variables
        self.counters = counters_of(self.variables)
        self.typed = cache(self._typed)
        self._march = CDLL(str(Path(folder) / MARCH)).march

    def said(self) -> str:
        """The messages since the start of the run."""
        return " ".join(message.text for message in self.fmu.messages if message.status != OK)

    def _typed(self, names: tuple[str, ...]) -> list[tuple[str, list[str], list[int]]]:
        """For each type among the names: the type, the names and their value references."""
        of = {kind: [name for name in names if self.variables[name].type == kind] for kind in NUMBERS}
        return [(kind, mine, self.fmu.refer(*mine)) for kind, mine in of.items() if mine]

    def set(self, values: Values) -> None:
        for kind, names, references in self.typed(tuple(values)):
            getattr(self.fmu, f"set{kind}")(references, [NUMBERS[kind](values[name]) for name in names])

    def get(self, names: tuple[str, ...]) -> dict[str, float]:
        found: dict[str, float] = {}
        for kind, mine, references in self.typed(names):
            found |= zip(mine, getattr(self.fmu, f"get{kind}")(references), strict=True)
        return found

    def begin(self, values: Values, tolerance: float | None) -> None:
        """To t = 0; FMICallException if the FMU refuses a value."""
        self.fmu.messages = []
        try:
            self.fmu.reset()
        except FMICallException:  # after fmi2Fatal the standard allows no further call to an instance
            self.fmu = self.fmu.new()
        self.set(values)
        self.fmu.setupExperiment(tolerance)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def march(self, times: Array, names: Sequence[str]) -> Run:
        """Steps along the times from times[0], the present one, and reads these Real variables at each."""
        rows, reached = np.empty((len(times), len(names))), c_size_t()
        references = (c_uint * len(names))(*self.fmu.refer(*names))
        calls = self.fmu.dll.fmi2DoStep, self.fmu.dll.fmi2GetReal, c_void_p(self.fmu.component)
        way = times.ctypes, c_size_t(len(times)), references, c_size_t(len(names)), rows.ctypes, byref(reached)
        status = self._march(*calls, *way)
        end, fate = times[max(reached.value, 1) - 1], Status.reached if status <= WARNING else Status.failed
        if status == DISCARD:
            end = self.fmu.status(LAST_SUCCESSFUL_TIME)
            if self.fmu.status(TERMINATED):
                fate = next((fate for words, fate in ENDINGS.items() if words in self.said()), fate)
        return fate, end, rows[: reached.value]

    def wheel(self, values: Values, study: Study, times: Array) -> dict[str, object]:
        """All results of one wheel: NaN, of a counter -1, where the run has none."""
        begin, last = perf_counter(), {}
        measured = [name for measure in study.parsed.values() for name in measure.variables]
        try:
            self.begin(values, study.tolerance)
            status, end, rows = self.march(times, study.sampled)
        except FMICallException:
            status, end, rows = Status.refused, np.nan, NO_ROWS
        else:
            with suppress(FMICallException):  # an instance that failed may be unable to answer
                last = self.get(tuple(dict.fromkeys([*self.counters, *study.sampled, *measured])))
        outside = "A value is outside its limits." * (status == Status.refused)
        result = {"status": status, "message": self.said() or outside, "end_time": end}
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
    """The results of wheels whose values by name are broadcast against each other, in their common shape.

    Of the study only what all its wheels have in common is used.
    """
    columns, times = np.broadcast_arrays(*points.values()), np.array(study.times)
    starts = zip(*(column.ravel().tolist() for column in columns), strict=True)
    wheels = [fmu.wheel(study.values | dict(zip(points, start, strict=True)), study, times) for start in starts]

    def column(name: str) -> NDArray:
        values = np.array([wheel[name] for wheel in wheels], "T" if name == "message" else None)
        return values.reshape(*columns[0].shape, *values.shape[1:])

    return {name: column(name) for name in wheels[0]}


def run_chunk(upload: str, study: Study, points: Mapping[str, Array]) -> Result:
    """The results of a chunk of wheels; upload: name of the uploaded file; study: without its axes."""
    with _turn:
        return run_block(instance(upload), study, points)


@cache
def instance(upload: str) -> Instance:
    """The only one of a study in this process, unpacked in the worker's own folder, which Dask removes."""
    package = Path(get_worker().local_directory) / upload
    shutil.unpack_archive(package, package.with_suffix(""))
    return Instance(str(package.with_suffix("")))


# A package as a worker gets it: some of its parts, and where the whole is installed also that.
JOINED = "from pkgutil import extend_path\n\n__path__ = extend_path(__path__, __name__)\n"


def pack(fmu: str | Path, path: Path) -> Path:
    """Writes the file to be uploaded: the FMU, with this package's sources and the loop over the steps, compiled."""
    library, here = path.with_name(MARCH), Path(__file__).parent
    if not shutil.which("cc"):
        raise Fault("A study needs a C compiler, cc, on the machine where it is started.")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", here / "march.c", "-o", library], check=True)
    shutil.copy(fmu, path)
    with zipfile.ZipFile(path, "a") as package:
        package.write(library, MARCH)
        for name, folder in {"lab/studies": here, "wheelfmu/fmu": Path(shared.__file__).parent}.items():
            package.writestr(f"{name.partition('/')[0]}/__init__.py", JOINED)
            for source in folder.glob("*.py"):
                joined = f"\n{JOINED}" * (source.name == "__init__.py")
                package.writestr(f"{name}/{source.name}", source.read_text(encoding="utf-8") + joined)
    return path
