"""Getting and setting values: arrays, references, types, bounds. A refused call has no effect, not even in part."""

from collections.abc import Sequence
from ctypes import c_double, c_int

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, WARNING, FMU2Wheel


def set_many(w: FMU2Wheel, kind: str, references: Sequence[int], values: Sequence[float]) -> int:
    return w.ask(f"Set{kind}", references, len(references), values)


def get_many(w: FMU2Wheel, kind: str, references: Sequence[int]) -> tuple[int, list[float]]:
    values = ((c_double if kind == "Real" else c_int) * len(references))(*[-77] * len(references))
    return w.ask(f"Get{kind}", references, len(references), values), list(values)


def test_unknown_references_and_wrong_types_are_errors_and_leave_the_array_alone(wheel):
    w = wheel().start()
    right = {"Real": "theta", "Integer": "n_steps", "Boolean": "keep_contact"}
    for kind, name in right.items():
        good = w.references[name]
        assert get_many(w, kind, [good])[0] == OK
        others = w.refer(*(other for other in right.values() if other != name))
        for bad in (len(w.references), 2**32 - 1, *others):
            assert get_many(w, kind, [good, bad]) == (ERROR, [-77, -77])
            assert set_many(w, kind, [bad], [1]) == ERROR
            why = f"{kind}: no variable of this type has the value reference {bad}."
            assert w.texts() == [f"fmi2Get{why}", f"fmi2Set{why}"]
    assert get_many(w, "Integer", w.refer("formulation")) == (OK, [1])  # an enumeration is an Integer


def test_of_duplicate_references_the_last_value_counts_and_each_is_read(wheel):
    w, plain = wheel().start(), wheel().start(F_X=30.0)
    force, theta = w.refer("F_X", "theta")
    assert set_many(w, "Real", [force, force], [7.0, 30.0]) == OK
    assert w.run([0.3]) == plain.run([0.3])
    assert w.run([0.4]) != wheel().start(F_X=7.0).run([0.4])
    status, (a, b, c) = get_many(w, "Real", [theta, force, theta])
    assert (status, a, b) == (OK, c, 30.0)


def test_a_refused_call_sets_none_of_its_values(wheel):
    w = wheel().start()
    before = w.serialized()
    force, mass, theta, s = w.refer("F_X", "m", "theta", "s")
    wrong = [(len(w.references), 1, ERROR), (mass, 21, ERROR), (theta, 1, ERROR)]
    for bad, value, status in [*wrong, (s, -1, DISCARD), (force, np.nan, DISCARD)]:
        assert set_many(w, "Real", [force, bad], [5.0, value]) == status
    assert w.serialized() == before
    assert set_many(w, "Real", [force], [5.0]) == OK and w.serialized() != before


def test_fixed_parameters_and_calculated_variables_cannot_be_set_once_running(wheel, description):
    w = wheel().start()
    for v in description.modelVariables:
        changeable = v.causality == "input" or v.variability == "tunable"
        assert w.set(**{v.name: w.get(v.name)[0]}) == (OK if changeable else ERROR), v.name
        why = "cannot be set after initialization" if v.causality == "parameter" else "is calculated and cannot be set"
        assert w.texts() == ([] if changeable else [f'fmi2Set{w.type_of(v.name)}: "{v.name}" {why}.'])
    before = wheel()
    assert {before.set(**{name: 0}) for name in (*before.reals, *before.integers)} == {ERROR}


REFUSED = [("s", -1e-9, "it must be at least 0"), ("slope", np.pi / 2, f"it must be less than {np.pi / 2}")]
REFUSED += [(name, x, "a finite number is needed") for name in ("s", "F_X", "M_3") for x in (np.nan, np.inf, -np.inf)]


@pytest.mark.parametrize(("name", "value", "allowed"), REFUSED)
def test_a_value_out_of_bounds_is_discarded_while_running_and_the_old_one_stays(wheel, name, value, allowed):
    w, undisturbed = (wheel().start(s=0.03, F_X=2.0) for _ in range(2))
    (old,) = w.get(name)
    assert w.set(**{name: value}) == DISCARD
    text = f"fmi2SetReal: {name} = {float(value)!r}: {allowed}; the value stays {old:.9g}."
    assert w.take_messages() == [(WARNING, "logStatusDiscard", text)]
    assert w.get(name) == [old] and w.run([0.5]) == undisturbed.run([0.5])
    assert w.put(**{name: 0.01}).get(name) == [0.01] and w.run([1.0]) != undisturbed.run([1.0])  # the partner


def test_the_friction_is_tunable_and_acts_from_the_present_instant_on(wheel):
    w, untouched = (wheel().start() for _ in range(2))
    assert w.run([1.0]) == untouched.run([1.0])
    assert w.put(s=0.03).get("s") == [0.03]
    energy = w.get("E")[0]
    assert energy == untouched.get("E")[0]
    # Power -s N |omega_z|: without friction nothing is lost.
    beyond(energy - w.to(2.0).get("E")[0], 1.0, "energy lost by friction, J")
    within(abs(energy - untouched.to(2.0).get("E")[0]), 9e-9, "energy lost without friction, J")


@pytest.mark.parametrize("law", [{}, {"friction_law": 2, "s": 0.03, "omega_s": 0.1}])
@pytest.mark.parametrize("omega_z", [-1, 0, 1])
def test_without_the_exact_law_the_mode_of_friction_is_the_sign_of_the_spin(wheel, law, omega_z):
    upright = {"theta_start": np.pi / 2, "phi_dot_start": omega_z}
    assert wheel().start(**upright, **law).get("friction_mode") == [omega_z]
