"""Machine code that the reports time: the C driver of tools/wheelfmu/release (CMakeLists.txt)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from cffi import FFI

from wheelfmu.fmu.building import build_target
from wheelfmu.fmu.driver import COUNTERS, HEADLINE, Values
from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import SINES

from .truth import Array, Solve

ffi = FFI()
DRIVER = ROOT / "tools" / "wheelfmu" / "release" / "driver.c"
HEAP = "typedef struct { size_t sizes[10]; } Heap; Heap mallinfo2(void);"  # glibc's


@cache
def timed() -> str:
    """The library with the driver."""
    return str(build_target("wheel_timed") / "lab" / "reports" / "libwheel_timed.so")


@cache
def driver_code() -> Any:
    """The driver, with what its source declares."""
    source = DRIVER.read_text()
    declared = re.findall(r"^typedef struct \w+ \{.*?^\} \w+;", source, re.MULTILINE | re.DOTALL)
    declared += [f"{head};" for head in re.findall(r"^(?:void|double|Outcome) \w+\([^{]*\)", source, re.MULTILINE)]
    ffi.cdef("typedef unsigned fmi2ValueReference; typedef void* fmi2Component;" + HEAP + "".join(declared))
    return ffi.dlopen(timed())


class Master:
    """The library of an unpacked wheel.fmu, stepped from C."""

    def __init__(self, library: Library) -> None:
        self.library, self.code, self.references = library, driver_code(), library.loaded.references
        (file,) = Path(library.folder).glob("binaries/*/*.so")
        self.code.load(str(file).encode())

    def made(
        self,
        values: Values,
        step: float,
        steps: int,
        tolerance: float | None = None,
        table: Array | None = None,
        varied: Iterable[str] = SINES,
    ) -> Solve:
        """A run, ready to be repeated: its seconds, initial headline outputs and those after each step, counters.

        table: steps x (orders + 1) x the inputs that are varied. With paces, they get the seconds of each step."""
        inputs = () if table is None else tuple(varied)
        table = np.zeros((steps, 1, 0)) if table is None else np.ascontiguousarray(table)
        rows = np.zeros((steps + 1, len(HEADLINE)))
        references = [ffi.new("unsigned[]", [self.references[name] for name in of]) for of in (inputs, HEADLINE)]
        given, out = (ffi.from_buffer("double[]", array) for array in (table, rows[1:]))
        sizes = (len(inputs), len(HEADLINE), table.shape[1] - 1)

        def solve(paces: Array | None = None) -> tuple[float, Array, dict[str, int]]:
            run = ffi.new("Run *", (*references, *sizes, given, step, steps))
            each = ffi.NULL if paces is None else ffi.from_buffer("double[]", paces)
            with self.library.wheel() as wheel:
                wheel.start(tolerance=tolerance, **values)
                rows[0] = wheel.reader(HEADLINE)()
                done = self.code.march(ffi.cast("void *", wheel.component), run, out, each)
                counts = {name[2:]: int(value) for name, value in zip(COUNTERS, wheel.get(*COUNTERS), strict=True)}
            if done.steps < steps:
                raise RuntimeError(f"stopped after {done.steps} of {steps} steps")
            return done.seconds, rows, counts

        return solve

    def empty_call(self) -> float:
        """Seconds of an FMI call that does nothing."""
        with self.library.wheel() as wheel:
            wheel.start()
            component = ffi.cast("void *", wheel.component)
            return min(self.code.empty_call(component, 10_000) for _ in range(20))

    def life(self, scene: int) -> float:
        """Seconds in which an instance is created, initialized and freed."""
        return self.code.life(self.library.description.guid.encode(), scene)

    def bytes_in_use(self) -> int:
        sizes = self.code.mallinfo2().sizes
        return sizes[7] + sizes[4]  # uordblks, hblkhd
