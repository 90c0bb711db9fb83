"""The limit of the communication step: couplings of wheel.fmu with bodies, each stable below it and divergent above.

Two runs whose bodies, or wheel, start at speeds 1e-5 apart: over many steps their difference decays or grows. Bodies
are integrated exactly under held forces. SI.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location
from math import pi

import numpy as np
import pytest
from support.bounds import within

from wheelfmu.fmu.driver import OK, FMU2Wheel
from wheelfmu.fmu.paths import ROOT

PROGRAM = spec_from_file_location("step_limit", ROOT / "examples" / "python" / "step_limit.py")
sys.modules["step_limit"] = example = module_from_spec(PROGRAM)  # dataclasses look their module up
PROGRAM.loader.exec_module(example)
Wheel, step_limit = example.Wheel, example.step_limit

SIGNALS = {
    "X": ("X_O", "X_O_dot", "F_X"),
    "Y": ("Y_O", "Y_O_dot", "F_Y"),
    "spin": ("phi", "omega_z", "M_3"),
    "lean": ("theta", "theta_dot", "M_1"),
    "turn": ("psi", "psi_dot", "M_2"),
}
UPRIGHT = {"psi_start": 0.0, "theta_start": pi / 2, "phi_dot_start": 0.0, "X_O_start": 0.0, "Y_O_start": 0.0}
GUIDED = {**UPRIGHT, "guided": True}
SLIDES = {**GUIDED, "mu_max": 0.3, "mu_slide": 0.3, "slip_x_start": 150.0}
ROLLS, FOUR = {"wheel": Wheel()}, {name: Wheel() for name in ("fl", "fr", "rl", "rr")}
SLIDING = {"wheel": Wheel(slides=True)}
TWO = {name: Wheel() for name in ("left", "right")}
AT_SPEED = 12.0  # m/s
AXLES = {name: Wheel(guided=True, v=AT_SPEED, follows="yaw") for name in ("front", "rear")}
STEPS, WINDOW, DIVERGED = 250, 20, 1e3
BUSHING, SHAFT = (2e5, 4e3), (3e3, 40.0)


def steered(c: float) -> tuple:
    """Start values, wheels, bodies and links of a car in one track, whose wheels head where its body does."""
    arms = {"front": {"body": 1.0, "yaw": 1.2}, "rear": {"body": 1.0, "yaw": -1.4}}
    start = {**GUIDED, "phi_dot_start": -AT_SPEED / Wheel.R}
    return start, AXLES, {"body": 1200.0, "yaw": 1900.0}, [(2e5, c, (name, "Y"), end) for name, end in arms.items()]


def at_speed(v: float, lean: tuple, turn: tuple) -> tuple:
    """A free wheel that links hold upright and straight."""
    links = [(*lean, ("wheel", "lean"), None), (*turn, ("wheel", "turn"), None)]
    return {**UPRIGHT, "phi_dot_start": -v / Wheel.R}, {"wheel": Wheel(v=v)}, {}, links


# start values, wheels, bodies, links
COUPLINGS = {
    "a bushing on a body": (GUIDED, ROLLS, {"body": 300.0}, [(*BUSHING, ("wheel", "X"), "body")]),
    "a stiff, hardly damped link": (GUIDED, ROLLS, {"body": 300.0}, [(2e5, 600.0, ("wheel", "X"), "body")]),
    "a bushing, the wheel locked": (SLIDES, SLIDING, {"body": 300.0}, [(*BUSHING, ("wheel", "X"), "body")]),
    "four wheels on one beam": (GUIDED, FOUR, {"beam": 150.0}, [(*BUSHING, (name, "X"), "beam") for name in FOUR]),
    "a drive shaft, spinning": (SLIDES, SLIDING, {"engine": 0.6}, [(*SHAFT, ("wheel", "spin"), "engine")]),
    "a drive shaft and a bushing": (
        GUIDED,
        ROLLS,
        {"engine": 0.6, "body": 300.0},
        [(*SHAFT, ("wheel", "spin"), "engine"), (*BUSHING, ("wheel", "X"), "body")],
    ),
    "a camber link": (UPRIGHT, ROLLS, {"hub": 2.0}, [(4e4, 400.0, ("wheel", "lean"), "hub"), (2e4, 50.0, "hub", None)]),
    "two wheels on a body that yaws": (
        GUIDED,
        TWO,
        {"body": 300.0, "yaw": 60.0},
        [(*BUSHING, (name, "X"), {"body": 1.0, "yaw": b}) for name, b in (("left", -0.8), ("right", 0.6))],
    ),
    "a car at speed, across": steered(2e3),
    "a free wheel at 10 m/s": at_speed(10.0, (2e3, 60.0), (2e3, 60.0)),
    "a free wheel at 30 m/s": at_speed(30.0, (2e3, 60.0), (2e3, 60.0)),
    "a free wheel at 30 m/s, its turn weakly held": at_speed(30.0, (2e4, 400.0), (500.0, 5.0)),
}


class Coupled:
    """The coupling, and its motion under held forces."""

    def __init__(self, new, start, wheels, bodies, links, kick: float) -> None:
        self.links = [(k, c, self.moves(first, 1), self.moves(second, -1)) for k, c, first, second in links]
        self.bodies, self.properties = bodies, wheels
        start = start if bodies else {**start, "theta_dot_start": kick}
        self.wheels: dict[str, FMU2Wheel] = {name: new().start(**start) for name in wheels}
        self.x, self.v = dict.fromkeys(bodies, 0.0), {name: kick * (i + 1) for i, name in enumerate(bodies)}
        self.origin = {end: self.read(end)[0] for *_, first, second in self.links for end in first | second}

    @staticmethod
    def moves(end, sign: int) -> dict:
        """What moves with an end of a link, wheels' directions and bodies, and how far."""
        return {of: sign * ratio for of, ratio in (end if isinstance(end, dict) else {end: 1} if end else {}).items()}

    def read(self, of) -> np.ndarray:
        """Displacement and velocity of a wheel in a direction, or of a body."""
        return np.array((self.x[of], self.v[of]) if of in self.bodies else self.wheels[of[0]].get(*SIGNALS[of[1]][:2]))

    def step(self, h: float) -> bool:
        """Over h; False where a wheel ends its run."""
        forces = dict.fromkeys(self.origin, 0.0)
        for k, c, first, second in self.links:
            ends = first | second
            x, v = np.sum([ratio * (self.read(of) - (self.origin[of], 0)) for of, ratio in ends.items()], axis=0)
            for of, ratio in ends.items():
                forces[of] -= ratio * (k * x + c * v)
        for name, wheel in self.wheels.items():
            if body := self.properties[name].follows:
                heading = self.x[body] + h * self.v[body]  # before this step's forces
                assert wheel.set(psi_dot_guide=(heading - wheel.get("psi")[0]) / h) == OK
        for of, force in forces.items():
            if of in self.bodies:
                a = force / self.bodies[of]
                self.x[of] += self.v[of] * h + a * h**2 / 2
                self.v[of] += a * h
            else:
                assert self.wheels[of[0]].set(**{SIGNALS[of[1]][2]: force}) == OK
        ended = [wheel.step(h) != OK for wheel in self.wheels.values()]
        return not any(ended)

    def state(self) -> np.ndarray:
        return np.array([self.read(of)[1] for of in self.origin])


