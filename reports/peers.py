"""Other solvers on the product's right-hand side: DOP853 in C++, SciPy, numbalsoda; and heyoka, which writes its own.

Each is made for a scene, a tolerance and a number of grid points; `solve` gives the seconds that count, `rows` the
headline outputs on the grid. What a solver cannot do is a RuntimeError or an ImportError that says so.
"""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable
from ctypes import addressof, byref, c_long, c_void_p
from dataclasses import asdict
from time import perf_counter
from typing import Any, Protocol

import numpy as np
from scipy.integrate import solve_ivp
from support import equations as eq
from support.scenes import Scene

from .native import Array, dop853_code

MOST_EVALUATIONS = 60_000  # of a right-hand side through ctypes
NAIVE_WIDTH = 1e-3  # rad/s


class Peer(Protocol):
    def solve(self) -> float: ...
    def rows(self) -> Array: ...
    def counts(self) -> dict[str, int]: ...


def regularized(scene: Scene) -> bool:
    return scene.start.get("friction_law") == "regularized"


def width(scene: Scene) -> float:
    return float(scene.start.get("omega_s", 1e-3))


class Problem:
    """The scene for the C header: its state at the start, its right-hand side."""

    def __init__(self, scene: Scene) -> None:
        constants = asdict(scene.wheel)
        self.wheel = eq.paper_wheel(**{name: constants[name] for name, _ in eq.Parameters._fields_})
        kind = eq.FRICTIONLESS
        if self.wheel.s > 0:
            kind = eq.REGULARIZED if regularized(scene) else eq.ROLLING
        self.scene = eq.scene(self.wheel, kind, omega_s=width(scene))
        motion = asdict(scene.motion)
        start = eq.Motion(**{name: motion[name] for name, _ in eq.Motion._fields_})
        self.y_0 = eq.start(eq.REDUCED, self.wheel, start)

    def outputs(self, states: Array) -> Array:
        rows = [eq.kinematics(eq.REDUCED, self.wheel, np.ascontiguousarray(y)) for y in states]
        return np.array([[k.X_O, k.theta, k.phi_dot, k.psi_dot] for k in rows])


class InCpp:
    """DOP853, hand-inlined (native/dop853.cpp)."""

    def __init__(self, scene: Scene, tolerance: float, points: int) -> None:
        self.problem, self.found = Problem(scene), np.zeros((points, 4))
        self.numbers = (c_long * 3)()
        start, rows = (array.ctypes.data_as(c_void_p) for array in (self.problem.y_0, self.found))
        self.arguments = (byref(self.problem.scene), start, tolerance, scene.duration, points, rows, self.numbers)
        self.run = dop853_code().dop853

    def solve(self) -> float:
        begin = perf_counter()
        reached = self.run(*self.arguments)
        spent = perf_counter() - begin
        if not reached:
            raise RuntimeError("did not reach the end")
        return spent

    def rows(self) -> Array:
        return self.found

    def counts(self) -> dict[str, int]:
        return dict(zip(("steps", "rhs", "events"), self.numbers, strict=True))


