"""The formulations agree on what every parameter does: each is changed in turn, while the wheel rolls and slides.

A parameter that one of them forgets shows as a difference; one that both forget, as a motion that it does not change.
"""

import numpy as np
import pytest
from fmpy import read_model_description
from support.bounds import beyond, within

from wheelfmu.fmu.driver import OK
from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.motion import Library
from wheelfmu.truth.schedule import Schedule

VARIABLES = read_model_description(str(ROOT / "modelDescription.xml"), validate=False).modelVariables
PARAMETERS = {v.name: float(v.start) for v in VARIABLES if v.causality == "parameter" and v.type == "Real"}
FORCES = {"F_X": (1.0, 2.0), "F_Y": (-2.0,), "M_1": (0.3,), "M_2": (-0.2,), "M_3": (0.5,), "M_brake": (0.4,)}
PUSH = Schedule(((0.0, FORCES),))
ROLLS = {
    **{"J_x": 0.7, "J_y": 1.2, "s": 0.03, "slope": 0.1, "slope_direction": 0.5, "keep_contact": True},
    **{"psi_start": 0.4, "theta_start": 1.2, "phi_start": 0.3, "psi_dot_start": 0.5, "theta_dot_start": -0.3},
    **{"phi_dot_start": 3.0, "X_O_start": 0.2, "Y_O_start": -0.1, "mu_max": 5.0},
}
SCENES = {
    "rolls": ROLLS,
    "under a regularized law": {**ROLLS, "friction_law": 2, "omega_s": 1.0},
    "loses its grip": {**ROLLS, "mu_max": 0.3, "mu_slide": 0.25},
    "slides": {**ROLLS, "mu_max": 0.3, "mu_slide": 0.25, "slip_x_start": 0.5, "slip_y_start": -0.3},
}
TIMES = np.linspace(0, 0.5, 11)
ALIKE = 1e-8  # of the largest value; ten times the tolerance, and what events add


def changed(parameter: str, start: dict) -> dict:
    """By a hundredth, of what is zero by that much."""
    value = start.get(parameter, PARAMETERS[parameter])
    return {**start, parameter: value * 1.01 or 0.01}


def motion(library: Library, start: dict, formulation: int) -> dict[str, np.ndarray]:
    run = library.simulate(TIMES, 1e-9, PUSH, **start, formulation=formulation, method=4)
    counts = ("t", "n_steps", "n_rhs", "n_jac", "n_roots", "n_events", "n_restarts", "contact_mode", "friction_mode")
    return {name: values for name, values in run.columns.items() if name not in counts}


def difference(a: dict[str, np.ndarray], b: dict[str, np.ndarray]) -> dict[str, float]:
    """Of each variable, relative to its largest value."""
    return {name: float(np.abs(b[name] - a[name]).max() / (np.abs(a[name]).max() or 1)) for name in a}


@pytest.fixture(scope="module")
def usual(library: Library) -> dict[str, dict[str, np.ndarray]]:
    return {scene: motion(library, start, 2) for scene, start in SCENES.items()}


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_each_parameter_does_the_same_in_both_formulations_and_does_something(library, usual, parameter: str) -> None:
    effects = []
    for scene, start in SCENES.items():
        new = changed(parameter, start)
        with library.wheel() as wheel:
            if wheel.set(**new) != OK or wheel.initialise() != OK:
                continue  # a slip without sliding friction
        reduced = motion(library, new, 2)
        within(difference(reduced, motion(library, new, 3)), ALIKE, f"{scene}: multibody off reduced, relative")
        effects.append(max(difference(usual[scene], reduced).values()))
    beyond(max(effects), 1e-5, "effect of the parameter, relative")
