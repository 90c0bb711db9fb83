"""The reports' own machine code, compiled into build/report: the C master (master.c) and DOP853 in C++ (dop853.cpp)."""

from __future__ import annotations

import ctypes
import subprocess
import zipfile
from ctypes import POINTER, Structure, byref, c_char_p, c_double, c_int, c_long, c_uint, c_void_p
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import fmpy
import numpy as np
from fmpy import read_model_description
from numpy.typing import NDArray
from support.driver import CHOICES, COUNTERS, HEADLINE, WARNING, Values
from support.paths import ROOT, build_folder

from .page import cached

Array = NDArray[np.float64]
NATIVE = Path(__file__).with_name("native")
MOST_RUNS = 20_000


def work_folder() -> Path:
    folder = ROOT / "build" / "report"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def compile_shared(name: str, compiler: str, *flags: str | Path) -> ctypes.CDLL:
    """The shared library of native/`name`, compiled for this process alone."""
    target = work_folder() / f"{Path(name).stem}.so"
    command = [compiler, "-shared", "-fPIC", "-Wall", "-Wextra", *flags, NATIVE / name, "-o", target]
    link = ["-L", build_folder(), f"-Wl,-rpath,{build_folder()}", "-lwheel_equations", "-ldl", "-lpthread"]
    target.unlink(missing_ok=True)  # a library that is still loaded somewhere keeps its file
    subprocess.run([*map(str, command), *map(str, link)], check=True)
    return ctypes.CDLL(str(target))


class StartValue(Structure):
    _fields_ = [("kind", c_int), ("variable", c_uint), ("value", c_double)]


class RunOptions(Structure):
    _fields_ = [
        *[("guid", c_char_p), ("starts", POINTER(StartValue)), ("start_count", c_int)],
        *[(name, POINTER(c_uint)) for name in ("outputs", "counters", "inputs")],
        *[(name, c_int) for name in ("output_count", "counter_count", "input_count", "orders")],
        *[("table", c_void_p), ("tolerance", c_double), ("step", c_double), ("steps", c_long)],
    ]


class Outcome(Structure):
    _fields_ = [("status", c_int), ("steps", c_long)]


@dataclass
class Timing:
    """One run. rows: outputs at start and after each step; start, run, end: seconds of each repetition."""

    status: int
    steps: int
    rows: Array
    counters: dict[str, int]
    times: Array = field(default_factory=lambda: np.zeros((0, 3)))

    @property
    def reached(self) -> bool:
        return self.status <= WARNING and self.steps == len(self.rows) - 1

    @property
    def best(self) -> float:
        return float(self.times[:, 1].min())

    @property
    def median(self) -> float:
        return float(np.median(self.times[:, 1]))

    @property
    def life(self) -> float:
        """Median seconds to create, initialise and free."""
        return float(np.median(self.times[:, 0] + self.times[:, 2]))


@dataclass(frozen=True)
class Task:
    """What the master is to run. inputs: names, and a table of steps x (orders + 1) x names."""

    values: Values = field(default_factory=dict)
    step: float = 0.1
    steps: int = 100
    tolerance: float | None = None
    outputs: tuple[str, ...] = HEADLINE
    inputs: tuple[str, ...] = ()
    table: Array | None = None


