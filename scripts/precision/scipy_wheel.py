"""SciPy's solvers on the product's C right-hand side, and the friction a scientist writes first: sign(omega_z) or
tanh(omega_z / 1e-3 rad/s) inside the right-hand side, no events."""

from __future__ import annotations

from typing import Any

import numpy as np
from c_rhs import Problem
from scipy.integrate import solve_ivp
from support import equations as eq

MOST_EVALUATIONS = 100_000
NAIVE_WIDTH = 1e-3  # rad/s


class Solver:
    def __init__(self, request: dict[str, Any], grid: np.ndarray) -> None:
        self.problem, self.grid = Problem(request), grid
        self.method, self.tolerance, self.naive = request["solver"], request["tolerance"], request.get("naive")
        if self.naive == "tanh":
            self.problem.scene.friction = eq.Friction(eq.REGULARIZED, 0, NAIVE_WIDTH)
        self.result: Any = None

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        if self.problem.count >= MOST_EVALUATIONS:
            raise RuntimeError(f"{MOST_EVALUATIONS} right-hand sides, only t = {t:.4g} s reached")
        if self.naive == "sign":
            self.problem.scene.friction.sigma = float(np.sign(y[3]))
        return self.problem.rhs(t, y)

    def solve(self) -> None:
        self.problem.count = 0
        span = (0.0, float(self.grid[-1]))
        limits = {"rtol": max(self.tolerance, 3e-14), "atol": self.tolerance}
        self.result = solve_ivp(self.rhs, span, self.problem.y_0, self.method, self.grid, **limits)
        if not self.result.success:
            raise RuntimeError(self.result.message)

    def rows(self) -> np.ndarray:
        return self.problem.outputs(self.result.y.T)

    def counts(self) -> dict[str, int]:
        return {"evaluations": self.problem.count}


def prepare(request: dict[str, Any], grid: np.ndarray) -> Solver:
    return Solver(request, grid)
