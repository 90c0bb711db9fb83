"""A scene that is turned about the vertical, by a quarter turn or by very many turns, moves and answers as before:
values, rates and derivatives of every path, for any inertia, rolling, sliding and carried.

After a quarter turn Y takes the place of X, and -X that of Y. An angle after many turns is the same angle: it is
compared with the one at home, atan2(sin, cos), which the C library reduces exactly.
"""

from collections.abc import Callable
from math import atan2, cos, pi, sin

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within
from support.differences import LOADS, outputs

from wheelfmu.fmu.driver import DERIVATIVES, STATES, Array, FMU2Wheel, Values
from wheelfmu.truth.exchange import exchange
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import GENERAL
from wheelfmu.truth.sliding import ROAD, THROWN

Load = dict[str, tuple[float, ...]]
# Variables along X and along Y: after a quarter turn the second is the first, and the first the second, negative.
PAIRS = [("X_O", "Y_O"), ("X_O_dot", "Y_O_dot"), ("lambda_1", "lambda_2"), ("X_C", "Y_C"), ("F_X", "F_Y")]
PAIRS += [("X_O_start", "Y_O_start")]
ANGLES = {"psi_start": 0.7, "phi_start": -2.3, "slope_direction": 1.9}
ODD: Values = {**GENERAL, "slope": 0.3, "psi_dot_start": 0.7, "theta_dot_start": 0.3, "phi_dot_start": -6.0}
ODD |= {"X_O_start": 3.0, "Y_O_start": -7.0}
CARRIED: Values = {"guided": True, "theta_start": 1.2, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
CARRIED |= {"psi_dot_guide": 0.4, "theta_dot_guide": -0.2}
SCENES: dict[str, Values] = {
    "rolls": {**ODD, "s": 0.02},
    "rolls, J_x = J_y": {**ODD, "J_x": 0.9, "J_y": 0.9},
    "rolls, multibody": {**ODD, "s": 0.02, "formulation": 3},
    "regularized": {**ODD, "s": 0.02, "friction_law": 2, "omega_s": 2.0},
    "slides": {**ODD, **ROAD, **THROWN, "s": 0.02},
    "slides, multibody": {**ODD, **ROAD, **THROWN, "formulation": 3},
    "steered": {**ODD, **CARRIED, "s": 0.02},
    "steered, slides": {**ODD, **CARRIED, **ROAD, **THROWN},
}
LOAD: Load = {"F_X": (-3.0, 5.0, -1.0), "F_Y": (4.0, -7.0, 4.0), "M_1": (0.3, 0.5), "M_2": (0.5, 2.0), "M_3": (0.5,)}
INPUTS = (*LOADS, "psi_dot_guide", "theta_dot_guide")


def home(angle: float) -> float:
    return atan2(sin(angle), cos(angle))


class Quarter:
    """off: how far the two scenes may lie apart, relative."""

    off = 1e-7

    @staticmethod
    def matrix(names) -> Array:
        """Leads values of these names to those of the turned scene, but for headings."""
        names, matrix = [*names], np.eye(len(names))
        for first, second in PAIRS:
            if first in names:
                i, k = names.index(first), names.index(second)
                matrix[[i, k]] = matrix[[k, i]]
                matrix[i] *= -1
        return matrix

    @staticmethod
    def scenes(values: Values) -> tuple[Values, Values]:
        turned = {**values, "psi_start": values["psi_start"] + pi / 2}
        turned["slope_direction"] = values["slope_direction"] + pi / 2
        return values, turned | {"X_O_start": -values["Y_O_start"], "Y_O_start": values["X_O_start"]}

    @staticmethod
    def load(load: Load) -> Load:
        return {**load, "F_X": tuple(-c for c in load["F_Y"]), "F_Y": load["F_X"]}


class Many:
    """By `far` rad, which are no whole number of turns."""

    off = 1e-9

    def __init__(self, far: float) -> None:
        self.far = far

    @staticmethod
    def matrix(names) -> Array:
        return np.eye(len(names))

    def scenes(self, values: Values) -> tuple[Values, Values]:
        away = {name: values[name] + self.far for name in ANGLES}
        return values | {name: home(angle) for name, angle in away.items()}, values | away

    @staticmethod
    def load(load: Load) -> Load:
        return load


TURNS = {"a quarter turn": Quarter()} | {f"{far:g} rad": Many(far) for far in (1e5, -3e8, 7e10, -9e11)}
each_turn = pytest.mark.parametrize("turn", TURNS.values(), ids=TURNS)


def moving(make: Callable[..., FMU2Wheel], values: Values, load: Load) -> tuple[list[str], list[str], Array]:
    """Outputs and their rates at the start and later, with the number of steps; psi and phi have other digits."""
    w = make().start(tolerance=1e-11, **values).give(load)
    names, columns = [name for name in outputs(w) if name not in ("psi", "phi")], []
    for t in (0.0, 0.1, 0.25):
        w.to(*[t] if t else [])
        columns += [[*found, *w.get("n_steps")] for found in (w.get(*names), w.rates(names)())]
    return [*names, "n_steps"], [], np.array(columns).T


def by_parameters(make: Callable[..., FMU2Wheel], values: Values, load: Load) -> tuple[list[str], list[str], Array]:
    w = make().initializing(**values).give(load)
    knowns = [name for name, v in w.variables.items() if v.causality == "parameter" and v.type == "Real"]
    return w.reals, [*knowns, *INPUTS], w.jacobian(w.reals, [*knowns, *INPUTS])


def by_inputs(make: Callable[..., FMU2Wheel], values: Values, load: Load) -> tuple[list[str], list[str], Array]:
    """Where loads were just set, after a while."""
    w = make().start(tolerance=1e-11, **values).to(0.02).give(load)
    return w.reals, [*INPUTS], w.jacobian(w.reals, INPUTS)


def apart(found: Array, expected: Array) -> float:
    """Over the largest of each row and column; a home is off by the rounding of cos and sin."""
    size = np.abs(expected)
    scale = 1 + np.minimum(size.max(axis=0)[None, :], size.max(axis=1)[:, None])
    return float((np.abs(found - expected) / scale).max())


@each_turn
@pytest.mark.parametrize("path", (moving, by_parameters, by_inputs))
@pytest.mark.parametrize("scene", SCENES)
def test_a_turned_scene_has_the_turned_values_rates_and_derivatives(wheel, scene, path, turn) -> None:
    plain, turned = turn.scenes(ANGLES | SCENES[scene])
    rows, columns, own = path(wheel, plain, LOAD)
    expected = turn.matrix(rows) @ own @ (turn.matrix(columns).T if columns else np.eye(own.shape[1]))
    found, other = (
        path(wheel, {**turned, "psi_start": turned["psi_start"] + more}, turn.load(LOAD))[2] for more in (0, 1e-3)
    )
    within(apart(found, expected), turn.off, f"{path.__name__}, relative")
    beyond(apart(other, expected), 1e-6, f"{path.__name__} at another heading, relative")


EXCHANGED = ("rolls", "rolls, J_x = J_y", "regularized")


@each_turn
@pytest.mark.parametrize("scene", EXCHANGED)
def test_in_model_exchange_too(library: Library, scene: str, turn) -> None:
    """Rates of the states, indicators, and derivatives by states and inputs."""
    forces = ("lambda_1", "lambda_2", "lambda_3", "lambda_y", "X_C", "Y_C", "mu_required", "tau", "v_y", "E")
    unknowns, knowns = (*DERIVATIVES, *forces), (*STATES, *LOADS)

    def answers(values: Values, load: Load) -> tuple[Array, Array, Array]:
        with exchange(library, **values) as w:
            w.put(**{name: row[0] for name, row in load.items()})
            return w.derivatives()[:, None], w.indicators()[:, None], w.jacobian(unknowns, knowns)

    plain, turned = turn.scenes(ANGLES | SCENES[scene])
    rates, indicators, slopes = answers(plain, LOAD)
    expected = turn.matrix(DERIVATIVES) @ rates, indicators, turn.matrix(unknowns) @ slopes @ turn.matrix(knowns).T
    for found, want in zip(answers(turned, turn.load(LOAD)), expected, strict=True):
        within(apart(found, want), turn.off, "off the turned ones, relative")
    for name in ANGLES if "=" not in scene else ("psi_start", "slope_direction"):
        other = answers({**turned, name: turned[name] + 1e-3}, turn.load(LOAD))
        beyond(apart(other[2], expected[2]), 1e-6, f"derivatives with another {name}, relative")


def test_each_state_of_model_exchange_has_its_own_name(library: Library) -> None:
    with exchange(library, **ANGLES | SCENES["rolls"]) as w:
        for k, name in enumerate(STATES):
            w.put(**{name: w.get(name)[0] + 0.01 * (k + 1)})
            assert w.x().tolist() == w.get(*STATES)


def test_angles_of_many_turns_are_read_as_they_were_set(wheel) -> None:
    for angle in (-3.0, 7.0, 1234.5, 1e12):
        w = wheel().start(psi_start=angle, phi_start=-angle, slope_direction=angle, s=0.03)
        assert w.get("psi", "phi", "slope_direction") == [angle, -angle, angle]


@pytest.mark.parametrize("scene", SCENES)
def test_a_distant_place_changes_the_place_alone(wheel, scene: str) -> None:
    here, far = {"X_O_start": 0.0, "Y_O_start": 0.0}, {"X_O_start": 3e9, "Y_O_start": -3e9}  # m
    near, away = (wheel().start(**ANGLES | SCENES[scene] | place).to(0.5) for place in (here, far))
    shape = [name for name in near.reals if name[:2] not in ("X_", "Y_", "E")] + ["n_steps"]
    assert near.get(*shape) == away.get(*shape)
    way = np.array(near.get("X_O", "Y_O"))
    within(np.abs(away.get("X_O", "Y_O") - way - (3e9, -3e9)).max(), 4 * EPSILON * 3e9, "path, m")
    beyond(np.abs(way).max(), 0.1, "path at all, m")


LEFT_ALONE: dict[str, tuple[Values, tuple[str, ...]]] = {
    "a free wheel": ({"psi_dot_start": 0.7, "phi_dot_start": -6.0}, ("lambda_1", "lambda_2", "X_C", "v_x", "lambda_y")),
    "a guided wheel": (
        {**GENERAL, "guided": True, "theta_start": 1.2, "phi_dot_start": -6.0},
        ("M_guide_1", "M_guide_2"),
    ),
}
STEER: Load = {"psi_dot_guide": (0.4, 0.5), "theta_dot_guide": (-0.2, 0.3)}


@pytest.mark.parametrize("case", LEFT_ALONE)
def test_rates_after_turns_that_the_motion_itself_has_made_are_those_of_a_start_at_home(wheel, case):
    """After hundreds of years; where a load or a carrier begins to act."""
    values, names = LEFT_ALONE[case]
    shapes = STEER if "guided" in case else LOAD
    far = wheel().start(**values).to(1e10)
    angles = far.get("psi", "phi")
    beyond(max(map(abs, angles)), 1e9, "angle, rad")
    start = {f"{name}_start": far.get(name)[0] for name in ("theta", "theta_dot", "psi_dot", "phi_dot")}
    found = np.array(far.give(shapes).rates(names)())

    def near(turn: float) -> Array:
        own = {**values, **start, "psi_start": home(angles[0]) + turn, "phi_start": home(angles[1]) + turn}
        return np.array(wheel().start(**own).give(shapes).rates(names)())

    at_home = near(0.0)
    size = np.abs(at_home).max()
    within(np.abs(found - at_home).max() / size, 3e-5, "rates off those at home, relative")  # of angles of 1e-5 rad
    beyond(np.abs(near(1e-3) - at_home).max() / size, 1e-4, "rates at another angle, relative")
