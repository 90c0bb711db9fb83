"""The reports' own machine code, compiled into build/report: the C master (master.c) and DOP853 in C++ (dop853.cpp)."""

from __future__ import annotations

import ctypes
import re
import subprocess
from ctypes import c_double, c_int, c_void_p
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import fmpy
import numpy as np
from cffi import FFI
from numpy.typing import NDArray
from support.driver import CHOICES, COUNTERS, HEADLINE, WARNING, Values
from support.motion import Library
from support.paths import ROOT, build_folder

from .page import cached

Array = NDArray[np.float64]
ffi = FFI()
NATIVE = Path(__file__).with_name("native")
MOST_RUNS = 20_000
LEAST_RUNS, LONG = 5, 0.1  # runs; s: the best of two or three runs of some milliseconds still scatters by a quarter


def work_folder() -> Path:
    folder = ROOT / "build" / "report"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def compile_shared(name: str, compiler: str, *flags: str | Path) -> str:
    """The shared library of native/`name`, compiled for this process alone."""
    target = work_folder() / f"{Path(name).stem}.so"
    command = [compiler, "-shared", "-fPIC", "-Wall", "-Wextra", *flags, NATIVE / name, "-o", target]
    link = ["-L", build_folder(), f"-Wl,-rpath,{build_folder()}", "-lwheel_equations", "-ldl"]
    target.unlink(missing_ok=True)  # a library that is still loaded somewhere keeps its file
    subprocess.run([*map(str, command), *map(str, link)], check=True)
    return str(target)


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
        """Median seconds to create, initialize and free."""
        return float(np.median(self.costs[:, 0] + self.costs[:, 2]))


class Master:
    """The library of an unpacked wheel.fmu, driven from C."""

    def __init__(self, library: Library) -> None:
        self.guid = library.description.guid.encode()
        self.variables = {v.name: v for v in library.description.modelVariables}
        self.code = master_code()
        (file,) = Path(library.folder).glob("binaries/*/*.so")
        self.fmu = self.code.load_fmu(str(file).encode())

    def references(self, names: tuple[str, ...]) -> object:
        return ffi.new("unsigned[]", [self.variables[name].valueReference for name in names] or 1)

    def start_value(self, name: str, value: float | str | bool) -> tuple[int, int, float]:
        kinds = {"Real": "r", "Boolean": "b"}
        choice = CHOICES[name][value] if isinstance(value, str) else value
        return ord(kinds.get(self.variables[name].type, "i")), self.variables[name].valueReference, float(choice)

    def options(self, task: Task) -> tuple[object, dict[str, object]]:
        """The run for the master, and what it points to."""
        starts = [self.start_value(name, value) for name, value in task.values.items()]
        names = {"output": task.outputs, "counter": COUNTERS, "input": task.inputs}
        pointers = {"guid": ffi.new("char[]", self.guid), "starts": ffi.new("Start[]", starts or 1)}
        pointers |= {f"{kind}s": self.references(of) for kind, of in names.items()}
        counts = {"start_count": len(starts)} | {f"{kind}_count": len(of) for kind, of in names.items()}
        if task.table is not None:
            assert task.table.shape[2] == len(task.inputs)
            pointers["table"] = ffi.from_buffer("double[]", np.ascontiguousarray(task.table))
            counts["orders"] = task.table.shape[1] - 1
        steps = {"tolerance": task.tolerance or 0.0, "step": task.step, "steps": task.steps}
        return ffi.new("Run *", {**pointers, **counts, **steps}), pointers

    def run(self, task: Task, seconds: float = 0.0) -> Timing:
        """Repetitions for `seconds`, but not fewer than LEAST_RUNS of a run that is not very long, then one run for its
        outputs and single steps."""
        (run, _pointers), counters, cost = self.options(task), ffi.new("int[]", len(COUNTERS)), np.zeros(4)
        rows, paces = np.zeros((task.steps + 1, len(task.outputs))), np.zeros(task.steps)
        places = [ffi.from_buffer("double[]", array) for array in (rows, paces, cost)]
        costs, spent = [], 0.0
        while len(costs) < MOST_RUNS and (spent < seconds or (seconds and len(costs) < LEAST_RUNS and spent < LONG)):
            if self.code.solve(self.fmu, run, ffi.NULL, ffi.NULL, ffi.NULL, places[2]).status > WARNING:
                break
            costs.append(cost.copy())
            spent += cost[:3].sum()
        done = self.code.solve(self.fmu, run, *places[:2], counters, places[2])
        counted = dict(zip(COUNTERS, counters, strict=True))
        return Timing(done.status, done.steps, rows, paces, counted, np.array(costs or [cost]))


@cache
def master_code() -> object:
    """The master, and what its source says of it."""
    source = (NATIVE / "master.c").read_text()
    declared = re.findall(r"^typedef struct \w+ \{.*?^\} \w+;", source, re.MULTILINE | re.DOTALL)
    declared += [f"{head};" for head in re.findall(r"^(?:Fmu\*|Outcome) \w+\([^{]*\)", source, re.MULTILINE)]
    ffi.cdef("typedef unsigned fmi2ValueReference; typedef struct Fmu Fmu;" + "".join(declared))
    folders = [f"-I{Path(fmpy.__file__).parent / 'c-code'}", f"-I{ROOT / 'tests' / 'support'}"]
    return ffi.dlopen(compile_shared("master.c", cached("CMAKE_C_COMPILER"), "-std=gnu11", "-O2", *folders))


@cache
def dop853_code() -> ctypes.CDLL:
    source = ROOT / "fmu-src"
    flags = ["-std=c++20", "-O3", "-fno-math-errno", "-Wno-missing-field-initializers"]
    eigen = Path(cached("Eigen3_DIR")).parents[2] / "include" / "eigen3"  # as installed
    folders = [f"-I{path}" for path in (source / "equations", source / "solver", eigen)]
    code = ctypes.CDLL(compile_shared("dop853.cpp", cached("CMAKE_CXX_COMPILER"), *flags, *folders))
    code.dop853.argtypes = [c_void_p, c_void_p, c_double, c_double, c_int, c_void_p, c_void_p]
    return code
