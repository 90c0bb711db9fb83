"""numbalsoda's LSODA and DOP853 on the product's C right-hand side (scripts/bench/rhs.c), no Python in the loop."""

from __future__ import annotations

import ctypes
import os
from typing import Any

import numbalsoda
import numpy as np
from c_rhs import Problem

SHIM = ctypes.CDLL(os.environ["WHEEL_RHS"])
COUNT = ctypes.c_long.in_dll(SHIM, "wheel_rhs_count")
ADDRESS = ctypes.cast(SHIM.wheel_rhs, ctypes.c_void_p).value


class Solver:
    def __init__(self, request: dict[str, Any], grid: np.ndarray) -> None:
        self.problem, self.grid, self.tolerance = Problem(request), grid, request["tolerance"]
        self.run = numbalsoda.lsoda if request["solver"] == "numbalsoda_lsoda" else numbalsoda.dop853
        pointers = [self.problem.scene_address, ctypes.addressof(self.problem.formulation)]
        self.data = np.array(pointers, dtype=np.uint64).view(np.float64)
        self.solve()  # compiles

    def solve(self) -> None:
        COUNT.value = 0
        self.states, success = self.run(
            ADDRESS, self.problem.y_0, self.grid, self.data, rtol=self.tolerance, atol=self.tolerance, mxstep=20_000
        )
        if not success:
            raise RuntimeError("the solver gave up")

    def rows(self) -> np.ndarray:
        return self.problem.outputs(self.states)

    def counts(self) -> dict[str, int]:
        return {"evaluations": COUNT.value}


def prepare(request: dict[str, Any], grid: np.ndarray) -> Solver:
    return Solver(request, grid)
