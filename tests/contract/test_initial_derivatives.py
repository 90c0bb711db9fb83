"""Directional derivatives of the start: by parameters too, for every pair that the model description declares."""

from ctypes import c_double, c_uint

import numpy as np
import pytest
from support.bounds import beyond, within
from support.driver import ERROR, OK, FMU2Wheel

GENERAL = {
    **{"theta_start": 1.1, "psi_start": 0.7, "phi_start": 0.4, "psi_dot_start": 0.9, "theta_dot_start": -0.6},
    **{"phi_dot_start": -3.0, "X_O_start": 0.2, "Y_O_start": -0.4, "m": 17.0, "F_X": 1.0, "M_2": 0.5},
}
SCENES = {
    "paper": {},  # J_z is at its limit, J_x + J_y; r, s and others at zero
    "turning": {"psi_dot_start": 2.0, "theta_start": 1.2},  # J_z too, and it counts
    "general": GENERAL | {"J_z": 1.6, "J_x": 0.8, "s": 0.03},
    "regularized": GENERAL | {"J_z": 1.6, "s": 0.03, "friction_law": 2, "omega_s": 0.5},
    "thin disc": {"r": 0.0, "theta_start": 0.9},
}


def derivative(w: FMU2Wheel, unknown: str, known: str, seed: float = 1.0) -> tuple[int, float]:
    value = (c_double * 1)(np.nan)
    arrays = ((c_uint * 1)(w.references[unknown]), 1, (c_uint * 1)(w.references[known]), 1, (c_double * 1)(seed), value)
    return w.fmi2GetDirectionalDerivative(w.component, *arrays), value[0]


def quotient(w: FMU2Wheel, unknown: str, known: str, x: float, h: float) -> float:
    """A one-sided difference of the second order, upwards; J_z, which may be at its limit, downwards."""
    if known == "J_z":
        h = -h
    values = [w.put(**{known: x + k * h}).get(unknown)[0] for k in range(3)]
    w.put(**{known: x})
    return (-3 * values[0] + 4 * values[1] - values[2]) / (2 * h)


@pytest.mark.parametrize("scene", SCENES)
def test_every_declared_pair_is_answered_and_right(wheel, description, scene):
    w = wheel().initializing(**SCENES[scene])
    pairs = [(u.variable.name, v.name) for u in description.initialUnknowns for v in u.dependencies]
    assert len(pairs) > 150
    moved, off = 0, 0.0
    for unknown, known in pairs:
        status, exact = derivative(w, unknown, known)
        assert status == OK and np.isfinite(exact), (unknown, known)
        if w.variables[known].type != "Real":
            assert exact == 0  # a choice has no small change
            continue
        (x,) = w.get(known)
        h = 1e-5 * (abs(x) or 1.0)
        difference = quotient(w, unknown, known, x, h)
        size = 1 + abs(exact)
        moved += abs(exact) > 1e-6
        off = max(off, abs(1.01 * exact - difference) / size)
        within(abs(exact - difference) / size, 2e-5, "relative error")
        assert derivative(w, unknown, known, -2.0)[1] == -2 * exact
    beyond(off, 2e-5, "relative error")
    assert moved > 60
    assert w.messages == []


def test_asking_leaves_the_start_as_it_was(wheel):
    w, other = (wheel().initializing(**GENERAL).give({"M_3": (0.0, 0.3)}) for _ in range(2))
    for instance in (w, other):
        instance.get("theta")
    before = w.serialized()
    assert before == other.serialized()
    for known in ("m", "theta_start", "J_z", "s", "formulation", "keep_contact"):
        assert derivative(w, "lambda_3", known)[0] == OK
    assert w.serialized() == before
    assert (w.exitInitializationMode(), other.exitInitializationMode()) == (OK, OK)
    assert w.run([1.0]) == other.run([1.0])


def test_once_the_wheel_rolls_outputs_answer_inputs_alone(wheel):
    w = wheel().start()
    assert derivative(w, "Z_O", "r")[0] == ERROR
    assert w.take_messages()[0].text == "fmi2GetDirectionalDerivative: value reference 2 is not an input."
    assert derivative(w, "Z_O", "F_X") == (OK, 0.0)
