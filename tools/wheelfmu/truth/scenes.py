"""The scenes of tests and reports as data: what differs from the paper's free wheel. SI; names of modelDescription.xml.

Every scene can be given to the FMU (start values, inputs) and to the independent reference (wheel, motion, inputs).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from math import inf, pi, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wheelfmu.fmu.driver import Values
from wheelfmu.truth.reference import Road, Solution, Start, Wheel, solve, solve_stiffly
from wheelfmu.truth.reference.carried import Carried, Piece

from .kept import kept
from .schedule import Schedule

THETA_0 = 5 * pi / 12  # the paper's start
PAPER = Wheel()
AT_REST = {"theta_start": pi / 2, "phi_dot_start": 0.0}  # upright
SWINGS = {"psi_dot_start": 6.0, "theta_dot_start": 5.0, "phi_dot_start": 4.0}  # so fast that the wheel lifts off
PULLED: Values = {"keep_contact": True, **SWINGS}


def wheel_of(start: Values) -> Wheel:
    """The reference's wheel with these start values of the FMU."""
    known = {f.name for f in fields(Wheel)}
    return Wheel(**{name: value for name, value in start.items() if name in known})


def motion_of(start: Values) -> Start:
    """The reference's start with these start values of the FMU."""
    names = {f"{f.name}_start": f.name for f in fields(Start)}
    return Start(**{names[name]: value for name, value in start.items() if name in names})


class Started:
    """What begins with `start`, changes of the FMU's start values, and lasts for `duration`, s, under inputs; also as
    the reference has it, and solves it."""

    start: Values
    duration: float
    inputs: Schedule

    @property
    def wheel(self) -> Wheel:
        return wheel_of(self.start)

    @property
    def motion(self) -> Start:
        return motion_of(self.start)

    @property
    def road(self) -> Road:
        mu_slide, *slip = (float(self.start.get(name, 0)) for name in ("mu_slide", "slip_x_start", "slip_y_start"))
        return Road(float(self.start.get("mu_max", inf)), mu_slide, tuple(slip))

    def solved(self, times: ArrayLike | None = None, **how: float) -> Solution:
        """By the reference, at `times` or at 51 instants of equal spacing."""
        if self.start.get("friction_law") == "regularized":
            how["omega_s"] = float(self.start["omega_s"])
        how = {"keep_contact": bool(self.start.get("keep_contact", False)), **how}
        asked = [float(t) for t in np.ravel(np.linspace(0, self.duration, 51) if times is None else times)]
        wheel, motion, road = self.wheel, self.motion, self.road
        question = (wheel, motion, asked, self.inputs.pieces, road, sorted(how.items()))
        return kept(question, lambda: solve(wheel, motion, asked, self.inputs.for_reference(), road, **how))

    def solved_stiffly(self, times: ArrayLike) -> Solution:
        """Under a regularized law, however narrow, rolling without inputs."""
        asked, omega_s = [float(t) for t in np.ravel(times)], float(self.start.get("omega_s", 1e-3))
        wheel, motion = self.wheel, self.motion
        return kept(("stiffly", wheel, motion, asked, omega_s), lambda: solve_stiffly(wheel, motion, asked, omega_s))


@dataclass(frozen=True)
class Scene(Started):
    start: Values = field(default_factory=dict)
    duration: float = 10.0
    inputs: Schedule = Schedule()


def carried(start: Values, pieces: Sequence[Piece], times: Sequence[float]) -> tuple[dict[str, NDArray], list]:
    """On a carrier that leads the axle piece by piece: columns, and the transitions, by its own reference."""
    scene, omega_s = Scene(start), float(start.get("omega_s", 0))

    def solved() -> tuple[dict[str, NDArray], list]:
        one = Carried(scene.wheel, scene.motion, scene.road, omega_s)
        return one.run(pieces, times), one.transitions

    return kept(("carried", scene.wheel, scene.motion, scene.road, omega_s, pieces, [*map(float, times)]), solved)


