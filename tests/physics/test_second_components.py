"""The second component where the first is tested, and the reverse. What is true along X is so along Y, by a quarter
turn of the scene: motions, rates, derivatives, model exchange.
"""

from math import pi

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu.driver import DERIVATIVES, STATES, Array, FMU2Wheel, Values
from wheelfmu.truth.exchange import exchange
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import GENERAL
from wheelfmu.truth.sliding import ROAD, THROWN

# Variables along X and along Y: after a quarter turn the second is the first, and the first the second, negative.
PAIRS = [("X_O", "Y_O"), ("X_O_dot", "Y_O_dot"), ("lambda_1", "lambda_2"), ("X_C", "Y_C"), ("F_X", "F_Y")]
PAIRS += [("X_O_start", "Y_O_start")]
ODD: Values = {**GENERAL, "psi_dot_start": 0.7, "theta_dot_start": 0.3, "phi_dot_start": -5.0, "phi_start": 0.4}
PLACE: Values = {"psi_start": 0.3, "slope": 0.2, "slope_direction": 0.5, "X_O_start": 3.0, "Y_O_start": -7.0}
HUB: Values = {"guided": True, "theta_start": 1.2, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
SCENES: dict[str, Values] = {
    "unfolded": {"psi_dot_start": 0.7, "psi_start": 0.3, "X_O_start": 3.0, "Y_O_start": -7.0},
    "rolls": {**ODD, **PLACE, "s": 0.02},
    "multibody": {**ODD, **PLACE, "s": 0.02, "formulation": 3},
    "regularized": {**ODD, **PLACE, "s": 0.02, "friction_law": 2, "omega_s": 0.5},
    "slides": {**ODD, **PLACE, **ROAD, **THROWN, "s": 0.01},
    "slides, multibody": {**ODD, **PLACE, **ROAD, **THROWN, "formulation": 3},
    "steered": {**ODD, **PLACE, **HUB, "psi_dot_guide": 0.5, "theta_dot_guide": -0.2, "s": 0.01},
    "steered, slides": {**ODD, **PLACE, **HUB, **ROAD, **THROWN, "psi_dot_guide": 0.5, "theta_dot_guide": -0.2},
}
each_scene = pytest.mark.parametrize("scene", SCENES)
LOAD = {"F_X": (3.0, 2.0, -1.0), "F_Y": (-5.0, 1.0, 4.0), "M_1": (0.3, 0.5), "M_2": (-0.4, 0.2), "M_3": (0.5,)}


def quarter(names: list[str]) -> Array:
    """The matrix that leads values of these names to those of the turned scene, but for headings."""
    matrix = np.eye(len(names))
    for first, second in PAIRS:
        if first in names:
            i, k = names.index(first), names.index(second)
            matrix[[i, k]] = matrix[[k, i]]
            matrix[i] *= -1
    return matrix


def turned(values: Values) -> Values:
    found = {**values, "psi_start": float(values.get("psi_start", pi / 2)) + pi / 2}
    found["slope_direction"] = float(values.get("slope_direction", 0.0)) + pi / 2
    for first, second in PAIRS:
        if first in values:
            found[first], found[second] = -float(values[second]), values[first]
    return found


def turned_load(load: dict[str, tuple[float, ...]]) -> dict[str, tuple[float, ...]]:
    return {**load, "F_X": tuple(-c for c in load["F_Y"]), "F_Y": load["F_X"]}


def outputs(w: FMU2Wheel) -> list[str]:
    return [name for name in w.reals if name != "psi"]


def both(wheel, scene: str, load=LOAD) -> tuple[FMU2Wheel, FMU2Wheel]:
    plain = wheel().start(tolerance=1e-11, **SCENES[scene])
    around = wheel().start(tolerance=1e-11, **turned(SCENES[scene]))
    return plain.give(load), around.give(turned_load(load))


@each_scene
def test_a_scene_turned_by_a_quarter_moves_so_in_every_output_and_rate(wheel, scene):
    load = dict.fromkeys(LOAD, (0.0,)) if scene == "unfolded" else LOAD
    for t in (0.0, 0.1, 0.25):
        plain, around = both(wheel, scene, load)
        if t:
            plain.to(t)
            around.to(t)
        names = outputs(plain)
        found, expected = np.array(around.get(*names)), quarter(names) @ plain.get(*names)
        size = 1 + np.abs(expected)
        within(dict(zip(names, np.abs(found - expected) / size, strict=True)), 1e-8, f"off the quarter turn at {t} s")
        beyond(np.abs((found - plain.get(*names)) / size).max(), 0.1, "distance from the scene that is not turned")
        rated = [name for name in names if plain.variables[name].causality == "output"]
        found, expected = np.array(around.rates(rated)()), quarter(rated) @ np.array(plain.rates(rated)())
        size = 1 + np.abs(expected)
        within(dict(zip(rated, np.abs(found - expected) / size, strict=True)), 1e-7, f"rate off the turn at {t} s")


@each_scene
def test_derivatives_by_what_points_along_Y_are_those_by_what_points_along_X(wheel, scene):
    knowns = ["F_X", "F_Y", "M_1", "M_2", "M_3", "F_Z"]
    plain, around = both(wheel, scene)
    names = outputs(plain)
    off = around.jacobian(names, knowns) - quarter(names) @ plain.jacobian(names, knowns) @ quarter(knowns).T
    within(np.abs(off).max(), 1e-9, "derivatives by inputs off the quarter turn")
    starts = ["X_O_start", "Y_O_start", "psi_start", "theta_start", "slope", "slope_direction", *knowns]
    plain = wheel().initializing(**SCENES[scene]).give(LOAD)
    around = wheel().initializing(**turned(SCENES[scene])).give(turned_load(LOAD))
    own, found = plain.jacobian(names, starts), around.jacobian(names, starts)
    expected = quarter(names) @ own @ quarter(starts).T
    size = 1 + np.abs(expected).max(axis=1)[:, None]
    within(np.abs((found - expected) / size).max(), 1e-7, "derivatives by parameters, relative")
    beyond(np.abs((found - own) / size).max(), 0.5, "not turned")
    own = plain.jacobian(["X_O", "Y_O"], ["X_O_start", "Y_O_start"])
    within(np.abs(own - np.eye(2)).max(), 1e-9, "derivatives of a place by its own start off one")


@pytest.mark.parametrize("scene", ["unfolded", "rolls", "regularized"])
def test_in_model_exchange_too(library: Library, scene: str) -> None:
    shift = np.zeros(len(STATES))
    shift[STATES.index("psi")] = pi / 2
    push = {name: row[0] for name, row in LOAD.items()}
    unknowns = [*DERIVATIVES, "lambda_1", "lambda_2", "lambda_3", "X_C", "Y_C", "lambda_x", "lambda_y", "E"]
    states, loads = list(STATES), ["F_X", "F_Y", "M_1", "M_2"]
    with exchange(library, **SCENES[scene]) as plain, exchange(library, **turned(SCENES[scene])) as around:
        turn = quarter(states)
        for k in range(4):
            x = plain.x() + 0.05 * k * plain.derivatives()
            plain.place(0.1 * k, x)
            around.place(0.1 * k, turn @ x + shift)
            plain.put(**push)
            around.put(**{name: row[0] for name, row in turned_load(LOAD).items()})
            off = around.derivatives() - quarter(list(DERIVATIVES)) @ plain.derivatives()
            within(np.abs(off).max(), 1e-10, "derivatives off the quarter turn")
            within(np.abs(around.indicators() - plain.indicators()).max(), 1e-10, "indicators off the quarter turn")
            for known in (states, loads):
                off = around.jacobian(unknowns, known) - quarter(unknowns) @ plain.jacobian(unknowns, known) @ (
                    quarter(known).T
                )
                within(np.abs(off).max(), 1e-8, "directional derivatives off the quarter turn")
        for name in states:  # each state by its own name
            (value,) = around.get(name)
            around.put(**{name: value + 0.01})
            assert around.x()[states.index(name)] == value + 0.01
            assert np.count_nonzero(around.x() - np.array(around.get(*states))) == 0
