"""Every path of derivatives after many turns: by the parameters before the run, by the direction of the slope, by the
inputs and the carrier's rates during it, in time, and by the states of model exchange. An angle of many turns is the
same angle, so all are those of the angle at home, atan2(sin, cos), for any inertia, rolling and sliding.
"""

from collections.abc import Callable
from math import atan2, cos, sin

import numpy as np
import pytest
from support.bounds import beyond, within
from support.differences import LOADS, difference, rates

from wheelfmu.fmu.driver import DERIVATIVES, STATES, Array, FMU2Wheel, Values
from wheelfmu.truth.exchange import exchange
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import GENERAL
from wheelfmu.truth.sliding import ROAD, THROWN

TURNED = ("psi_start", "phi_start", "slope_direction")
NEAR, MOVED = (0.7, -2.3, 1.9), (0.7001, -2.3001, 1.9001)
FAR = (1e5, -3e8, 7e10, -9e11)
ODD: Values = {**GENERAL, "slope": 0.3, "psi_dot_start": 0.7, "theta_dot_start": 0.3, "phi_dot_start": -6.0, "F_Y": 4.0}
ODD |= {"M_2": 0.5, "F_X": -3.0}
CARRIED: Values = {"guided": True, "theta_start": 1.2, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
SCENES: dict[str, Values] = {
    "rolls": {**ODD, "s": 0.02},
    "rolls, J_x = J_y": {**ODD, "J_x": 0.9, "J_y": 0.9},
    "rolls, multibody": {**ODD, "s": 0.02, "formulation": 3},
    "regularized": {**ODD, "s": 0.02, "friction_law": 2, "omega_s": 2.0},
    "slides": {**ODD, **ROAD, **THROWN, "s": 0.02},
    "slides, multibody": {**ODD, **ROAD, **THROWN, "formulation": 3},
    "steered": {**ODD, **CARRIED, "psi_dot_guide": 0.4, "theta_dot_guide": -0.2, "s": 0.02},
    "steered, slides": {**ODD, **CARRIED, **ROAD, **THROWN, "psi_dot_guide": 0.4, "theta_dot_guide": -0.2},
}
INPUTS = (*LOADS, "psi_dot_guide", "theta_dot_guide")
PUSH = {"F_X": (-3.0, 5.0), "F_Y": (4.0, -7.0), "M_2": (0.5, 2.0)}


def home(angle: float) -> float:
    return atan2(sin(angle), cos(angle))


def turned(angles: tuple[float, ...], far: float) -> Values:
    """The angles `far` radians further, which is no whole number of turns."""
    return {name: angle + far for name, angle in zip(TURNED, angles, strict=True)}


def brought_home(values: Values) -> Values:
    return {name: home(float(angle)) for name, angle in values.items()}


def by_parameters(make: Callable[..., FMU2Wheel], values: Values) -> Array:
    w = make().initializing(**values)
    knowns = [name for name, v in w.variables.items() if v.causality == "parameter" and v.type == "Real"]
    return w.jacobian(w.reals, [*knowns, *INPUTS])


def by_inputs(make: Callable[..., FMU2Wheel], values: Values) -> Array:
    """Just after the start, and where other values were set."""
    w = make().start(tolerance=1e-10, **values).to(0.02)
    first = w.jacobian(w.reals, INPUTS)
    return np.hstack([first, w.put(F_X=5.0, M_2=-0.3).jacobian(w.reals, INPUTS)])


def in_time(make: Callable[..., FMU2Wheel], values: Values) -> Array:
    w = make().start(tolerance=1e-10, **values).give(PUSH)
    return np.array([rates(w), rates(w.to(0.02))])


PATHS = (by_parameters, by_inputs, in_time)


def scaled(found: Array, scale: Array) -> float:
    return float((np.abs(found) / scale).max())


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("scene", SCENES)
def test_derivatives_after_many_turns_are_those_at_home(wheel, scene, path):
    """Over the largest of each row and column; a home is off by the rounding of cos and sin alone."""
    for far in FAR:
        angles = turned(NEAR, far)
        near = path(wheel, {**SCENES[scene], **brought_home(angles)})
        scale = 1 + np.minimum(np.abs(near).max(axis=0)[None, :], np.abs(near).max(axis=1)[:, None])
        off = path(wheel, {**SCENES[scene], **angles}) - near
        within(scaled(off, scale), 1e-9, f"derivatives {path.__name__} after {far:g} rad, relative")
        moved = path(wheel, {**SCENES[scene], **brought_home(turned(MOVED, far))}) - near
        beyond(scaled(moved, scale), 1e-6, f"derivatives {path.__name__} at other angles, relative")


@pytest.mark.parametrize("scene", ["rolls", "rolls, J_x = J_y", "regularized"])
def test_derivatives_by_the_states_after_many_turns_are_those_at_home(library: Library, scene: str) -> None:
    """psi and phi of the state after many turns, and the slope's direction, set to it during the run."""
    unknowns = (*DERIVATIVES, "lambda_1", "lambda_2", "lambda_3", "lambda_y", "X_C", "mu_required", "tau", "v_y")

    def slopes(angles: tuple[float, ...]) -> Array:
        with exchange(library, **SCENES[scene]) as w:
            x = w.x()
            x[STATES.index("psi")], x[STATES.index("phi")] = angles[:2]
            w.place(0.1, x)
            w.put(slope_direction=angles[2])
            return w.jacobian(unknowns, (*STATES, "F_X", "F_Y", "M_1", "M_2", "M_3"))

    for far in FAR:
        angles = tuple(angle + far for angle in NEAR)
        near = slopes(tuple(map(home, angles)))
        scale = 1 + np.minimum(np.abs(near).max(axis=0)[None, :], np.abs(near).max(axis=1)[:, None])
        within(scaled(slopes(angles) - near, scale), 1e-9, f"derivatives by the states after {far:g} rad, relative")
        for k in range(3):  # the partner: each of the three angles shows
            moved = list(map(home, angles))
            moved[k] += 1e-4
            shows = k != 1 or "=" not in scene
            beyond(scaled(slopes(tuple(moved)) - near, scale), 1e-6 if shows else -1, "derivatives at another angle")
    assert near[unknowns.index("psi_ddot"), STATES.index("phi")] != 0 or "=" in scene  # J_x != J_y


def test_the_direction_of_the_slope_after_many_turns_is_read_as_it_was_set_and_has_a_derivative(wheel):
    for far in FAR:
        w = wheel().initializing(**SCENES["rolls"], slope_direction=far)
        found = w.jacobian(["lambda_1", "lambda_2"], ["slope_direction"])[:, 0]
        assert w.get("slope_direction") == [far]
        near = wheel().initializing(**SCENES["rolls"], slope_direction=home(far))
        quotient = difference(near, ["lambda_1", "lambda_2"], "slope_direction", 1e-4)
        within(np.abs(found - quotient).max(), 1e-6, "derivative off the quotient, N")
        beyond(np.abs(found).max(), 10.0, "derivative, N")


LEFT_ALONE: dict[str, tuple[Values, tuple[str, ...]]] = {
    "a free wheel": ({"psi_dot_start": 0.7, "phi_dot_start": -6.0}, ("lambda_1", "lambda_2", "X_C", "v_x", "lambda_y")),
    "a guided wheel": (
        {**GENERAL, "guided": True, "theta_start": 1.2, "phi_dot_start": -6.0},
        ("M_guide_1", "M_guide_2"),
    ),
}
STEER = {"psi_dot_guide": (0.4, 0.5), "theta_dot_guide": (-0.2, 0.3)}


@pytest.mark.parametrize("case", LEFT_ALONE)
def test_rates_after_turns_that_the_motion_itself_has_made_are_those_of_a_start_at_home(wheel, case):
    """After hundreds of years; where a load or a carrier begins to act."""
    values, names = LEFT_ALONE[case]
    shapes = STEER if "guided" in case else PUSH
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