class InScipy:
    """solve_ivp; the friction a scientist writes first, sign() or tanh() inside the right-hand side, has no events."""

    def __init__(self, scene: Scene, tolerance: float, points: int, method: str, naive: str = "") -> None:
        self.problem, self.method, self.naive = Problem(scene), method, naive
        self.grid = np.linspace(0, scene.duration, points)
        self.limits = {"rtol": max(tolerance, 3e-14), "atol": tolerance}
        if naive == "tanh":
            self.problem.scene.friction = eq.Friction(eq.REGULARIZED, 0, NAIVE_WIDTH)
        self.y, self.y_dot = np.zeros_like(self.problem.y_0), np.zeros_like(self.problem.y_0)
        places = (addressof(self.problem.scene), self.y.ctypes.data, self.y_dot.ctypes.data)
        derivative = ctypes.cast(eq.REDUCED.derivative, c_void_p).value
        call = ctypes.CFUNCTYPE(ctypes.c_double, c_void_p, c_void_p, c_void_p)(derivative)
        self.evaluate: Callable[[], float] = lambda: call(*places)

    def rhs(self, t: float, y: Array) -> Array:
        self.count += 1
        if self.count > MOST_EVALUATIONS:
            raise RuntimeError(f"{MOST_EVALUATIONS} right-hand sides, only t = {t:.4g} s reached")
        if self.naive == "sign":
            self.problem.scene.friction.sigma = float(np.sign(y[3]))
        self.y[:] = y
        self.evaluate()
        return self.y_dot.copy()

    def solve(self) -> float:
        self.count, begin = 0, perf_counter()
        span = (0.0, float(self.grid[-1]))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # of Radau's difference quotients
            self.result = solve_ivp(self.rhs, span, self.problem.y_0, self.method, self.grid, **self.limits)
        if not self.result.success:
            raise RuntimeError(self.result.message)
        return perf_counter() - begin

    def rows(self) -> Array:
        return self.problem.outputs(self.result.y.T)

    def counts(self) -> dict[str, int]:
        return {"rhs": self.count}


class InNumbalsoda:
    """LSODA and DOP853 of numbalsoda; no Python in the loop."""

    def __init__(self, scene: Scene, tolerance: float, points: int, method: str) -> None:
        import numbalsoda

        self.problem, self.grid, self.tolerance = Problem(scene), np.linspace(0, scene.duration, points), tolerance
        self.run, code = getattr(numbalsoda, method), dop853_code()
        self.rhs = ctypes.cast(code.wheel_rhs, c_void_p).value
        self.count = c_long.in_dll(code, "wheel_rhs_count")
        self.data = np.array([addressof(self.problem.scene)], dtype=np.uint64).view(np.float64)

    def solve(self) -> float:
        self.count.value, begin = 0, perf_counter()
        limits = {"rtol": self.tolerance, "atol": self.tolerance, "mxstep": 20_000}
        self.states, success = self.run(self.rhs, self.problem.y_0, self.grid, self.data, **limits)
        if not success:
            raise RuntimeError("the solver gave up")
        return perf_counter() - begin

    def rows(self) -> Array:
        return self.problem.outputs(self.states)

    def counts(self) -> dict[str, int]:
        return {"rhs": self.count.value}


def in_heyoka(scene: Scene, tolerance: float, points: int) -> Any:
    from . import heyoka_wheel

    if scene.wheel.J_x != scene.wheel.J_y:
        raise RuntimeError("written only for J_x = J_y")
    values: dict[str, float] = asdict(scene.wheel) | {f"{n}_start": v for n, v in asdict(scene.motion).items()}
    values |= {"omega_s": width(scene), "regularized": float(regularized(scene))}
    return heyoka_wheel.compiled(tuple(sorted(values.items())), scene.duration, points, tolerance)


def peers(scene: Scene) -> dict[str, Callable[[Scene, float, int], Peer]]:
    """Those that can solve the scene as it stands, by name; with exact friction, those that know no events naively."""
    found: dict[str, Callable[..., Peer]] = {"DOP853 C++": InCpp, "heyoka": in_heyoka}
    if scene.wheel.s > 0 and not regularized(scene):
        for naive in ("sign", "tanh"):
            for method in ("DOP853", "LSODA"):
                found[f"SciPy {method}, {naive}()"] = lambda *a, m=method, n=naive: InScipy(*a, m, n)
        return found
    for method in ("DOP853", "LSODA", "Radau"):
        found[f"SciPy {method}"] = lambda *a, m=method: InScipy(*a, m)
    for method in ("lsoda", "dop853"):
        found[f"numbalsoda {method}"] = lambda *a, m=method: InNumbalsoda(*a, m)
    return found
