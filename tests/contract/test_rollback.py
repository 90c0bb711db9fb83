"""A state holds beside the motion (test_two_conditions.py): stop time, tolerance, the method in use."""

import pytest

from wheelfmu.fmu.driver import ERROR


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
    ahead = w.run([0.75, 1.0])
    for restored in (w, other):
        assert restored.back(blob).serialized() == blob
        assert restored.run([0.75, 1.0]) == ahead
    assert w.bits() != partner.run([0.25, 0.5, 1.0])[-1]  # the partner has had the later friction from the start


@pytest.mark.parametrize("s", [0.01, 0.0])
def test_a_restored_state_and_the_original_go_on_to_the_same_bytes_when_friction_sets_in(wheel, s):
    """What the solver keeps of its root search starts anew with the friction, whatever it held before."""
    w = wheel().start().by(1e-3)  # inside the first step
    other = wheel().start(s=0.03).by(0.1).back(w.serialized())
    ends = [w.put(s=0.01).by(1e-3).serialized(), other.put(s=s).by(1e-3).serialized()]
    assert (ends[0] == ends[1]) == (s > 0)  # the partner: friction in one of them only


@pytest.mark.parametrize("t", [0.5, 0.51, 0.525, 0.536])
def test_the_time_of_the_last_change_is_part_of_a_state(wheel, t):
    """It limits the first step after the next change."""
    law = {"s": 0.03, "method": 4}
    w = wheel().start(**law).to(t).put(M_3=0.5).to(t + 0.002)
    other, later = wheel().back(w.serialized()), wheel().start(**law).to(t + 0.002).put(M_3=0.5)
    ends = [each.put(M_3=0.1).to(t + 0.004, 3.0).bits() for each in (w, other, later)]
    assert ends[0] == ends[1] != ends[2]
