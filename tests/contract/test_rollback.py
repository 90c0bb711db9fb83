"""Rollback: a restored instance goes on with the bits of the one that took the snapshot, whatever was going on."""

from ctypes import byref

import numpy as np
import pytest
from support.driver import ERROR, OK, FMU2Wheel
from support.scenes import KINDS

from contract.call_states import STATES, bring_to

STEP = 0.125


def drive(w: FMU2Wheel, k: int) -> int:
    """Step k with all six inputs, some held, some linear, quadratic or cubic over the step."""
    names = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3")
    t = k * STEP
    for n, name in enumerate(names):
        amplitude, rate = 2.0 / (n + 1), 1.0 + n
        assert w.set(**{name: amplitude * np.sin(rate * t)}) == OK
        for order in (1, 2, 3)[: n % 4]:
            derivative = amplitude * rate**order * np.sin(rate * t + order * np.pi / 2)
            w.setRealInputDerivatives([w.references[name]], [order], [derivative])
    return w.step(STEP)


def coast(w: FMU2Wheel, _: int) -> int:
    return w.step(STEP)


def bits_of(w: FMU2Wheel, step, ks: range) -> list[bytes]:
    out = []
    for k in ks:
        assert step(w, k) == OK, w.messages
        out.append(w.bits())
    return out


@pytest.mark.parametrize("step", [coast, drive])
@pytest.mark.parametrize("scene", KINDS)
def test_a_restored_instance_goes_on_with_the_same_bits(wheel, scene, step):
    values = KINDS[scene]
    w, other, fresh = wheel().start(**values), wheel().start(s=0.01, m=7.0), wheel()
    bits_of(other, step, range(5))
    for k in (0, 1, 10, 22, 23):
        bits_of(w, step, range(round(w.time / STEP), k))
        blob, now = w.serialized(), w.bits()
        ahead = bits_of(w, step, range(k, k + 16))
        for restored in (w, other, fresh):
            assert restored.restore(blob) == OK
            assert restored.bits() == now
            assert restored.serialized() == blob
            assert bits_of(restored, step, range(k, k + 16)) == ahead
        assert w.restore(blob) == OK
        assert w.set(F_X=1e-9) == OK  # the partner: the smallest push shows
        assert bits_of(w, coast, range(1))[-1] != ahead[0]
        assert w.restore(blob) == OK


def test_snapshots_just_before_and_after_every_friction_event_go_on_with_the_same_bits(wheel, reference_events):
    undisturbed = wheel().start(s=0.03)
    straight = undisturbed.run([10.0])
    w, other = wheel().start(s=0.03), wheel().start(s=0.03)
    modes = set()
    for t in np.sort(np.concatenate([reference_events - 1e-7, reference_events + 1e-7])):
        w.to(t)
        modes.add(w.get("friction_mode")[0])
        assert other.restore(w.serialized()) == OK
        assert other.run([10.0]) == straight
    assert modes == {-1, 0, 1}
    assert w.run([10.0]) == straight


def test_what_was_set_but_not_yet_stepped_is_part_of_the_state(wheel):
    w = wheel().start(s=0.03).by(0.5)
    assert w.set(F_X=3.0, s=0.02) == OK
    w.setRealInputDerivatives([w.references["M_3"]], [2], [5.0])
    blob = w.serialized()
    ahead = bits_of(w, coast, range(8))
    assert w.set(F_X=0.0, s=0.0) == OK and w.restore(blob) == OK
    assert w.get("F_X", "s") == [3.0, 0.02]
    assert bits_of(w, coast, range(8)) == ahead


def test_a_rejected_step_leaves_no_trace(wheel):
    """Step, restore, two half steps: a variable-step master."""
    for values in KINDS.values():
        rejecting, careful = wheel().start(**values), wheel().start(**values)
        for k in range(20):
            state, t = rejecting.snapshot(), rejecting.time
            assert drive(rejecting, k) == OK
            assert rejecting.fmi2SetFMUstate(rejecting.component, state) == OK
            assert rejecting.fmi2FreeFMUstate(rejecting.component, byref(state)) == OK and not state
            rejecting.time = t
            halves = [(w.step(STEP / 2), w.step(STEP / 2), w.bits()) for w in (rejecting, careful)]
            assert halves[0] == halves[1]
            assert halves[0][:2] == (OK, OK)


def test_a_brake_whose_derivative_carried_it_below_zero_is_released_and_its_state_can_be_taken(wheel):
    w, other = wheel().start(phi_dot_start=-2.0), wheel()
    assert w.set(M_brake=1.0) == OK and w.set_input_derivatives(["M_brake"], [[-20.0]]) == OK
    w.by(0.125)  # the polynomial arrives at -1.5 N m
    assert w.get("M_brake") == [0.0]
    blob = w.serialized()
    assert other.restore(blob) == OK and w.restore(blob) == OK
    assert w.step(0.5) == other.step(0.5) == OK
    assert w.bits() == other.bits()


@pytest.mark.parametrize("state", STATES)
def test_a_snapshot_brings_back_the_call_state_it_was_taken_in(wheel, state):
    w = bring_to(wheel(), state)
    blob = w.serialized()
    for other_state in STATES:
        other = bring_to(wheel(), other_state)
        assert (other.serialized() == blob) == (other_state == state)
        assert other.restore(blob) == OK
        assert other.serialized() == blob
        assert (other.setupExperiment() == OK) == (state == "instantiated")


def test_stop_time_and_tolerance_are_part_of_the_state(wheel):
    tight = wheel().start(stop=2.0, tolerance=1e-10)
    loose = wheel().start(tolerance=1e-4).back(tight.serialized())
    assert loose.run([1.0, 2.0]) == tight.run([1.0, 2.0])
    assert loose.step(0.1) == tight.step(0.1) == ERROR


@pytest.mark.parametrize(("s_before", "s_after"), [(0.0, 0.03), (0.03, 0.0)])
def test_a_state_keeps_the_method_that_the_change_of_friction_chose(wheel, s_before, s_after):
    law = {"friction_law": 2, "omega_s": 1e-4}  # automatic: DOP853 without friction, BDF where the law is stiff
    w, other, partner = wheel().start(s=s_before, **law), wheel(), wheel().start(s=s_after, **law)
    bits_of(w, coast, range(3))
    assert w.set(s=s_after) == OK
    bits_of(w, coast, range(3, 5))
    blob = w.serialized()
    ahead = bits_of(w, coast, range(5, 9))
    for restored in (w, other):
        assert restored.restore(blob) == OK
        assert restored.serialized() == blob
        assert bits_of(restored, coast, range(5, 9)) == ahead
    bits_of(partner, coast, range(9))
    assert w.bits() != partner.bits()  # the partner has had the later friction from the start


@pytest.mark.parametrize("s", [0.01, 0.0])
def test_a_restored_state_and_the_original_go_on_to_the_same_bytes_when_friction_sets_in(wheel, s):
    """What the solver keeps of its root search starts anew with the friction, whatever it held before."""
    w, other = wheel().start(), wheel().start(s=0.03)
    assert w.step(1e-3) == other.step(0.1) == OK  # inside the first step
    assert other.restore(w.serialized()) == OK
    assert w.set(s=0.01) == OK and other.set(s=s) == OK  # the partner: friction in one of them only
    assert w.step(1e-3) == other.step(1e-3) == OK
    assert (w.serialized() == other.serialized()) == (s > 0)
