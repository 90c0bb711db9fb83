"""The product's Orbit as Python sees it, and the same motion by ways that share nothing with it.

State: theta, omega_1, omega_2, omega_3, psi, phi, X_O, Y_O (wheel_equations.h). SI units.
"""

import ctypes
from collections.abc import Callable
from ctypes import CFUNCTYPE, POINTER, c_double, c_longlong, c_uint, c_void_p
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.motion import start_values
from wheelfmu.truth.reference import Start, Wheel, solve

Array = NDArray[np.float64]
KINDS = ("refused", "unfolded", "steady", "ended")
ADDED = CFUNCTYPE(c_double, c_double, POINTER(c_double))
VARIABLES = ElementTree.parse(ROOT / "modelDescription.xml").iter("ScalarVariable")
REFERENCES = {variable.get("name"): int(variable.get("valueReference")) for variable in VARIABLES}


class Orbit:
    """One free wheel, built at once; `kind` is what came of it."""

    # Of probe.cpp, by the names after `probe_`.
    RESULTS = {"make": c_void_p, "steps": c_longlong, "run": c_longlong}
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

    def run(self, name: str, value: float, t: float) -> tuple[int, Array]:
        """A new run of the wheel with another value of a parameter: the steps that the solver takes, the state at t."""
        y = np.empty(8)
        at = c_uint(REFERENCES[name]), c_double(value), c_double(t), c_void_p(y.ctypes.data)
        return self.library.probe_run(self.probe, *at), y

    def first_fall(self) -> float:
        """The instant at which N first falls below zero, or infinity."""
        return self.library.probe_first_fall(self.probe)


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
    """Every step of the way by the reference: Newton and Euler in body axes. t: rising, the first is the start."""
    run = solve(wheel, start, t.tolist())
    rates = [run["theta_dot"], run["psi_dot"] * np.sin(run["theta"]), run["omega_z"]]
    return np.column_stack([run["theta"], *rates, run["psi"], run["phi"], run["X_O"], run["Y_O"]])


class Halves:
    """The paper's wheel by the reference over half a swing; the rest by laying half after half."""

    def __init__(self, wheel: Wheel, start: Start, mirrored: bool = True) -> None:
        self.wheel, self.start, self.mirrored = wheel, start, mirrored
        self.length = brentq(lambda t: stepped(wheel, start, np.array([0.0, t]))[-1, 1], 0.5, 0.7, xtol=1e-16)
        self.first, self.last = stepped(wheel, start, np.array([0.0, self.length]))

    def read(self, t: Array) -> Array:
        """States at rising instants t; theta_dot is zero at the start."""
        L, first, last = self.length, self.first, self.last
        halves = np.floor(t / L).astype(int)
        back = (halves % 2 == 1) & self.mirrored
        u = t - halves * L
        inside, at = np.unique(np.where(back, L - u, u), return_inverse=True)
        y = stepped(self.wheel, self.start, np.array([0.0, *inside]))[1:][at]
        # A half as seen from its beginning: its way and its turns; backwards, mirrored, with the same turns.
        way, turn = (complex(*(last - first)[6:])) * np.exp(-1j * first[4]), last[4] - first[4]
        place, places = complex(*first[6:]), []
        for k in range(halves[-1] + 1):
            places.append(place)
            step = np.conj(way) * np.exp(1j * turn) if k % 2 and self.mirrored else way
            place += np.exp(1j * (first[4] + k * turn)) * step
        sign, edge = np.where(back, -1, 1), np.where(back[:, np.newaxis], last, first)
        moved = (y[:, 6] - edge[:, 6] + 1j * (y[:, 7] - edge[:, 7])) * np.exp(-1j * edge[:, 4])
        psi, phi = first[4] + halves * turn, first[5] + halves * (last[5] - first[5])
        spot = np.array(places)[halves] + np.exp(1j * psi) * np.where(back, -np.conj(moved), moved)
        angles = psi + sign * (y[:, 4] - edge[:, 4]), phi + sign * (y[:, 5] - edge[:, 5])
        return np.column_stack([y[:, 0], sign * y[:, 1], y[:, 2:4], *angles, spot.real, spot.imag])
