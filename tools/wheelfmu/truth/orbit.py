"""The product's Orbit as Python sees it, and the same motion by ways that share nothing with it.

State: theta, omega_1, omega_2, omega_3, psi, phi, X_O, Y_O (wheel_equations.h). SI units.
"""

import ctypes
from collections.abc import Callable
from ctypes import CFUNCTYPE, POINTER, c_double, c_longlong, c_uint, c_void_p
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.motion import start_values
from wheelfmu.truth.reference import Start, Wheel
from wheelfmu.truth.reference.frames import rotation
from wheelfmu.truth.reference.modes import rolling
from wheelfmu.truth.reference.motion import initial_state

Array = NDArray[np.float64]
KINDS = ("refused", "unfolded", "steady", "ended")
ADDED = CFUNCTYPE(c_double, c_double, POINTER(c_double))
VARIABLES = ElementTree.parse(ROOT / "modelDescription.xml").iter("ScalarVariable")
REFERENCES = {variable.get("name"): int(variable.get("valueReference")) for variable in VARIABLES}


class Orbit:
    """One free wheel, built at once; `kind` is what came of it."""

    # Of probe.cpp, by the names after `probe_`.
    RESULTS = {"make": c_void_p, "steps": c_longlong}
    RESULTS |= dict.fromkeys(("half_period", "first_fall"), c_double)

    def __init__(self, library: ctypes.CDLL, wheel=None, start=None, tolerance=1e-8, keep_contact=False) -> None:
        self.library = library
        for name, result in self.RESULTS.items():
            getattr(library, f"probe_{name}").restype = result
        given = start_values(wheel or Wheel(), start or Start()) | {"keep_contact": float(keep_contact)}
        references = (c_uint * len(given))(*(REFERENCES[name] for name in given))
        values = (c_double * len(given))(*given.values())
        self.probe = c_void_p(library.probe_make(references, values, len(given), c_double(tolerance)))
        self.kind = self.build()

    def __del__(self) -> None:
        self.library.probe_free(self.probe)

    def build(self, place: int = 0, size: float = 0, added: Callable | None = None) -> str:
        """added: a function of (t, y), to the rate of the state at `place` or to what is watched for an event."""
        kind = KINDS[self.library.probe_build(self.probe, place, c_double(size), ADDED(added or 0))]
        self.half_period, self.steps = self.library.probe_half_period(self.probe), self.library.probe_steps(self.probe)
        return kind

    def read(self, t: Array | list[float]) -> tuple[Array, Array]:
        """States (rows) and N at the instants t."""
        t = np.ascontiguousarray(t, float)
        y, force = np.empty((len(t), 8)), np.empty(len(t))
        t_, y_, force_ = (c_void_p(array.ctypes.data) for array in (t, y, force))
        self.library.probe_read(self.probe, t_, len(t), y_, force_)
        return y, force

    def __call__(self, t: Array | list[float]) -> Array:
        return self.read(t)[0]

    def first_fall(self) -> float:
        """The instant at which N first falls below zero, or infinity."""
        return self.library.probe_first_fall(self.probe)


def reduced(row: Array) -> Array:
    """The reduced state of one row of the reference: quaternion, w, O, v_O, psi, phi, works."""
    n = rotation(*row[:4])[2]
    s = np.hypot(n[0], n[1])
    ux, uy = n[0] / s, n[1] / s
    w = row[4:7]
    omega_1, omega_2 = w[0] * uy - w[1] * ux, w[0] * ux + w[1] * uy
    return np.array([np.arctan2(s, n[2]), omega_1, omega_2, w[2], row[13], row[14], row[7], row[8]])


def headline_of(y: Array) -> Array:
    """X_O, theta, phi_dot and psi_dot of rows of the reduced state."""
    theta, _, omega_2, omega_3, _, _, X_O, _ = y.T
    psi_dot = omega_2 / np.sin(theta)
    return np.column_stack([X_O, theta, omega_3 - psi_dot * np.cos(theta), psi_dot])


def energies(wheel: Wheel, y: Array) -> Array:
    """Of translation, rotation and height; the contact lies rho below O along e2 and eta along e3, so that O moves at
    eta omega_2 - rho omega_3 along e1, and across it at omega_1 times its distance from the contact."""
    s, c = np.sin(y[:, 0]), np.cos(y[:, 0])
    rho, eta, (omega_1, omega_2, omega_3) = wheel.r_0 + wheel.r * s, wheel.r * c, y.T[1:4]
    speed_2 = (eta * omega_2 - rho * omega_3) ** 2 + (rho**2 + eta**2) * omega_1**2
    turning = wheel.J_x * omega_1**2 + wheel.J_y * omega_2**2 + wheel.J_z * omega_3**2
    return 0.5 * (wheel.m * speed_2 + turning) + wheel.m * wheel.g * (wheel.r_0 * s + wheel.r)


def stepped(wheel: Wheel, start: Start, t: Array) -> Array:
    """Every step of the way by the reference: Newton and Euler in body axes, DOP853."""
    run = solve_ivp(rolling(wheel), (0, t[-1]), initial_state(wheel, start), "DOP853", t, rtol=1e-13, atol=1e-14)
    return np.array([reduced(row) for row in run.y.T])


class Halves:
    """The paper's wheel by the reference over half a nutation; the rest by laying half after half, one at a time."""

    def __init__(self, wheel: Wheel, start: Start, mirrored: bool = True) -> None:
        self.mirrored = mirrored
        rate, y0 = rolling(wheel), initial_state(wheel, start)
        run = solve_ivp(rate, (0, 0.7), y0, "DOP853", rtol=3e-14, atol=1e-15, max_step=0.01, dense_output=True)
        self.at = lambda t: reduced(run.sol(t))
        self.length = brentq(lambda t: self.at(t)[1], 0.5, 0.7, xtol=1e-16)

    def read(self, t: Array) -> Array:
        """States at rising instants t; theta_dot is zero at the start."""
        L, first, last = self.length, self.at(0.0), self.at(self.length)
        psi, phi, place, k = first[4], first[5], complex(*first[6:]), 0
        way = (complex(*last[6:]) - place) * np.exp(-1j * psi)
        turn = last[4] - psi
        rows = []
        for instant in t:
            while instant >= (k + 1) * L:
                back = self.mirrored and k % 2
                place += np.exp(1j * psi) * (np.conj(way) * np.exp(1j * turn) if back else way)
                psi, phi, k = psi + turn, phi + last[5] - first[5], k + 1
            rows.append(self._inside(instant - k * L, psi, phi, place, bool(self.mirrored and k % 2)))
        return np.array(rows)

    def _inside(self, u: float, psi: float, phi: float, place: complex, back: bool) -> Array:
        """Where the wheel is u after a turning point at which it had psi, phi and place."""
        y = self.at(self.length - u if back else u)
        edge = self.at(self.length if back else 0.0)
        way = (complex(*y[6:]) - complex(*edge[6:])) * np.exp(-1j * edge[4])
        sign = -1 if back else 1
        spot = place + np.exp(1j * psi) * (-np.conj(way) if back else way)
        angles = psi + sign * (y[4] - edge[4]), phi + sign * (y[5] - edge[5])
        return np.array([y[0], sign * y[1], y[2], y[3], *angles, spot.real, spot.imag])
