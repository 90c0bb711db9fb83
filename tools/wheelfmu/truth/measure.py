"""How far the FMU is from what is known. Each function gives a number (or a table) that is 0 for the exact motion."""

import numpy as np
from numpy.typing import NDArray

from wheelfmu.fmu import equations as eq
from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.truth.errors import Errors, range_errors
from wheelfmu.truth.errors import instants_error as error_of_instants
from wheelfmu.truth.motion import Library
from wheelfmu.truth.reference.tables import read_table, read_transitions

FRICTION = {"free": 0.0, "friction": 0.03}  # s of the paper's two scenes, m


def table_errors(library: Library, scene: str, tolerance: float | None = None, **start: float) -> Errors:
    """Largest error of each headline output over the trusted table's 101 rows, as a part of the output's range."""
    want = read_table(f"paper_{scene}")
    got = library.simulate(want["t"], tolerance, **{"s": FRICTION[scene], **start})
    return range_errors(got, want, HEADLINE)


def energy_error(library: Library, tolerance: float | None = None, **start: float) -> float:
    """Largest relative change of the energy over 10 s, at 1001 instants."""
    energy = library.simulate(np.linspace(0, 10, 1001), tolerance, **start)["E"]
    return float(np.abs(energy / energy[0] - 1).max())


def instants(library: Library, tolerance: float | None = None, **start: float) -> list[tuple[float, int]]:
    """Transitions of the paper's friction scene in 10 s."""
    return library.simulate([0.0, 10.0], tolerance, **{"s": 0.03, **start}).events


def instants_error(found: list[tuple[float, int]]) -> float:
    """Of the 37 instants, s."""
    return error_of_instants(found, read_transitions()[1:])


def constraint_drift(library: Library, times: NDArray[np.float64], tolerance: float | None, **start: float) -> tuple:
    """How far the FMU is off the constraints at each instant: |[B]{q_dot}| (largest entry, m/s), (19), and the error of
    the height (m), (32)."""
    run, wheel = library.simulate(times, tolerance, **start), eq.paper_wheel()
    sine, cosine = np.sin(run["theta"]), np.cos(run["theta"])
    height = wheel.r_0 * sine + wheel.r
    along = wheel.r * cosine * run["psi_dot"] * sine - (wheel.r_0 + wheel.r * sine) * run["omega_z"]
    velocity = (along - 1j * height * run["theta_dot"]) * np.exp(1j * run["psi"])
    off = run["X_O_dot"] + 1j * run["Y_O_dot"] - velocity
    sinking = run["Z_O_dot"] - wheel.r_0 * cosine * run["theta_dot"]
    return np.abs([off.real, off.imag, sinking]).max(axis=0), np.abs(run["Z_O"] - height)
