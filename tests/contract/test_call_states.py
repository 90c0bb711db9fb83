"""Every function in every state: what the standard allows works, all else is an error with a sentence and no effect."""

import pytest
from support.driver import ERROR, OK
from support.scenes import KINDS

from contract.call_states import STATES, TABLE, bring_to, call


def test_each_function_is_legal_exactly_where_the_standard_says(wheel):
    """Legal: it does not answer fmi2Error."""
    measured: dict[str, set[str]] = {function: set() for function in TABLE}
    for state in STATES:
        for function in TABLE:
            w = bring_to(wheel(), state)
            if call(w, function) != ERROR:
                measured[function].add(state)
            w.close()
    assert measured == TABLE  # 228 cells
    assert measured != TABLE | {"fmi2Terminate": TABLE["fmi2Terminate"] | {"error"}}


@pytest.mark.parametrize("state", STATES)
def test_an_illegal_call_is_an_error_with_one_sentence_and_changes_nothing(wheel, state):
    disturbed, undisturbed = bring_to(wheel(), state), bring_to(wheel(), state)
    before = disturbed.serialized()
    assert before == undisturbed.serialized()
    illegal = [function for function, states in TABLE.items() if state not in states]
    assert len(illegal) >= 13
    for function in illegal:
        assert call(disturbed, function) == ERROR
        (message,) = disturbed.take_messages()
        assert (message.status, message.category) == (ERROR, "logStatusError")
        assert message.text.startswith(function) and message.text.endswith(".")
        assert disturbed.serialized() == before, function
    if state == "step complete":
        assert disturbed.run([0.7, 1.0]) == undisturbed.run([0.7, 1.0])
    assert call(disturbed, "fmi2Reset") == OK  # the partner: a legal call shows in the bytes
    assert disturbed.serialized() != before or state == "instantiated"


def test_from_every_state_a_reset_instance_is_a_new_one_to_the_last_byte_and_runs_as_one(wheel):
    used = [bring_to(wheel(), state) for state in STATES]
    used += [wheel().start(stop=5.0, tolerance=1e-6, keep_contact=1, **values) for values in KINDS.values()]
    new, first = wheel().serialized(), wheel().start(s=0.03).run([0.5, 2.0])
    for k, w in enumerate(used):
        if k >= len(STATES):
            w.set(F_X=1.0)
            w.run([2.0])
        assert k == 0 or w.serialized() != new
        assert w.reset() == OK
        assert w.serialized() == new
        assert w.start(s=0.03).run([0.5, 2.0]) == first
    assert w.reset() == OK
    assert w.start(s=0.031).run([0.5, 2.0]) != first


def test_calls_on_no_instance_are_errors(wheel):
    w = wheel()
    assert {call(w, function, null=True) for function in TABLE} == {ERROR}
    w.fmi2FreeInstance(None)  # without effect
    assert call(w, "fmi2GetFMUstate") == OK


def test_after_an_error_a_snapshot_or_a_reset_brings_the_instance_back(wheel):
    w = bring_to(wheel(), "step complete")
    good = w.serialized()
    ahead = w.run([0.6, 1.0])
    assert (w.set(M_3=1e300), w.step_to(1.1)) == (OK, ERROR)
    assert w.step_to(1.1) == ERROR  # the partner: nothing goes on by itself
    assert w.back(good).run([0.6, 1.0]) == ahead
