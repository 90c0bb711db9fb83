"""Rollback: a restored instance goes on with the bits of the one that took the snapshot, whatever was going on."""

import numpy as np
import pytest

from wheelfmu.fmu.driver import ERROR, OK, FMU2Wheel
from wheelfmu.truth.reference.tables import read_table
from wheelfmu.truth.scenes import KINDS

STEP = 0.125
INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3")


def drive(w: FMU2Wheel, k: int) -> FMU2Wheel:
    """Step k with all six inputs, some held, some linear, quadratic or cubic over the step."""
    for n, name in enumerate(INPUTS):
        amplitude, rate = 2.0 / (n + 1), 1.0 + n
        sine = [amplitude * rate**order * np.sin(rate * k * STEP + order * np.pi / 2) for order in range(1 + n % 4)]
        w.put(**{name: sine[0]})
        assert w.set_input_derivatives([name], [[x] for x in sine[1:]]) == OK
    return w.by(STEP)


def coast(w: FMU2Wheel, _: int) -> FMU2Wheel:
    return w.by(STEP)


def bits_of(w: FMU2Wheel, step, ks: range) -> list[bytes]:
    return [step(w, k).bits() for k in ks]


@pytest.mark.parametrize("step", [coast, drive])
@pytest.mark.parametrize("scene", KINDS)
def test_a_restored_instance_goes_on_with_the_same_bits(wheel, scene, step):
    values = KINDS[scene]
    w, other, fresh = wheel().start(**values), wheel().start(s=0.01, m=7.0), wheel()
    bits_of(other, step, range(5))
    for k in (0, 1, 10, 22, 23):
        bits_of(w, step, range(round(w.time / STEP), k))
        blob, now = w.serialized(), w.bits()
        ahead, end = bits_of(w, step, range(k, k + 16)), w.serialized()
        for restored in (w, other, fresh):
            assert restored.back(blob).bits() == now and restored.serialized() == blob
            assert bits_of(restored, step, range(k, k + 16)) == ahead
            assert restored.serialized() == end  # the bytes depend on the past alone: no pointer, no leftover
        assert coast(w.back(blob).put(F_X=1e-9), k).bits() != ahead[0]  # the partner: the smallest push shows
        w.back(blob)


def test_snapshots_just_before_and_after_every_friction_event_go_on_with_the_same_bits(wheel):
    events = read_table("paper_friction_events")["t"][1:]
    straight = wheel().start(s=0.03).run([10.0])
    w, other, modes = wheel().start(s=0.03), wheel().start(s=0.03), set()
    for t in np.sort(np.concatenate([events - 1e-7, events + 1e-7])):
        modes |= {*w.to(t).get("friction_mode")}
        assert other.back(w.serialized()).run([10.0]) == straight
    assert modes == {-1, 0, 1}
    assert w.run([10.0]) == straight


def test_what_was_set_but_not_yet_stepped_is_part_of_the_state(wheel):
    w = wheel().start(s=0.03).by(0.5).put(F_X=3.0, s=0.02).give({"M_3": (0.0, 0.0, 2.5)})
    blob = w.serialized()
    ahead = bits_of(w, coast, range(8))
    assert w.put(F_X=0.0, s=0.0).back(blob).get("F_X", "s") == [3.0, 0.02]
    assert bits_of(w, coast, range(8)) == ahead


def test_a_brake_whose_derivative_carried_it_below_zero_is_released_and_its_state_can_be_taken(wheel):
    w = wheel().start(phi_dot_start=-2.0).give({"M_brake": (1.0, -20.0)}).by(0.125)  # it arrives at -1.5 N m
    assert w.get("M_brake") == [0.0]
    blob = w.serialized()
    assert w.back(blob).by(0.5).bits() == wheel().back(blob).by(0.5).bits()


def test_stop_time_and_tolerance_are_part_of_the_state(wheel):
    tight = wheel().start(stop=2.0, tolerance=1e-10)
    loose = wheel().start(tolerance=1e-4).back(tight.serialized())
    assert loose.run([1.0, 2.0]) == tight.run([1.0, 2.0])
    assert loose.step(0.1) == tight.step(0.1) == ERROR


@pytest.mark.parametrize(("s_before", "s_after"), [(0.0, 0.03), (0.03, 0.0)])
def test_a_state_keeps_the_method_that_the_change_of_friction_chose(wheel, s_before, s_after):
    law = {"friction_law": 2, "omega_s": 1e-4}  # automatic: DOP853 without friction, collocation where the law is stiff
    w, other, partner = wheel().start(s=s_before, **law), wheel(), wheel().start(s=s_after, **law)
    w.to(0.25).put(s=s_after).to(0.5)
    blob = w.serialized()
    ahead = bits_of(w, coast, range(4))
    for restored in (w, other):
        assert restored.back(blob).serialized() == blob
        assert bits_of(restored, coast, range(4)) == ahead
    assert w.bits() != partner.run([0.25, 0.5, 1.0])[-1]  # the partner has had the later friction from the start


@pytest.mark.parametrize("s", [0.01, 0.0])
def test_a_restored_state_and_the_original_go_on_to_the_same_bytes_when_friction_sets_in(wheel, s):
    """What the solver keeps of its root search starts anew with the friction, whatever it held before."""
    w = wheel().start().by(1e-3)  # inside the first step
    other = wheel().start(s=0.03).by(0.1).back(w.serialized())
    ends = [w.put(s=0.01).by(1e-3).serialized(), other.put(s=s).by(1e-3).serialized()]
    assert (ends[0] == ends[1]) == (s > 0)  # the partner: friction in one of them only
