"""After an ending: nothing goes on by itself, the refusal says what happened, and a restored state leads on."""

import re

import numpy as np
import pytest
from support.driver import DISCARD, DO_STEP_STATUS, ERROR, LAST_SUCCESSFUL_TIME, OK, TERMINATED, WARNING

from contract.call_states import STATES, TABLE, bring_to, call

DROP = {"theta_start": float(np.radians(75)), "phi_dot_start": 0.0}  # let go at rest
LIFT = {"F_Z": 250.0}  # more than the weight


def told(t: float) -> str:
    """A time as messages give it: the shortest decimal that is this number."""
    return np.format_float_positional(t, trim="-")


@pytest.mark.parametrize(("values", "what"), [(DROP, "fell flat"), (LIFT, "lifted off the ground")])
def test_an_ending_is_a_message_that_masters_show_with_every_digit_of_its_instant(wheel, values, what):
    w = wheel().start(start=0.1, **values)
    assert w.step(10.0) == DISCARD
    (message,) = w.take_messages()
    assert (message.status, message.category) == (WARNING, "logStatusDiscard")
    end = w.status(LAST_SUCCESSFUL_TIME)
    assert re.match(rf"The wheel {what} at t = {told(end)} s[,:] .*the model ends there\.$", message.text)
    assert float(message.text.split("t = ")[1].split(" s")[0]) == end


@pytest.mark.parametrize(("values", "what"), [(DROP, "fell flat"), (LIFT, "lifted off the ground")])
def test_after_an_ending_no_step_of_any_length_is_answered_with_ok_and_the_refusal_says_why(wheel, values, what):
    w = wheel().start(**values)
    assert w.step(10.0) == DISCARD
    end, bits = w.status(LAST_SUCCESSFUL_TIME), w.bits()
    w.take_messages()
    w.time = end
    for h in (0.0, 1e-300, 1e-12, 0.1, 1e6):
        assert w.step(h) == ERROR
        assert w.said() == f"fmi2DoStep: the wheel {what} at t = {told(end)} s. Restore a state or reset."
    assert w.set(s=0.01) == ERROR and what in w.take_messages()[0].text
    for leaving in (lambda: OK, w.terminate):
        assert leaving() == OK
        assert (w.bits(), w.status(TERMINATED), w.status(LAST_SUCCESSFUL_TIME)) == (bits, 1, end)
    assert w.reset() == OK
    assert w.start().run([2.0]) == wheel().start().run([2.0])


def test_a_restored_ending_is_still_an_ending_in_any_instance(wheel):
    w, other = wheel().start(**DROP).to(0.5), wheel().start()
    assert (w.status(DO_STEP_STATUS), w.status(LAST_SUCCESSFUL_TIME), w.status(TERMINATED)) == (OK, 0.5, 0)
    before = w.serialized()
    assert w.step(10.0) == DISCARD
    ended, end, bits = w.serialized(), w.status(LAST_SUCCESSFUL_TIME), w.bits()
    assert other.restore(ended) == OK
    other.take_messages()
    assert (other.bits(), other.step(0.0), other.status(TERMINATED)) == (bits, ERROR, 1)
    assert "fell flat" in other.take_messages()[0].text
    assert other.restore(before) == OK  # the partner: a state from before leads on, to the same end
    assert (other.status(TERMINATED), other.step(0.0), other.step(0.05)) == (0, OK, OK)
    assert (other.step(1.0), other.status(LAST_SUCCESSFUL_TIME), other.bits()) == (DISCARD, end, bits)


@pytest.mark.parametrize("values", [{}, {"s": 0.03}], ids=["unfolded", "stepped"])
def test_a_terminated_wheel_is_read_where_it_stopped(wheel, values):
    read, unread = (wheel().start(**values).by(1.0) for _ in range(2))
    want = read.bits()
    assert unread.terminate() == OK and unread.bits() == want


def test_times_in_messages_have_the_digits_they_need(wheel):
    w = wheel().start()
    w.run([0.1])
    times = {0.3: "0.3", 0.1 + 0.2: "0.30000000000000004", 1e-7: "1e-07", 100.0: "100", 1e-300: "1e-300"}
    for t, text in times.items():
        w.time = t
        assert w.step(1.0) == ERROR
        assert w.take_messages()[0].text == f"fmi2DoStep from {text} s: the FMU has reached 0.1 s."


def test_other_states_are_told_by_their_names(wheel):
    """The partner: only an ending has a sentence of its own."""
    for state in STATES:
        w = bring_to(wheel(), state)
        function = next(f for f in ("fmi2DoStep", "fmi2SetupExperiment") if state not in TABLE[f])
        assert call(w, function) == ERROR
        (message,) = w.take_messages()
        mode = " mode" if state == "initialization" else ""
        named = message.text == f'{function} is not allowed in the state "{state}{mode}".'
        assert named == (state != "step failed")


def test_output_derivatives_are_refused_in_initialization_mode_even_where_the_outputs_can_be_read(wheel):
    w = wheel().initializing()
    assert w.get_one("lambda_3")[0] == OK
    assert call(w, "fmi2GetRealOutputDerivatives") == ERROR
    assert w.said() == 'fmi2GetRealOutputDerivatives is not allowed in the state "initialization mode".'
    assert w.exitInitializationMode() == OK
    assert call(w, "fmi2GetRealOutputDerivatives") == OK


def test_an_input_is_read_back_as_it_is_now(wheel):
    w = wheel().start(s=0.03).give({"M_3": (1.0, 2.0), "F_X": (4.0,)})
    assert w.get("M_3") == [1.0]
    assert w.by(0.5).get("M_3", "F_X") == [2.0, 4.0]
    assert w.by(0.5).get("M_3") == [2.0]  # derivatives hold for one step
    blob = w.serialized()
    assert w.put(M_3=7.0).get("M_3") == [7.0]
    assert w.back(blob).get("M_3") == [2.0]
