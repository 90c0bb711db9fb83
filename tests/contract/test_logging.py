"""Messages: who gets them, when, in which form; and that nothing else is ever written."""

import re
from ctypes import byref

import numpy as np
import pytest
from contract.call_states import STATES, TABLE, bring_to, call
from fmpy.fmi2 import fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from support.bounds import within

from wheelfmu.fmu.driver import DISCARD, ERROR, OK

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
    within(abs(float(t) - FIRST_STICK), 1e-8, "instant of the first stick, s")  # its tolerance
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


CATEGORIES = ("logEvents", "logStatusWarning", "logStatusDiscard", "logStatusError")


@pytest.mark.parametrize("category", [*CATEGORIES, "logAll"])
def test_categories_filter(wheel, category):
    w = wheel()
    w.setDebugLogging(True, [category])
    w.start(tolerance=0.1, **FRICTION).to(2.0)  # a warning: clamped; events: stick, release, reversal
    assert (w.set(F_X=np.nan), w.set(m=1.0)) == (DISCARD, ERROR)
    assert {m.category for m in w.take_messages()} == ({*CATEGORIES} if category == "logAll" else {category})


def test_categories_can_be_switched_off_one_by_one_and_all_at_once(wheel):
    w = wheel(logging=True).start(**FRICTION)

    def logged() -> int:
        assert w.set(m=1.0) == ERROR
        return len(w.take_messages())

    w.setDebugLogging(False, ["logEvents"])
    assert w.to(2.0).messages == [] and logged() == 1
    w.setDebugLogging(False, [])
    assert logged() == 0
    w.setDebugLogging(True, [])
    assert logged() == 1
    w.setDebugLogging(False, ["logStatusError", "logStatusDiscard", "logStatusWarning"])
    assert logged() == 0


def test_percent_and_hash_signs_are_doubled_and_texts_stay_short_and_without_newline(wheel):
    w, begin = wheel(), "fmi2SetDebugLogging: there is no category "
    assert w.ask("SetDebugLogging", 1, 2, [b"logAll", b"a%s#b#%n"]) == OK
    assert w.said() == f'{begin}"a%%s##b##%%n".'
    assert w.ask("SetDebugLogging", 1, 2, [b"logAll", b"#%" * 5000]) == OK
    long = w.said()
    rest = long.replace("##", "").replace("%%", "")
    assert len(long) < 1000 and rest.startswith(begin) and not {"#", "%", "\n"} & {*rest}


def test_a_logger_that_calls_back_is_answered_with_an_error_and_nothing_hangs(wheel):
    w, answers = wheel(logging=True), []

    def call_back(message) -> None:
        answers.append(w.get_one("theta")[0])
        answers.extend(
            w.ask(*call) for call in (("DoStep", 0.0, 1.0, 0), ("Reset",), ("Terminate",), ("EnterEventMode",))
        )
        w.fmi2FreeInstance(w.component)  # without effect while a call is under way

    w.on_message = call_back
    w.start(**FRICTION).to(1.5)  # stick and release
    assert call(w, "fmi2EnterEventMode") == ERROR
    assert answers == [ERROR] * 15
    w.on_message = None
    assert w.bits() == wheel().start(**FRICTION).run([1.5])[0]
    assert w.get_one("X_O")[0] == OK  # the partner: outside a call it is answered


@pytest.mark.parametrize("callbacks", ["none", "empty", "logger only, which vanishes"])
def test_missing_callbacks_are_survived_and_their_struct_may_vanish_after_instantiation(wheel, callbacks):
    w, struct, logs = wheel(), fmi2CallbackFunctions(), callbacks.startswith("logger")
    logger = fmi2CallbackLoggerTYPE(w.keep_message)
    if logs:
        struct.logger = logger
    w.close()
    pointer = None if callbacks == "none" else byref(struct)
    w.component = w.fmi2Instantiate(b"wheel", 1, w.guid.encode(), None, pointer, 0, 1)
    struct.logger = fmi2CallbackLoggerTYPE()  # null: would crash if it were looked up again
    assert w.start(**FRICTION).set(m=3.0) == ERROR
    assert len(w.messages) == logs
    assert w.run([2.0]) == wheel().start(**FRICTION).run([2.0])
