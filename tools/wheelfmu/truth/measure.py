"""How far the FMU is from what is known. Each function gives a number (or a table) that is 0 for the exact motion."""

import numpy as np
from numpy.typing import NDArray

from wheelfmu.fmu import equations as eq
from wheelfmu.fmu.driver import HEADLINE, WARNING, Values
from wheelfmu.truth.errors import Errors, range_error, range_errors
from wheelfmu.truth.errors import instants_error as error_of_instants
from wheelfmu.truth.motion import Library, Run, run
from wheelfmu.truth.reference import Solution
from wheelfmu.truth.scenes import SCENES

FRICTION = {"free": 0.0, "friction": 0.03}  # s of the paper's two scenes, m


def paper(scene: str, points: int = 101) -> Solution:
    """One of the paper's two scenes by the reference, at instants over 10 s, every 0.1 s if not given."""
    return SCENES[scene].solved(np.linspace(0, 10, points))


def transitions() -> NDArray[np.float64]:
    """Of its friction scene: instant, and mode after it; the first row is the start."""
    return np.array(paper("friction").events)


def paper_errors(library: Library, scene: str, tolerance: float | None = None, **start: float) -> Errors:
    """Largest error of each headline output in one of these scenes, as a part of the output's range: at the instants of
    ./scripts/run, which find the peaks that make the range."""
    want = paper(scene, 1001)
    got = library.simulate(want.t, tolerance, **{"s": FRICTION[scene], **start})
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
    return error_of_instants(found, paper("friction").events[1:])


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


# The regularized law -s N tanh(omega_z / omega_s) against the exact one, in the paper's scene with friction.
ROUGH: Values = {"s": 0.03}
TIMES = np.linspace(0.0, 10.0, 101)


def error_against(truth: Run, found: Run) -> float:
    """Of the headline outputs, relative to the range of each; nan where the run did not get to the end."""
    if found.status > WARNING or len(found["t"]) != len(truth["t"]):
        return float("nan")
    return range_error(found, truth, HEADLINE)


def law_error(library: Library, omega_s: float, tolerance: float, method: str) -> float:
    """Of the paper's scene under the regularized law, against that under the exact one."""
    regularized = ROUGH | {"friction_law": "regularized", "omega_s": omega_s, "method": method}
    return error_against(run(library, ROUGH, TIMES, 1e-12), run(library, regularized, TIMES, tolerance))