GENERAL = {"J_x": 0.7, "J_y": 1.2, "J_z": 1.8}
FORCES = {"F_X": (0, 6, -2.5, 0.2), "F_Y": (2, -1, -0.5, 0.1), "F_Z": (0, -5, 2, -0.2)}
MOMENTS = {"M_1": (0.3, 0, -0.1), "M_2": (0, 0.4, -0.1), "M_3": (0, 1.5, -0.6, 0.05)}
PUSH = Schedule(((0.0, FORCES | MOMENTS),))
LOAD = Schedule(((0.0, {"F_X": 3.0, "F_Y": -2.0, "F_Z": 5.0, "M_1": 0.3, "M_3": -0.2}),))
BRAKE = Schedule(((0.0, {"M_3": 4.0}), (0.3, {"M_3": -2.0}), (1.0, {"M_3": (0, 2), "F_Y": 3.0})))

SCENES = {
    "free": Scene(),
    "friction": Scene({"s": 0.03}),
    "regularized": Scene({"s": 0.03, "friction_law": "regularized", "method": "bdf"}),
    "stiff law": Scene({"s": 0.03, "friction_law": "regularized", "omega_s": 1e-6}),
    "fast rolling": Scene({"phi_dot_start": -60.0}, 1.0),
    "fast spin the other way": Scene({"s": 0.001, "phi_dot_start": 60.0}, 1.0),
    "near flat": Scene({"theta_start": pi / 6, "psi_dot_start": 0.1, "phi_dot_start": 0.0, "keep_contact": True}, 2.0),
    "thin disc": Scene({"r": 0.0, "s": 0.01}, 5.0),
    "general inertia": Scene(GENERAL, 5.0),
    "general inertia, friction": Scene({**GENERAL, "s": 0.03}, 5.0),
    "light friction": Scene({"s": 1e-4}, 5.0),
    "heavy friction": Scene({**GENERAL, "s": 0.2}, 5.0),
    "heavy friction, J_x = J_y": Scene({"s": 0.2}, 5.0),
    "past upright": Scene({"s": 0.03, "theta_start": 1.9, "psi_dot_start": 0.5, "phi_dot_start": 3.0}, 5.0),
    "loaded": Scene({}, inputs=LOAD),
    "pushed": Scene({"s": 0.02}, 5.0, PUSH),
    "pushed, general inertia": Scene({**GENERAL, "s": 0.01}, 5.0, PUSH),
    "braked": Scene({"s": 0.01}, 2.0, BRAKE),
}


# Six inputs that change all the time: amplitude (N and N.m), rate (rad/s) and phase of a sine each.
SINES = {"F_X": (3.0, 2.0, 0.0), "F_Y": (2.0, 3.0, pi / 2), "F_Z": (-5.0, 1.0, 0.0)}
SINES |= {"M_1": (0.3, 1.0, pi / 2), "M_2": (0.2, 2.0, 0.0), "M_3": (0.5, 3.0, 0.0)}


def sines(t: float, order: int = 0) -> tuple[float, ...]:
    """The six inputs at t, or their derivatives of this order."""
    return tuple(a * w**order * sin(w * t + p + order * pi / 2) for a, w, p in SINES.values())


# Start values of one scene of every kind: every formulation, method and law of rolling resistance, and a slide.
KINDS: dict[str, Values] = {
    name: SCENES[name].start
    for name in ("free", "friction", "general inertia", "general inertia, friction", "regularized", "stiff law")
} | {
    "multibody": {**GENERAL, "formulation": "multibody", "s": 0.03},
    "multibody, adams": {**GENERAL, "formulation": "multibody", "method": "adams"},
    "multibody, bdf": {"formulation": "multibody", "method": "bdf", "friction_law": "regularized", "s": 0.03},
    "adams": {"method": "adams", "s": 0.03},
    "runge_kutta": {"method": "runge_kutta"},
    "guided": {"guided": True, **GENERAL, "s": 0.03},  # stops after 1.4 s
    "sliding": {"mu_max": 0.45, "mu_slide": 0.4},  # from 0.57 to 0.96 s and from 1.87 to 2.19 s
    "sliding, stiff law": {**SCENES["stiff law"].start, "mu_max": 0.45, "mu_slide": 0.4},
}

# Every formulation by every method, forced.
FORCED: list[Values] = [{"formulation": form, "method": method} for form in (2, 3) for method in (1, 2, 3, 4)]
