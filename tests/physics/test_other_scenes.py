"""Scenes beside the paper's, that roll and that slide, against the independent reference of truth/reference.

Fast rolling, near flat, thin disc, J_x != J_y, heavy and light friction, past upright, spin either way, and the six
inputs: cases.py; thrown, driven, locked, on a slope, on a slippery road: sliding.py.
"""

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.truth.cases import CASES, error, transitions_gap
from wheelfmu.truth.errors import kind_errors
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import THETA_0, Scene
from wheelfmu.truth.sliding import SLIDES

TOLERANCES = (1e-5, 1e-8, 1e-10, 1e-11)
# With the errors allowed, in tolerances; at 1e-11 the reference's counts.
SCENES = {name: (scene, (50, 10, 10, 10)) for name, scene in CASES.items()}
SCENES |= {f"slides: {name}": (scene, (3, 3, 3, 10)) for name, scene in SLIDES.items() if name != "jams"}


def growth(library: Library, scene: Scene) -> float:
    """Of errors of the start: the largest change of an output over that of theta, spin or slip."""
    off, times = 1e-8, np.linspace(0, scene.duration, 51)
    start = {"theta_start": THETA_0, "phi_dot_start": -2.0, "slip_x_start": 0.0} | scene.start
    moved = [name for name in ("theta_start", "phi_dot_start", "slip_x_start") if name in scene.start or start[name]]
    exact, *ends = (
        library.simulate(times, 1e-12, scene.inputs, **{**scene.start, **change})
        for change in ({}, *({name: start[name] + off} for name in moved))
    )
    return max(error / off for end in ends for error in kind_errors(end, exact, 1.0).values())


@pytest.mark.parametrize(("scene", "bounds"), SCENES.values(), ids=SCENES)
def test_the_error_of_every_output_is_that_of_the_tolerance(library: Library, scene: Scene, bounds: tuple) -> None:
    """Where an error of the start grows more than a hundredfold, by so much more."""
    grown = max(1.0, growth(library, scene) / 100)
    for formulation in (1, 2, 3):
        for tolerance, most in zip(TOLERANCES, bounds, strict=True):
            off = error(library, scene, tolerance, 1.0, formulation=formulation)
            within(off / tolerance, most * grown, f"error of formulation {formulation}, in tolerances of {tolerance:g}")
    name, value = ("mu_slide", scene.road.mu_slide) if scene.road.mu_slide else ("J_z", scene.wheel.J_z)
    other = error(library, scene, 1e-10, 1.0, **{name: value * (1 - 1e-6)})
    beyond(other / 1e-10, 100, f"error with another {name}, in tolerances")


@pytest.mark.parametrize("name", [n for n, case in CASES.items() if case.wheel.s > 0])
def test_the_same_transitions_of_friction_at_the_same_instants(library: Library, name: str) -> None:
    case, s = CASES[name], CASES[name].wheel.s
    within(transitions_gap(library, case, s), 7e-8, "instants of the transitions, s")
    if case.solved().events[1:]:
        beyond(transitions_gap(library, case, s * (1 + 1e-4)), 3e-6, "instants with another s, s")