class Master:
    """The library out of a wheel.fmu, driven from C."""

    def __init__(self, fmu: Path, name: str = "wheel") -> None:
        description = read_model_description(str(fmu))
        self.guid = description.guid.encode()
        self.variables = {v.name: v for v in description.modelVariables}
        self.file = work_folder() / f"{name}.so"
        self.file.unlink(missing_ok=True)
        with zipfile.ZipFile(fmu) as archive:
            member = next(n for n in archive.namelist() if n.startswith("binaries/") and n.endswith(".so"))
            self.file.write_bytes(archive.read(member))
        self.code = master_code()
        self.fmu = c_void_p(self.code.load_fmu(str(self.file).encode()))

    def references(self, names: tuple[str, ...]) -> ctypes.Array:
        return (c_uint * max(1, len(names)))(*(self.variables[name].valueReference for name in names))

    def start_value(self, name: str, value: float | str | bool) -> StartValue:
        kinds = {"Real": "r", "Boolean": "b"}
        choice = CHOICES[name][value] if isinstance(value, str) else value
        kind = ord(kinds.get(self.variables[name].type, "i"))
        return StartValue(kind, self.variables[name].valueReference, float(choice))

    def options(self, task: Task) -> RunOptions:
        starts = [self.start_value(name, value) for name, value in task.values.items()]
        run = RunOptions(guid=self.guid, start_count=len(starts), step=task.step, steps=task.steps)
        run.starts = (StartValue * max(1, len(starts)))(*starts)
        run.outputs, run.output_count = self.references(task.outputs), len(task.outputs)
        run.counters, run.counter_count = self.references(COUNTERS), len(COUNTERS)
        run.inputs, run.input_count = self.references(task.inputs), len(task.inputs)
        run.tolerance = task.tolerance or 0.0
        if task.table is not None:
            run.kept = table = np.ascontiguousarray(task.table)
            run.table, run.orders = table.ctypes.data, table.shape[1] - 1
        return run

    def run(self, task: Task, seconds: float = 0.0) -> Timing:
        """One run for its outputs, and repetitions for `seconds` to time it."""
        run, counters = self.options(task), (c_int * len(COUNTERS))()
        rows = np.zeros((task.steps + 1, len(task.outputs)))
        done = self.code.solve(self.fmu, byref(run), rows.ctypes.data_as(c_void_p), counters)
        found = Timing(done.status, done.steps, rows, dict(zip(COUNTERS, counters, strict=True)))
        if seconds > 0 and found.reached:
            times = np.zeros((MOST_RUNS, 3))
            count = self.code.measure(self.fmu, byref(run), seconds, MOST_RUNS, times.ctypes.data_as(c_void_p))
            found.times = times[:count]
        return found

    def pace(self, task: Task) -> Array:
        """Seconds of each single communication step."""
        times = np.zeros(task.steps)
        done = self.code.pace(self.fmu, byref(self.options(task)), times.ctypes.data_as(c_void_p))
        if done.steps != task.steps:
            raise RuntimeError(f"The run stopped after {done.steps} of {task.steps} steps.")
        return times

    def crowd(self, task: Task, count: int) -> dict[str, float]:
        """Per instance of `count` in one process: bytes and seconds; how many ended with other bits than one alone."""
        alone, out = np.ascontiguousarray(self.run(task).rows[-1]), np.zeros(4)
        pointers = [array.ctypes.data_as(c_void_p) for array in (alone, out)]
        different = self.code.run_crowd(self.fmu, byref(self.options(task)), count, *pointers)
        return dict(zip(("bytes", "start", "run", "end"), out.tolist(), strict=True)) | {"different": different}


@cache
def master_code() -> ctypes.CDLL:
    headers = Path(fmpy.__file__).parent / "c-code"
    support = ROOT / "tests" / "support"
    code = compile_shared("master.c", cached("CMAKE_C_COMPILER"), "-std=gnu11", "-O2", f"-I{headers}", f"-I{support}")
    code.load_fmu.restype = c_void_p
    code.solve.restype = code.pace.restype = Outcome
    code.measure.restype = code.run_crowd.restype = c_long
    code.measure.argtypes = [c_void_p, c_void_p, c_double, c_long, c_void_p]
    code.run_crowd.argtypes = [c_void_p, c_void_p, c_long, c_void_p, c_void_p]
    return code


@cache
def dop853_code() -> ctypes.CDLL:
    source = ROOT / "fmu-src"
    flags = ["-std=c++20", "-O3", "-fno-math-errno", "-Wno-missing-field-initializers"]
    folders = [f"-I{source / name}" for name in ("equations", "solver")]
    code = compile_shared("dop853.cpp", cached("CMAKE_CXX_COMPILER"), *flags, *folders)
    code.dop853.argtypes = [c_void_p, c_void_p, c_double, c_double, c_int, c_void_p, c_void_p]
    return code
