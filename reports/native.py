"""The reports' own machine code, compiled into build/report: the C master (master.c) and DOP853 in C++ (dop853.cpp)."""

from __future__ import annotations

import ctypes
import subprocess
from ctypes import POINTER, Structure, byref, c_char_p, c_double, c_int, c_long, c_uint, c_void_p
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import fmpy
import numpy as np
from numpy.typing import NDArray
from support.driver import CHOICES, COUNTERS, HEADLINE, WARNING, Values
from support.motion import Library
from support.paths import ROOT, build_folder

from .page import cached

Array = NDArray[np.float64]
NATIVE = Path(__file__).with_name("native")
MOST_RUNS = 20_000
LEAST_RUNS, LONG = 5, 0.1  # runs; s: the best of two or three runs of some milliseconds still scatters by a quarter


def work_folder() -> Path:
    folder = ROOT / "build" / "report"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def compile_shared(name: str, compiler: str, *flags: str | Path) -> ctypes.CDLL:
    """The shared library of native/`name`, compiled for this process alone."""
    target = work_folder() / f"{Path(name).stem}.so"
    command = [compiler, "-shared", "-fPIC", "-Wall", "-Wextra", *flags, NATIVE / name, "-o", target]
    link = ["-L", build_folder(), f"-Wl,-rpath,{build_folder()}", "-lwheel_equations", "-ldl"]
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


@dataclass
class Timing:
    """rows: outputs at start and after each step; paces: seconds of each step; costs, for each repetition: seconds to
    create and initialise, to step, to free; bytes."""

    status: int
    steps: int
    rows: Array
    paces: Array
    counters: dict[str, int]
    costs: Array

    @property
    def reached(self) -> bool:
        return self.status <= WARNING and self.steps == len(self.paces)

    @property
    def best(self) -> float:
        return float(self.costs[:, 1].min())

    @property
    def life(self) -> float:
        """Median seconds to create, initialise and free."""
        return float(np.median(self.costs[:, 0] + self.costs[:, 2]))


class Master:
    """The library of an unpacked wheel.fmu, driven from C."""

    def __init__(self, library: Library) -> None:
        self.guid = library.description.guid.encode()
        self.variables = {v.name: v for v in library.description.modelVariables}
        self.code = master_code()
        (file,) = Path(library.folder).glob("binaries/*/*.so")
        self.fmu = c_void_p(self.code.load_fmu(str(file).encode()))

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
            assert table.shape[2] == len(task.inputs)
            run.table, run.orders = table.ctypes.data, table.shape[1] - 1
        return run

    def run(self, task: Task, seconds: float = 0.0) -> Timing:
        """Repetitions for `seconds`, but not fewer than LEAST_RUNS of a run that is not very long, then one run for its
        outputs and single steps."""
        run, counters, cost = self.options(task), (c_int * len(COUNTERS))(), np.zeros(4)
        rows, paces = np.zeros((task.steps + 1, len(task.outputs))), np.zeros(task.steps)
        places = [array.ctypes.data_as(c_void_p) for array in (rows, paces, cost)]
        costs, spent = [], 0.0
        while len(costs) < MOST_RUNS and (spent < seconds or (seconds and len(costs) < LEAST_RUNS and spent < LONG)):
            if self.code.solve(self.fmu, byref(run), None, None, None, places[2]).status > WARNING:
                break
            costs.append(cost.copy())
            spent += cost[:3].sum()
        done = self.code.solve(self.fmu, byref(run), *places[:2], counters, places[2])
        counted = dict(zip(COUNTERS, counters, strict=True))
        return Timing(done.status, done.steps, rows, paces, counted, np.array(costs or [cost]))


@cache
def master_code() -> ctypes.CDLL:
    headers = Path(fmpy.__file__).parent / "c-code"
    support = ROOT / "tests" / "support"
    code = compile_shared("master.c", cached("CMAKE_C_COMPILER"), "-std=gnu11", "-O2", f"-I{headers}", f"-I{support}")
    code.load_fmu.restype, code.solve.restype = c_void_p, Outcome
    return code


@cache
def dop853_code() -> ctypes.CDLL:
    source = ROOT / "fmu-src"
    flags = ["-std=c++20", "-O3", "-fno-math-errno", "-Wno-missing-field-initializers"]
    eigen = Path(cached("Eigen3_DIR")).parents[2] / "include" / "eigen3"  # as installed
    folders = [f"-I{path}" for path in (source / "equations", source / "solver", eigen)]
    code = compile_shared("dop853.cpp", cached("CMAKE_CXX_COMPILER"), *flags, *folders)
    code.dop853.argtypes = [c_void_p, c_void_p, c_double, c_double, c_int, c_void_p, c_void_p]
    return code
