"""Wheels of other people: Modelica's RollingWheel, Exudyn's coin, Siconos' steps, SymPy's disc.

What they found, the same by wheel.fmu and by the independent reference, and how far they are apart; SI units.
"""

from dataclasses import dataclass
from math import pi, sin
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from wheelfmu.truth.motion import Library, Run, start_values
from wheelfmu.truth.reference import Start, Wheel
from wheelfmu.truth.scenes import Scene

Array = NDArray[np.float64]
# Modelica's default world has 9.80665 m/s2 as its gravity.
MODELICA = Wheel(m=2.0, r_0=0.3, r=0.0, J_x=0.12, J_y=0.12, J_z=0.06, g=9.80665)
MODELICA_START = Start(psi=0.0, theta=pi / 2, theta_dot=1.0, phi_dot=-5.0, X_O=0.2, Y_O=0.2)
COIN_RADIUS, COIN_LEAN, COIN_SPIN = 0.01, pi / 180, 10 * pi  # m, rad, rad/s about the vertical
COIN = Wheel(m=1.0, r_0=COIN_RADIUS, r=0.0, J_x=2.5e-5, J_y=2.5e-5, J_z=5e-5)
COIN_START = Start(
    psi=-pi / 2, theta=pi / 2 - COIN_LEAN, psi_dot=COIN_SPIN, phi_dot=0.0, X_O=COIN_RADIUS * sin(COIN_LEAN)
)
SYMPY_DISC = Wheel(m=1.0, r_0=1.0, r=0.0, J_x=0.25, J_y=0.25, J_z=0.5, g=1.0)
SYMPY_CRITICAL_SPIN = 1 / np.sqrt(3)  # sympy 1.14.0, test_linearize.py: all eigenvalues vanish at q3' = 1/sqrt(3)
THROW = {"mu_max": 0.4, "mu_slide": 0.4, "slip_x_start": -1.5, "slip_y_start": 0.8}  # slides, then grips
READ_AT = (0.15, 0.5)  # s
# The scenes of siconos_wheel.py; each lasts SICONOS_END, s.
SICONOS_END, SICONOS_THROW = 1.0, 2.0 + 10.0 * (0.3 + 0.05 * sin(4 * pi / 9))
SICONOS: dict[str, tuple[Wheel, Start, dict[str, float]]] = {
    "rolls": (Wheel(), Start(X_O=0.0), {}),
    "slides": (Wheel(), Start(X_O=0.0), {"mu_max": 0.3, "mu_slide": 0.3}),
    "backspin": (
        Wheel(),
        Start(theta=4 * pi / 9, phi_dot=10.0, X_O=0.0),
        {"mu_max": 0.3, "mu_slide": 0.3, "slip_x_start": SICONOS_THROW},
    ),
    "resists": (Wheel(s=0.01), Start(theta=pi / 2, X_O=0.0), {}),
}


def read(name: str) -> dict[str, Array]:
    """A small table of other people's numbers, columns by name; its lines that begin with # name the source."""
    table = pd.read_csv(Path(__file__).with_name(f"{name}.csv"), comment="#")
    return {column: table[column].to_numpy() for column in table}


def motion(library: Library, wheel: Wheel, start: Start, times: Array, tolerance=None, **more: float) -> Run:
    return library.simulate(times, tolerance, keep_contact=True, **(start_values(wheel, start) | more))


def modelica(library: Library, tolerance: float | None = None) -> Run:
    """Their wheel, at the instants of their table."""
    return motion(library, MODELICA, MODELICA_START, read("modelica_wheel")["time"], tolerance)


def modelica_reference() -> dict[str, Array]:
    """The same by truth/reference."""
    return Scene(start_values(MODELICA, MODELICA_START)).solved(read("modelica_wheel")["time"]).columns


def apart(table: dict[str, Array], other: Run | dict[str, Array]) -> float:
    """Largest distance between the centres, m."""
    return float(np.hypot(table["x"] - other["X_O"], table["y"] - other["Y_O"]).max())


def modelica_own(library: Library) -> float:
    """Largest distance between the centres by wheel.fmu and by truth/reference, m."""
    true = modelica_reference()
    return apart({"x": true["X_O"], "y": true["Y_O"]}, modelica(library))


def modelica_drift() -> float:
    """Largest change of the energy along their table, relative."""
    energy = modelica_energy()
    return float(np.abs(energy / energy[0] - 1).max())


