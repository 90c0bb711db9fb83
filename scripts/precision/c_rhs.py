"""The product's C right-hand side for Python solvers, by address through tests/support/equations.py."""

from __future__ import annotations

from ctypes import CFUNCTYPE, byref, c_double, c_void_p, cast
from typing import Any

import numpy as np
from support import equations as eq


class Problem:
    """A scene of the request: state at the start, right-hand side, headline outputs."""

    def __init__(self, request: dict[str, Any]) -> None:
        self.formulation = eq.MULTIBODY if request.get("formulation") == 3 else eq.REDUCED
        wheel = eq.paper_wheel(**{n: request[n] for n in ("m", "r_0", "r", "J_x", "J_y", "J_z", "g", "s")})
        names = ("psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "X_O", "Y_O")
        motion = eq.Motion(*(request[f"{n}_start"] for n in names))
        self.wheel = wheel
        kind = eq.FRICTIONLESS
        if wheel.s > 0:
            kind = eq.REGULARIZED if request.get("friction_law") == 2 else eq.ROLLING
        self.scene = eq.scene(wheel, kind, omega_s=request.get("omega_s", 1e-3))
        self.y_0 = eq.start(self.formulation, wheel, motion)
        self.y, self.y_dot = np.zeros_like(self.y_0), np.zeros_like(self.y_0)
        self.addresses = [c_void_p(a) for a in (self.scene_address, self.y.ctypes.data, self.y_dot.ctypes.data)]
        derivative = cast(self.formulation.derivative, c_void_p).value
        assert derivative is not None
        self.call = CFUNCTYPE(c_double, c_void_p, c_void_p, c_void_p)(derivative)
        self.count = 0

    @property
    def scene_address(self) -> int:
        value = cast(byref(self.scene), c_void_p).value
        assert value is not None
        return value

    def rhs(self, t: float, y: np.ndarray) -> np.ndarray:
        self.count += 1
        self.y[:] = y
        self.call(*self.addresses)
        return self.y_dot.copy()

    def outputs(self, states: np.ndarray) -> np.ndarray:
        rows = [eq.kinematics(self.formulation, self.wheel, np.ascontiguousarray(y)) for y in states]
        return np.array([[k.X_O, k.theta, k.phi_dot, k.psi_dot] for k in rows])
