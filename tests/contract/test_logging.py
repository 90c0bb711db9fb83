"""Messages: who gets them, when, in which form; and that nothing else is ever written."""

import re
from ctypes import byref, c_double, c_uint, c_void_p

import numpy as np
import pytest
from fmpy.fmi2 import fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2String
from support.bounds import within
from support.driver import DISCARD, ERROR, OK

from contract.call_states import STATES, TABLE, bring_to, call

FRICTION = {"s": 0.03}
FIRST_STICK = 1.225520636  # s, the first row of the reference's table of events
EVENTS = 37  # physics.md: transitions of the paper's friction scene in 10 s


def test_a_healthy_run_is_silent_unless_logging_is_switched_on(wheel):
    silent, talking = wheel().start(**FRICTION), wheel(logging=True).start(**FRICTION)
    assert silent.run([10.0]) == talking.run([10.0])
    assert silent.take_messages() == []
    events = talking.take_messages()
    assert len(events) == EVENTS == talking.get("n_events")[0]
    assert {(m.status, m.category) for m in events} == {(OK, "logEvents")}
    t, sentence = re.fullmatch(r"t = ([\d.]+) s: (.*)", events[0].text).groups()
    assert sentence == "stick, omega_z is held at zero."
    within(
        abs(float(t) - FIRST_STICK), 1e-6, "instant of the first stick, s"
    )  # the release that follows is 0.1 s later
    assert {text.split(": ")[1].split(",")[0] for _, _, text in events} == {"stick", "release", "reversal"}


def test_nothing_is_written_to_the_standard_streams(wheel, capfd):
    for state in STATES:
        w = bring_to(wheel(logging=True), state)
        for function in TABLE:
            call(w, function)
    failing = wheel(logging=True).start()
    assert (failing.set(M_3=1e300), failing.step(1.0)) == (OK, ERROR)
    assert len(failing.messages) == 1
    assert capfd.readouterr() == ("", "")
    print("the partner")
    assert capfd.readouterr() != ("", "")


@pytest.mark.parametrize("category", ["logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError", "logAll"])
def test_categories_filter(wheel, category):
    w = wheel()
    w.setDebugLogging(True, [category])
    w.setupExperiment(0.1)  # a warning: clamped
    w.reset()
    w.start(**FRICTION).to(2.0)  # events: stick, release, reversal
    assert w.set(F_X=np.nan) == DISCARD
    assert w.set(m=1.0) == ERROR
    told = {m.category for m in w.take_messages()}
    everything = {"logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError"}
    assert told == (everything if category == "logAll" else {category})


def test_categories_can_be_switched_off_one_by_one_and_all_at_once(wheel):
    w = wheel(logging=True).start(**FRICTION)
    w.setDebugLogging(False, ["logEvents"])
    assert w.step_to(2.0) == OK and w.messages == []
    assert w.set(m=1.0) == ERROR and len(w.take_messages()) == 1
    w.setDebugLogging(False, [])
    assert (w.set(m=1.0), w.messages) == (ERROR, [])
    w.setDebugLogging(True, [])
    assert (w.set(m=1.0), len(w.messages)) == (ERROR, 1)


def test_percent_and_hash_signs_are_doubled_and_texts_stay_short_and_without_newline(wheel):
    w = wheel()
    assert w.fmi2SetDebugLogging(w.component, 1, 2, (fmi2String * 2)(b"logAll", b"a%s#b#%n")) == OK
    assert w.take_messages()[0].text == 'fmi2SetDebugLogging: there is no category "a%%s##b##%%n".'
    assert w.fmi2SetDebugLogging(w.component, 1, 2, (fmi2String * 2)(b"logAll", b"#%" * 5000)) == OK
    (long,) = w.take_messages()
    assert len(long.text) < 1000
    assert long.text.replace("##", "").replace("%%", "").startswith("fmi2SetDebugLogging: there is no category ")
    assert "#" not in long.text.replace("##", "") and "%" not in long.text.replace("%%", "")
    assert not long.text.endswith("\n")


def test_a_logger_that_calls_back_is_answered_with_an_error_and_nothing_hangs(wheel):
    w = wheel(logging=True)
    answers: list[int] = []

    def call_back(self, *message) -> None:
        component = w.component
        value = (c_double * 1)()
        answers.append(w.fmi2GetReal(component, (c_uint * 1)(27), 1, value))
        answers.append(w.fmi2DoStep(component, 0.0, 1.0, 0))
        answers.append(w.fmi2Reset(component))
        answers.append(w.fmi2Terminate(component))
        answers.append(w.dll.fmi2EnterEventMode(c_void_p(component)))
        w.fmi2FreeInstance(component)  # without effect while a call is under way

    w.on_message = call_back.__get__(w)
    w.start(**FRICTION).to(1.5)  # stick and release
    assert call(w, "fmi2EnterEventMode") == ERROR
    assert answers == [ERROR] * 15
    w.on_message = None
    assert w.bits() == wheel().start(**FRICTION).run([1.5])[0]
    assert w.get_one("X_O")[0] == OK  # the partner: outside a call it is answered


@pytest.mark.parametrize("callbacks", ["none", "empty", "logger only"])
def test_missing_callbacks_are_survived(wheel, callbacks):
    w = wheel()
    struct = fmi2CallbackFunctions()
    if callbacks == "logger only":
        struct.logger = fmi2CallbackLoggerTYPE(w.keep_message)
    pointer = None if callbacks == "none" else byref(struct)
    w.close()
    w.component = w.fmi2Instantiate(b"wheel", 1, w.guid.encode(), None, pointer, 0, 1)
    assert w.start(**FRICTION).set(m=3.0) == ERROR
    assert len(w.messages) == (1 if callbacks == "logger only" else 0)
    assert w.run([2.0]) == wheel().start(**FRICTION).run([2.0])


def test_the_struct_of_callbacks_may_vanish_after_instantiation(wheel):
    w = wheel()
    w.close()
    struct = fmi2CallbackFunctions()
    logger = fmi2CallbackLoggerTYPE(w.keep_message)
    struct.logger = logger
    name = b"wheel"
    w.component = w.fmi2Instantiate(name, 1, w.guid.encode(), None, byref(struct), 0, 0)
    struct.logger = fmi2CallbackLoggerTYPE()  # null: would crash if it were looked up again
    w.start()
    assert w.set(m=3.0) == ERROR and len(w.messages) == 1
