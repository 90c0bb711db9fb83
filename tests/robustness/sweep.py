"""The sweep of stiff and extreme wheels: every case with its expectation and its judges. SI; names of
modelDescription.xml."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from scipy.optimize import brentq

from wheelfmu.fmu.driver import Values
from wheelfmu.truth.closed_forms import critical_spin, fall_lift_off, fall_time, lowest_fall_force
from wheelfmu.truth.reference import Wheel, accelerations
from wheelfmu.truth.scenes import PAPER, THETA_0, Scene, Started
from wheelfmu.truth.schedule import Schedule

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
    which the expectation holds."""

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
    inputs = Schedule()

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


FLAT = 1e-7  # sin(theta) at which the wheel counts as flat
ROLLING = (("energy", 10.0), ("fixed", 0.0))
CHECKED = (*ROLLING, ("reference", 1e3))


def free(bound: float) -> tuple[tuple[str, float], ...]:
    """Judges of a wheel that nothing brakes."""
    return ("energy", bound), ("integrals", bound)


FREE = free(10.0)


def resting(degrees: float) -> Values:
    return tilted(degrees, phi_dot_start=0.0)


def fall(degrees: float, wheel: Wheel = PAPER) -> Expectation:
    return Expectation("flat", fall_time(wheel, float(np.radians(degrees)), FLAT))


def sphere(J: float) -> Wheel:
    return Wheel(J_x=J, J_y=J, J_z=J)


def inertia(wheel: Wheel) -> dict[str, float]:
    return {name: getattr(wheel, name) for name in ("J_x", "J_y", "J_z")}


def falls() -> Iterator[Case]:
    # The first is 1.7e-5 rad from the unstable equilibrium: errors grow 1e4-fold.
    for degrees, instant in ((89.999, 2e3), (75.0, 10.0), (45.0, 10.0), (10.0, 10.0), (1.0, 10.0)):
        yield Case("fall from rest", f"{degrees:g} deg", resting(degrees), 5.0, fall(degrees), FREE, instant=instant)


def uprights() -> Iterator[Case]:
    limit, upright = critical_spin(PAPER), {"theta_start": PI / 2}
    yield Case("upright", "at rest, 2 s", {**upright, "phi_dot_start": 0.0}, 2.0, judges=(("still", 1.0),))
    straight = (*FREE, ("still", 1.0), ("reference", 1.0))
    yield Case("upright", "rolling at 4 rad/s", {**upright, "phi_dot_start": -4.0}, judges=straight)
    for side, ratio in (("below", 0.99), ("above", 1.01)):
        start = {"theta_start": PI / 2 - 1e-5, "phi_dot_start": -ratio * limit}
        name = f"1 % {side} {limit:.4f} rad/s, lean 1e-5"
        yield Case("stability limit", name, start, 5.0, judges=FREE)


def spins() -> Iterator[Case]:
    def spinning(omega: float) -> dict[str, float]:
        return {"theta_start": PI / 2 - 0.1, "phi_dot_start": -omega}

    flat = Expectation("flat", fall_time(PAPER, PI / 2 - 0.1, FLAT))
    yield Case("spin", "1e-9 rad/s", spinning(1e-9), 2.0, flat, FREE)
    yield Case("spin", "1e-6 rad/s: clears the ground by 1e-7 m", spinning(1e-6), 1.0)
    yield from (Case("spin", f"{spin:g} rad/s", spinning(spin), 1.0) for spin in (1e-3, 1.0, 1e2, 1e3))
    # N ~ omega_z omega_2: an error of 1e-3 rad/s in omega_2 lifts the wheel.
    yield Case("spin", "10000 rad/s", spinning(1e4), 1.0, loosest=1e-6)


def tilts() -> Iterator[Case]:
    for degrees in (1.0, 0.1, 0.01):  # one error per bounce, some fifty bounces
        start = brushing(degrees)
        name = f"theta = {degrees:g} deg, psi_dot = {start['psi_dot_start']:.0f} rad/s"
        yield Case("brushing the ground", name, start, judges=free(200.0), samples=2000)
    for degrees, bound in ((91.0, 10.0), (100.0, 10.0), (135.0, 20.0), (170.0, 200.0)):
        yield Case("past upright", f"theta = {degrees:g} deg", tilted(degrees), judges=free(bound))


def frictions() -> Iterator[Case]:
    yield Case("friction", "the paper's, s = 0.03 m", {"s": 0.03}, 10.0, judges=CHECKED)
    for s in (0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1):
        yield Case("friction", f"s = {s:g} m", {"s": s}, 5.0, judges=CHECKED)
    for s in (1.0, 10.0):
        yield Case("friction", f"s = {s:g} m", {"s": s}, 5.0, judges=(*ROLLING, ("reference", 1e5)))


def sticking() -> Iterator[Case]:
    start = spinless(75.0, 3.0, theta_dot_start=1.0)
    rates = (3.0, 1.0, start["phi_dot_start"])
    held = accelerations(PAPER, (PI / 2, start["theta_start"], 0.0), rates, sigma=None)
    edge = abs(held.tau) / held.lambda_3
    group = "omega_z = 0 at the start"
    yield Case(group, "at rest: sticks and falls", {**resting(75.0), "s": 0.03}, 2.0, fall(75.0), CHECKED)
    for name, s in (("sticks", 2 * edge), ("released at once", edge / 2), ("on the edge |tau| = s N", edge)):
        yield Case(group, f"{name}, s = {s:.4g} m", {**start, "s": s}, 5.0, judges=CHECKED)


