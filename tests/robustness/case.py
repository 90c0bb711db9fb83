"""What a case of the sweep is, and how it maps onto the independent reference of tests/reference."""

from dataclasses import dataclass, field

import numpy as np
from support.driver import Values
from support.scenes import PAPER, Started

PI = np.pi


@dataclass(frozen=True)
class Expectation:
    """How the run should go: finishes | flat | lifts | refused; at: the instant where one is known, s."""

    kind: str = "finishes"
    at: float | None = None

    def __str__(self) -> str:
        words = {"finishes": "finishes", "flat": "ends flat", "lifts": "lifts off", "refused": "refused"}[self.kind]
        return words if self.at is None else f"{words} at {self.at:.6f} s"


@dataclass(frozen=True)
class Case(Started):
    """One wheel. start: changes of the FMU's start values; judges: names of judges.py with the bound of each, in
    multiples of the tolerance; instant: the same for the instant of the ending, s; loosest: the largest tolerance at
    which the expectation is claimed."""

    group: str
    name: str
    start: Values = field(default_factory=dict)
    duration: float = 10.0
    expect: Expectation = Expectation()
    judges: tuple[tuple[str, float], ...] = (("energy", 10.0), ("integrals", 10.0))
    samples: int = 400
    start_time: float = 0.0
    instant: float = 10.0
    instant_floor: float = 1e-9
    loosest: float = 1e-4
    remark: str = ""

    def __str__(self) -> str:
        return f"{self.group}: {self.name}"

    @property
    def times(self) -> np.ndarray:
        return self.start_time + np.linspace(0.0, self.duration, self.samples + 1)


def tilted(degrees: float, **others: float) -> Values:
    return {"theta_start": float(np.radians(degrees)), **others}


def spinless(degrees: float, psi_dot: float, **others: float) -> Values:
    """omega_z = 0 exactly: phi_dot = -psi_dot cos(theta)."""
    theta = float(np.radians(degrees))
    return {"theta_start": theta, "psi_dot_start": psi_dot, "phi_dot_start": -psi_dot * np.cos(theta), **others}


def brushing(degrees: float, omega_2: float = 4.0) -> Values:
    """At the lowest point of the nutation, theta_dot = 0, with the psi_dot that goes with it."""
    return spinless(degrees, omega_2 / float(np.sin(np.radians(degrees))))


def similar(scale: float, mass: float = 20.0) -> Values:
    """The paper's wheel enlarged `scale` times, of another mass: the same motion in the time sqrt(scale)."""
    J = PAPER.J_x * mass / PAPER.m * scale**2
    rate = {"phi_dot_start": -2.0 / scale**0.5}
    size = {"r_0": PAPER.r_0 * scale, "r": PAPER.r * scale, "m": mass}
    return {**size, "J_x": J, "J_y": J, "J_z": 2 * J, **rate}
