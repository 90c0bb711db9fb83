"""Other solvers on the product's right-hand side: DOP853 in C++, SciPy, numbalsoda; and heyoka, which writes its own.

Each is made for a scene, a tolerance and a number of grid points. What a solver cannot do is a RuntimeError or an
ImportError with its reason.
"""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Callable
from ctypes import addressof, byref, c_long, c_void_p
from dataclasses import asdict
from functools import partial
from time import perf_counter

import numpy as np
from scipy.integrate import solve_ivp
from support import equations as eq
from support.driver import HEADLINE
from support.scenes import Scene

from .native import Solve, dop853_code
from .truth import Array, headline_of

MOST_EVALUATIONS = 60_000  # of a right-hand side through ctypes
NAIVE_WIDTH = 1e-3  # rad/s
CPP, HEYOKA = "DOP853 C++", "heyoka"


def width(scene: Scene) -> float:
    """Of the regularized law, rad/s; 0: the law is exact."""
    return float(scene.start.get("omega_s", 1e-3)) if scene.start.get("friction_law") == "regularized" else 0.0


class Problem:
    """The scene for the C header: its state at the start, its right-hand side."""

    def __init__(self, scene: Scene) -> None:
        constants, motion = asdict(scene.wheel), asdict(scene.motion)
        known = {name for name, _ in eq.Parameters._fields_}
        wheel = eq.paper_wheel(**{name: value for name, value in constants.items() if name in known})
        kind = eq.FRICTIONLESS if wheel.s == 0 else eq.REGULARIZED if width(scene) else eq.ROLLING
        self.scene = eq.scene(wheel, kind, omega_s=width(scene) or 1e-3)
        self.y_0 = eq.start(eq.REDUCED, wheel, eq.Motion(**{name: motion[name] for name, _ in eq.Motion._fields_}))


def in_cpp(scene: Scene, tolerance: float, points: int) -> Solve:
    """DOP853, hand-inlined (dop853.cpp)."""
    problem, rows, counts = Problem(scene), np.zeros((points, 4)), (c_long * 3)()
    start, out = (array.ctypes.data_as(c_void_p) for array in (problem.y_0, rows))
    arguments = (byref(problem.scene), start, tolerance, scene.duration, points, out, counts)
    run = dop853_code().dop853

    def solve() -> tuple[float, Array, dict[str, int]]:
        begin = perf_counter()
        reached = run(*arguments)
        spent = perf_counter() - begin
        if not reached:
            raise RuntimeError("did not reach the end")
        return spent, rows, dict(zip(("steps", "rhs", "events"), counts, strict=True))

    return solve


def in_scipy(scene: Scene, tolerance: float, points: int, method: str, naive: str = "") -> Solve:
    """solve_ivp; the friction a scientist writes first, sign() or tanh() inside the right-hand side, has no events."""
    problem, grid, count = Problem(scene), np.linspace(0, scene.duration, points), 0
    if naive == "tanh":
        problem.scene.friction = eq.Friction(eq.REGULARIZED, 0, NAIVE_WIDTH)
    y, y_dot = np.zeros_like(problem.y_0), np.zeros_like(problem.y_0)
    places = (addressof(problem.scene), y.ctypes.data, y_dot.ctypes.data)
    derivative = ctypes.cast(eq.REDUCED.derivative, c_void_p).value
    evaluate = ctypes.CFUNCTYPE(ctypes.c_double, c_void_p, c_void_p, c_void_p)(derivative)

    def rhs(t: float, state: Array) -> Array:
        nonlocal count
        count += 1
        if count > MOST_EVALUATIONS:
            raise RuntimeError(f"{MOST_EVALUATIONS} right-hand sides, only t = {t:.4g} s reached")
        if naive == "sign":
            problem.scene.friction.sigma = float(np.sign(state[3]))
        y[:] = state
        evaluate(*places)
        return y_dot.copy()

    def solve() -> tuple[float, Array, dict[str, int]]:
        nonlocal count
        count, begin = 0, perf_counter()
        limits = {"rtol": max(tolerance, 3e-14), "atol": tolerance}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # of Radau's difference quotients
            found = solve_ivp(rhs, (0.0, scene.duration), problem.y_0, method, grid, **limits)
        if not found.success:
            raise RuntimeError(found.message)
        return perf_counter() - begin, headline_of(found.y.T), {"rhs": count}

    return solve


def in_numbalsoda(scene: Scene, tolerance: float, points: int, method: str) -> Solve:
    """LSODA and DOP853 of numbalsoda; no Python in the loop."""
    import numbalsoda

    problem, grid, code = Problem(scene), np.linspace(0, scene.duration, points), dop853_code()
    run, count = getattr(numbalsoda, method), c_long.in_dll(code, "wheel_rhs_count")
    rhs = ctypes.cast(code.wheel_rhs, c_void_p).value
    data = np.array([addressof(problem.scene)], dtype=np.uint64).view(np.float64)

    def solve() -> tuple[float, Array, dict[str, int]]:
        count.value, begin = 0, perf_counter()
        states, success = run(rhs, problem.y_0, grid, data, rtol=tolerance, atol=tolerance, mxstep=20_000)
        if not success:
            raise RuntimeError("the solver gave up")
        return perf_counter() - begin, headline_of(states), {"rhs": count.value}

    return solve


def in_heyoka(scene: Scene, tolerance: float, points: int) -> Solve:
    from . import taylor

    wheel = taylor.Wheel(asdict(scene.wheel) | asdict(scene.motion), "angles", tolerance, omega_s=width(scene))
    grid, shown = np.linspace(0, scene.duration, points), [taylor.OUTPUTS.index(name) for name in HEADLINE]

    def solve() -> tuple[float, Array, dict[str, int]]:
        found = wheel.solve(grid)
        return found.seconds, found.rows[:, shown], {"steps": found.steps, "events": len(found.transitions)}

    return solve


def peers(scene: Scene) -> dict[str, Callable[[Scene, float, int], Solve]]:
    """Those that can solve the scene as it stands, by name; with exact friction, those that know no events naively."""
    found: dict[str, Callable[..., Solve]] = {CPP: in_cpp, HEYOKA: in_heyoka}
    if scene.wheel.s > 0 and not width(scene):
        ways = {f"SciPy {m}, {naive}()": (m, naive) for naive in ("sign", "tanh") for m in ("DOP853", "LSODA")}
        return found | {name: partial(in_scipy, method=m, naive=naive) for name, (m, naive) in ways.items()}
    found |= {f"SciPy {method}": partial(in_scipy, method=method) for method in ("DOP853", "LSODA", "Radau")}
    return found | {f"numbalsoda {m}": partial(in_numbalsoda, method=m) for m in ("lsoda", "dop853")}