def shapes() -> Iterator[Case]:
    yield Case("shape", "thin disc r = 0", {"r": 0.0}, judges=(*FREE, ("reference", 1e3)))
    yield Case("shape", "thin disc with friction", {"r": 0.0, "s": 0.03}, 5.0, judges=CHECKED)
    yield Case("shape", "r = 100 r_0", {"r": 30.0, "J_x": 9e3, "J_y": 9e3, "J_z": 9e3})
    for r_0 in (1e-3, 1e3):
        scale = r_0 / PAPER.r_0
        yield Case("shape", f"r_0 = {r_0:g} m, to scale", similar(scale), 10.0 * scale**0.5)
        yield Case("shape", f"r_0 = {r_0:g} m, the paper's J", {"r_0": r_0})
    for mass in (1e-6, 1e6):
        yield Case("mass", f"m = {mass:g} kg, to scale", similar(1.0, mass))
        yield Case("mass", f"m = {mass:g} kg, the paper's J", {"m": mass})


def inertias() -> list[Case]:
    energy, general = (("energy", 10.0),), (("energy", 10.0), ("reference", 1e3))
    limit, double = {"J_x": 1.8, "J_y": 0.9, "J_z": 0.9}, {"J_x": 1.8, "J_y": 0.9}
    return [
        Case("inertia", "the paper's: the limit J_z = J_x + J_y", judges=(*FREE, ("reference", 1e3))),
        Case("inertia", "nearly spherical, 1e-9", {"J_x": 1.0, "J_y": 1.0, "J_z": 1 + 1e-9}),
        Case("inertia", "J_x, J_y differ by 1e-12", {"J_y": 0.9 * (1 - 1e-12)}, judges=FREE),
        Case("inertia", "... with friction", {"J_y": 0.9 * (1 - 1e-12), "s": 0.03}, 5.0, judges=CHECKED),
        Case("inertia", "J_x = 2 J_y", double, 5.0, judges=general),
        Case("inertia", "J_x = J_y + J_z", limit, 5.0, judges=energy),
        Case("inertia", "J_x = 2 J_y, friction", {**double, "s": 0.03}, 5.0, judges=CHECKED),
        Case("inertia", "multibody, the paper's wheel", {"formulation": "multibody"}, judges=FREE),
        Case("inertia", "multibody, friction", {"formulation": "multibody", "s": 0.03}, judges=CHECKED),
    ]


def weightless() -> list[Case]:
    turning = {"g": 0.0, "psi_dot_start": 1.0, "keep_contact": True}
    return [
        Case("g = 0", "rolling on, leaning", {"g": 0.0}, judges=(("uniform", 1.0),)),
        Case("g = 0", "at rest", {"g": 0.0, "phi_dot_start": 0.0}, judges=(("uniform", 1.0),)),
        Case("g = 0", "turning, contact kept", turning, judges=(*FREE, ("reference", 1e3))),
        Case("start time", "1e9 s", {"s": 0.03}, judges=(("fixed", 0.0), ("reference", 1e3)), start_time=1e9),
    ]


def lift_offs() -> Iterator[Case]:
    rest, ball = resting(75.0), sphere(0.01)  # mass near its centre: leaves the ground while it falls
    light, lifts = {**inertia(ball), **rest}, Expectation("lifts", fall_lift_off(ball, THETA_0))
    yield Case("lift-off", "light wheel falling from 75 deg", light, 2.0, lifts, FREE)
    yield Case("lift-off", "the same, contact kept", {**light, "keep_contact": True}, 2.0, fall(75.0, ball), FREE)
    for spin, s in ((-0.1, 0.0), (-1.0, 0.0), (-0.6, 0.03), (-1.0, 0.03)):
        rolling = {**inertia(sphere(0.1)), "phi_dot_start": spin, "s": s}
        name = f"light wheel rolling at {-spin:g} rad/s, s = {s:g} m"
        ended = Scene(rolling, 2.0).solved([0.0, 2.0], rtol=1e-12).ended
        expected = Expectation("lifts", ended.time) if ended else Expectation()
        yield Case("lift-off", name, rolling, 2.0, expected, CHECKED)
    pulled = {**inertia(sphere(0.1)), "phi_dot_start": -0.3, "s": 0.03, "keep_contact": True}
    # A ground that pulls has no rolling resistance.
    yield Case("lift-off", "contact kept with friction, s = 0.03 m", pulled, 0.9, judges=CHECKED)
    for name, force in (("just leaves", -1e-6), ("just stays", 1e-6)):
        wheel = grazing(force)
        ending = Expectation("lifts", fall_lift_off(wheel, THETA_0)) if force < 0 else fall(75.0, wheel)
        touching = Case("lift-off", f"{name}: least N = {force:g} m g", {**inertia(wheel), **rest}, 2.0, ending, FREE)
        # N touches zero: an error e in N moves the instant by sqrt(e).
        yield replace(touching, instant_floor=1e-6, loosest=1e-6)


@cache
def grazing(force: float) -> Wheel:
    """The sphere-like wheel whose least normal force in the fall from 75 deg is `force` m g."""
    weight = PAPER.m * PAPER.g
    return sphere(brentq(lambda J: lowest_fall_force(sphere(J), THETA_0)[1] / weight - force, 0.01, 2.0, xtol=1e-14))


def sweep() -> list[Case]:
    parts = (falls, uprights, spins, tilts, frictions, sticking, shapes, inertias, weightless, lift_offs)
    return [case for part in parts for case in part()]