def grows(new: Callable[..., FMU2Wheel], coupling: tuple, h: float) -> bool:
    """Whether the difference of two runs, in its largest signal, swings wider after many steps than after few, or
    has diverged before."""
    start, *rest = coupling
    runs = [Coupled(new, start, *rest, kick) for kick in (1e-4, 1.1e-4)]
    sizes = []
    for _ in range(STEPS):
        if False in [run.step(h) for run in runs]:
            return True
        sizes.append(float(np.abs(runs[1].state() - runs[0].state()).max()))
        if sizes[-1] > DIVERGED * max(sizes[:WINDOW]):
            return True
    free = min(sizes[-WINDOW:])  # a free motion of the whole stays
    return max(sizes[-WINDOW:]) - free > max(sizes[:WINDOW])


@pytest.mark.parametrize("name", COUPLINGS)
def test_couplings_are_stable_below_the_limit_of_their_step_and_diverge_above_it(wheel, name: str):
    _, wheels, bodies, links = coupling = COUPLINGS[name]
    limit = step_limit(wheels, bodies, links)
    assert not grows(wheel, coupling, 0.95 * limit)
    assert grows(wheel, coupling, 1.05 * limit)


def test_a_held_link_without_damping_has_no_stable_step():
    assert step_limit({}, {"body": 300.0}, [(2e5, 0.0, "body", None)]) == 0


def test_speed_lowers_the_limit_of_a_car_whose_links_across_are_weakly_damped():
    def limit(v: float, c: float) -> float:
        _, wheels, bodies, links = steered(c)
        return step_limit({name: replace(wheel, v=v) for name, wheel in wheels.items()}, bodies, links)

    weak, strong = ([limit(v, c) for v in (0.0, AT_SPEED)] for c in (2e3, 2e4))
    assert weak[1] < 0.8 * weak[0]
    within(abs(strong[1] / strong[0] - 1), 0.01, "change of the limit by the speed under strong damping")
    assert limit(80.0, 2e3) == 0  # nor is the car itself stable
