"""Other solvers: DOP853 in C++ on the product's right-hand side, and heyoka, which writes its own.

Each is made for a scene, a tolerance and a number of grid points. A solver that cannot do it raises a RuntimeError or
an ImportError with the reason.
"""

from __future__ import annotations

from ctypes import byref, c_long, c_void_p
from dataclasses import asdict
from time import perf_counter

import numpy as np
from support import equations as eq
from support.driver import HEADLINE
from support.scenes import Scene

from .native import Solve, dop853_code
from .truth import Array

CPP, HEYOKA = "DOP853 C++", "heyoka"


def width(scene: Scene) -> float:
    """Of the regularized law, rad/s; 0: the law is exact."""
    return float(scene.start.get("omega_s", 1e-3)) if scene.start.get("friction_law") == "regularized" else 0.0


def in_cpp(scene: Scene, tolerance: float, points: int) -> Solve:
    """DOP853, hand-inlined (dop853.cpp)."""
    constants, motion = asdict(scene.wheel), asdict(scene.motion)
    known = {name for name, _ in eq.Parameters._fields_}
    wheel = eq.paper_wheel(**{name: value for name, value in constants.items() if name in known})
    kind = eq.FRICTIONLESS if wheel.s == 0 else eq.REGULARIZED if width(scene) else eq.ROLLING
    problem = eq.scene(wheel, kind, omega_s=width(scene) or 1e-3)
    y_0 = eq.start(eq.REDUCED, wheel, eq.Motion(**{name: motion[name] for name, _ in eq.Motion._fields_}))
    rows, counts, run = np.zeros((points, 4)), (c_long * 3)(), dop853_code().dop853
    start, out = (array.ctypes.data_as(c_void_p) for array in (y_0, rows))

    def solve() -> tuple[float, Array, dict[str, int]]:
        begin = perf_counter()
        reached = run(byref(problem), start, tolerance, scene.duration, points, out, counts)
        spent = perf_counter() - begin
        if not reached:
            raise RuntimeError("did not reach the end")
        return spent, rows, dict(zip(("steps", "rhs", "events"), counts, strict=True))

    return solve


def in_heyoka(scene: Scene, tolerance: float, points: int) -> Solve:
    from . import taylor

    wheel = taylor.Wheel(asdict(scene.wheel) | asdict(scene.motion), "angles", tolerance, omega_s=width(scene))
    grid, shown = np.linspace(0, scene.duration, points), [taylor.OUTPUTS.index(name) for name in HEADLINE]

    def solve() -> tuple[float, Array, dict[str, int]]:
        found = wheel.solve(grid)
        return found.seconds, found.rows[:, shown], {"steps": found.steps, "events": len(found.transitions)}

    return solve


PEERS = {CPP: in_cpp, HEYOKA: in_heyoka}
