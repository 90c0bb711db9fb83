"""Scenes beside the paper's, and how far the FMU is from the independent reference of truth/reference in any scene."""

from dataclasses import replace
from math import pi

import numpy as np

from wheelfmu.truth.errors import instants_error, kind_errors
from wheelfmu.truth.motion import Library, start_values
from wheelfmu.truth.reference import Start, Wheel
from wheelfmu.truth.scenes import SCENES, Scene

NAMES: tuple[str, ...] = ("fast rolling", "fast spin the other way", "near flat", "thin disc", "general inertia")
NAMES += ("general inertia, friction", "light friction", "heavy friction", "heavy friction, J_x = J_y")
NAMES += ("past upright", "pushed", "pushed, general inertia", "braked")
# The ground may pull in all of them.
CASES = {name: replace(SCENES[name], start={**SCENES[name].start, "keep_contact": True}) for name in NAMES}


def error(library: Library, scene: Scene, tolerance: float | None = None, least: float = 0.0, **changes) -> float:
    """Largest error of an output or the energy over 51 instants, over the largest value of its kind or least."""
    want = scene.solved()
    got = library.simulate(want.t, tolerance, scene.inputs, **{**scene.start, **changes})
    return max(kind_errors(got, want, least).values())


def transitions_gap(library: Library, scene: Scene, s: float, tolerance: float | None = None) -> float:
    """Largest difference of the instants, s; infinite if the transitions differ."""
    run = library.simulate([0.0, scene.duration], tolerance, scene.inputs, **{**scene.start, "s": s})
    return instants_error(run.events, scene.solved().events[1:])


def random_scene(random: np.random.Generator, duration: float = 1.0) -> Scene:
    """Light to heavy friction or none, any inertia, any slope to 50 degrees, rates of a few rad/s; the ground pulls."""
    a, b, c = random.uniform(0.2, 0.9, 3)
    wheel = Wheel(
        r=random.uniform(0, 0.1), J_x=b + c, J_y=a + c, J_z=a + b,
        s=random.choice([0, random.uniform(0, 0.05)]),
        slope=random.uniform(0, 0.9), slope_direction=random.uniform(-pi, pi),
    )  # fmt: skip
    motion = dict(zip(("psi_dot", "theta_dot", "phi_dot"), random.normal(0, 2, 3), strict=True))
    motion |= dict(zip(("psi", "phi"), random.uniform(-pi, pi, 2), strict=True))
    start = start_values(wheel, Start(theta=random.uniform(0.8, 2.3), **motion))
    return Scene({**{name: float(value) for name, value in start.items()}, "keep_contact": True}, duration)