def modelica_energy() -> Array:
    """Energy along their table, J.

    Their angles turn about z, y, x; the axle is the body's y axis, and w in body axes follows from the angles' rates.
    A knife edge that rolls has the kinetic energy (J_x (w_1^2 + w_2^2) + J_z w_3^2 + m r_0^2 (w_1^2 + w_3^2)) / 2, w_3
    along the axle, w_1 along the line of nodes.
    """
    t = read("modelica_wheel")
    (s_2, s_3), (c_2, c_3) = ([f(t[name]) for name in ("a_2", "a_3")] for f in (np.sin, np.cos))
    w_x = t["d_3"] - t["d_1"] * s_2
    w_y = t["d_2"] * c_3 + t["d_1"] * c_2 * s_3  # about the axle
    w_z = -t["d_2"] * s_3 + t["d_1"] * c_2 * c_3
    up = np.array([-s_2, c_2 * s_3, c_2 * c_3])  # the vertical in body axes
    steep = np.hypot(up[0], up[2])  # sine of the angle between axle and vertical
    tipping = (w_x * up[2] - w_z * up[0]) / steep  # about the line of nodes
    wheel, across = MODELICA, w_x**2 + w_z**2
    spin = wheel.J_x * across + wheel.J_z * w_y**2 + wheel.m * wheel.r_0**2 * (tipping**2 + w_y**2)
    return spin / 2 + wheel.m * wheel.g * wheel.r_0 * steep


def coin_limit(table: dict[str, Array]) -> Array:
    """Richardson's limit of a method of second order from the two smallest steps: (x, y), m."""
    x, y = table["x"], table["y"]
    return np.array([(4 * c[-1] - c[-2]) / 3 for c in (x, y)])


def coin(library: Library, tolerance: float | None = None) -> Array:
    """(x, y) of the contact point after 0.5 s, m."""
    run = motion(library, COIN, COIN_START, np.array([0.0, 0.5]), tolerance)
    return np.array([run["X_C"][-1], run["Y_C"][-1]])


def thrown_in_steps(table: dict[str, Array]) -> Array:
    """(x, y) while the disc slides and after it grips, m: a row for each zone, extrapolated to h = 0 from two steps."""
    places = np.column_stack([table[name] for name in ("x_1", "y_1", "x_2", "y_2")])
    return 2 * places[1::2] - places[::2]  # of first order in h


def thrown_limit(table: dict[str, Array]) -> Array:
    """The same extrapolated to a zone of 0 from the two smallest, of first order in it."""
    places = thrown_in_steps(table)
    return 2 * places[-1] - places[-2]


def thrown(library: Library, tolerance: float | None = None) -> Array:
    """The same by wheel.fmu."""
    at = motion(library, Wheel(r=0.0), Start(phi_dot=-6.0), np.array([0.0, *READ_AT]), tolerance, **THROW)
    return np.array([at["X_O"][1:], at["Y_O"][1:]]).T.ravel()


@dataclass(frozen=True)
class Steps:
    """A scene of Siconos at steps h that halve, s: the centres, m, and the processor time, s."""

    h: Array
    places: Array
    seconds: Array

    @property
    def limit(self) -> Array:
        """Richardson's, of the order 1, then 2, 3 ...; (X_O, Y_O)."""
        places = self.places
        for order in range(1, len(self.h)):
            places = (2**order * places[1:] - places[:-1]) / (2**order - 1)
        return places[0]

    @property
    def errors(self) -> Array:
        return np.hypot(*(self.places - self.limit).T)

    @property
    def order(self) -> float:
        """Of convergence, from the two smallest steps."""
        return float(np.log2(self.errors[-2] / self.errors[-1]))

    @property
    def time(self) -> float:
        """Processor time for an error of 1e-4 m, s, from the smallest step: the error is of first order in h."""
        return float(self.seconds[-1] * self.errors[-1] / 1e-4)


def siconos(table: dict[str, Array], scene: str) -> Steps:
    """One scene of the table that siconos_wheel.py writes."""
    rows = table["scene"] == scene
    return Steps(table["h"][rows], np.column_stack([table["x"][rows], table["y"][rows]]), table["seconds"][rows])


def siconos_ours(library: Library, scene: str, tolerance: float | None = None, **other: float) -> Array:
    """(X_O, Y_O) at the end of a scene of Siconos, m; other: parameters that replace the scene's."""
    wheel, start, values = SICONOS[scene]
    run = motion(library, wheel, start, np.array([0.0, SICONOS_END]), tolerance, **(values | other))
    return np.array([run["X_O"][-1], run["Y_O"][-1]])
