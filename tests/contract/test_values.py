"""Getting and setting values: arrays, references, types, bounds. A refused call has no effect, not even in part."""

from collections.abc import Sequence
from ctypes import c_double, c_int, c_uint

import numpy as np
import pytest
from support.bounds import beyond, within
from support.driver import DISCARD, ERROR, OK, WARNING, FMU2Wheel

SETTERS = {"Real": c_double, "Integer": c_int, "Boolean": c_int}


def first_unknown(w: FMU2Wheel) -> int:
    return max(w.references.values()) + 1


def set_many(w: FMU2Wheel, kind: str, references: Sequence[int], values: Sequence[float]) -> int:
    n = len(references)
    return getattr(w, f"fmi2Set{kind}")(w.component, (c_uint * n)(*references), n, (SETTERS[kind] * n)(*values))


def get_many(w: FMU2Wheel, kind: str, references: Sequence[int]) -> tuple[int, list[float]]:
    n = len(references)
    values = (SETTERS[kind] * n)(*[-77] * n)
    return getattr(w, f"fmi2Get{kind}")(w.component, (c_uint * n)(*references), n, values), list(values)


def test_unknown_references_and_wrong_types_are_errors_and_leave_the_array_alone(wheel):
    w = wheel().start()
    right = {"Real": "theta", "Integer": "n_steps", "Boolean": "keep_contact"}
    for kind, name in right.items():
        good = w.references[name]
        assert get_many(w, kind, [good])[0] == OK
        others = [w.references[other] for other in right.values() if other != name]
        for bad in (first_unknown(w), 2**32 - 1, *others):
            assert get_many(w, kind, [good, bad]) == (ERROR, [-77, -77])
            assert w.said() == f"fmi2Get{kind}: no variable of this type has the value reference {bad}."
            assert set_many(w, kind, [bad], [1]) == ERROR
            assert w.said() == f"fmi2Set{kind}: no variable of this type has the value reference {bad}."
    assert get_many(w, "Integer", [w.references["formulation"]]) == (OK, [1])  # an enumeration is an Integer


def test_of_duplicate_references_the_last_value_counts_and_each_is_read(wheel):
    w, plain = wheel().start(), wheel().start()
    force, theta = w.references["F_X"], w.references["theta"]
    assert set_many(w, "Real", [force, force], [7.0, 30.0]) == OK
    assert plain.set(F_X=30.0) == OK
    assert w.run([0.3]) == plain.run([0.3])
    assert w.run([0.4]) != wheel().start(F_X=7.0).run([0.4])
    status, (a, b, c) = get_many(w, "Real", [theta, force, theta])
    assert (status, a, b) == (OK, c, 30.0)


def test_a_refused_call_sets_none_of_its_values(wheel):
    w = wheel().start()
    before = w.serialized()
    force, mass, theta, s = (w.references[name] for name in ("F_X", "m", "theta", "s"))
    for bad, value, status in ((first_unknown(w), 1, ERROR), (mass, 21, ERROR), (theta, 1, ERROR), (s, -1, DISCARD)):
        assert set_many(w, "Real", [force, bad], [5.0, value]) == status
    assert set_many(w, "Real", [force, force], [5.0, np.nan]) == DISCARD
    assert w.serialized() == before
    assert set_many(w, "Real", [force], [5.0]) == OK and w.serialized() != before


def test_fixed_parameters_and_calculated_variables_cannot_be_set_once_running(wheel, description):
    w = wheel().start()
    for v in description.modelVariables:
        changeable = v.causality == "input" or v.variability == "tunable"
        assert w.set(**{v.name: w.get(v.name)[0]}) == (OK if changeable else ERROR), v.name
        told = [m.text for m in w.take_messages()]
        why = "cannot be set after initialization" if v.causality == "parameter" else "is calculated and cannot be set"
        kind = "Integer" if v.type == "Enumeration" else v.type
        assert told == ([] if changeable else [f'fmi2Set{kind}: "{v.name}" {why}.'])
    before = wheel()
    assert {before.set(**{name: 0}) for name in (*before.reals, *before.integers)} == {ERROR}


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -1e-9])
def test_a_value_out_of_bounds_is_discarded_while_running_and_the_old_one_stays(wheel, value):
    w = wheel().start(s=0.03, F_X=2.0)
    ahead = wheel().start(s=0.03, F_X=2.0).run([0.5])
    names = ("s",) if np.isfinite(value) else ("s", "F_X", "M_3")
    for name in names:
        (old,) = w.get(name)
        assert w.set(**{name: value}) == DISCARD
        (message,) = w.take_messages()
        assert (message.status, message.category) == (WARNING, "logStatusDiscard")
        allowed = "it must be at least 0" if np.isfinite(value) else "a finite number is needed"
        assert message.text == f"fmi2SetReal: {name} = {value:.9g}: {allowed}; the value stays {old:.9g}."
        assert w.get(name) == [old]
    assert w.run([0.5]) == ahead
    assert w.set(s=0.0) == OK and w.run([1.0]) != wheel().start(s=0.03, F_X=2.0).run([0.5, 1.0])[1:]


def test_the_friction_is_tunable_and_acts_from_the_present_instant_on(wheel):
    w, untouched, sandy = (wheel().start() for _ in range(3))
    assert w.run([1.0]) == untouched.run([1.0])
    assert (w.set(s=0.03), w.get("s"), sandy.step_to(1.0)) == (OK, [0.03], OK)
    energy = w.get("E")[0]
    assert energy == untouched.get("E")[0]
    assert w.step_to(2.0) == OK and untouched.step_to(2.0) == OK
    # Power -s N |omega_z|: without friction nothing is lost.
    beyond(energy - w.get("E")[0], 1.0, "E")
    within(abs(energy - untouched.get("E")[0]), 9e-9, "E")


@pytest.mark.parametrize("law", [{}, {"friction_law": 2, "s": 0.03, "omega_s": 0.1}])
@pytest.mark.parametrize("omega_z", [-1, 0, 1])
def test_without_the_exact_law_the_mode_of_friction_is_the_sign_of_the_spin(wheel, law, omega_z):
    upright = {"theta_start": np.pi / 2, "phi_dot_start": omega_z}
    assert wheel().start(**upright, **law).get("friction_mode") == [omega_z]
