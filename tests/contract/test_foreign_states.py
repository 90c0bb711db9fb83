"""States that were never handed out, and bytes that no instance wrote: refused with a sentence, and nothing changes."""

import struct
from ctypes import addressof, byref, c_size_t, create_string_buffer

import numpy as np
import pytest
from fmpy.fmi2 import fmi2FMUstate
from support.driver import ERROR, OK

from contract.call_states import bring_to

UNKNOWN = "this FMU did not create the state"
DAMAGED = "fmi2DeSerializeFMUstate: the bytes are damaged or not a state of this FMU and version ({})."


OWN = create_string_buffer(64)  # memory of the caller's


def garbage() -> list[fmi2FMUstate]:
    """What an uninitialised pointer may hold."""
    return [fmi2FMUstate(value) for value in (1, 8, 0xDEADBEEF, 2**63 + 8, 2**64 - 1, addressof(OWN))]


def test_a_state_is_taken_into_a_pointer_that_was_never_handed_out(wheel):
    """FMI4j passes an uninitialised one."""
    w = wheel().start(s=0.03)
    w.run([0.5])
    blob = w.serialized()
    for state in garbage():
        assert w.fmi2GetFMUstate(w.component, byref(state)) == OK
        ahead = w.run([1.0])
        assert w.fmi2SetFMUstate(w.component, state) == OK
        w.time = 0.5
        assert w.run([1.0]) == ahead
        assert w.fmi2FreeFMUstate(w.component, byref(state)) == OK and not state
        w.back(blob)
    for state in garbage():
        buffer = create_string_buffer(blob, len(blob))
        assert w.fmi2DeSerializeFMUstate(w.component, buffer, len(blob), byref(state)) == OK
        assert w.fmi2FreeFMUstate(w.component, byref(state)) == OK and not state


def test_an_unknown_state_is_refused_with_a_sentence_and_freeing_it_has_no_effect(wheel):
    w, undisturbed = wheel().start(s=0.03), wheel().start(s=0.03)
    freed, size, buffer = w.snapshot(), c_size_t(), create_string_buffer(1 << 17)
    gone = fmi2FMUstate(freed.value)
    assert w.fmi2FreeFMUstate(w.component, byref(freed)) == OK
    for state in [*garbage(), gone]:
        value = state.value
        assert w.fmi2SetFMUstate(w.component, state) == ERROR
        assert w.fmi2SerializedFMUstateSize(w.component, state, byref(size)) == ERROR
        assert w.fmi2SerializeFMUstate(w.component, state, buffer, len(buffer)) == ERROR
        assert [m.text.split(": ")[1] for m in w.take_messages()] == [f"{UNKNOWN}."] * 3
        assert w.fmi2FreeFMUstate(w.component, byref(state)) == OK and state.value == value
    assert w.run([1.0]) == undisturbed.run([1.0])
    known = w.snapshot()  # the partner
    assert w.fmi2SetFMUstate(w.component, known) == OK
    assert w.fmi2FreeFMUstate(w.component, byref(known)) == OK


def test_hundreds_of_states_are_kept_apart(wheel):
    w = wheel().start()
    states = []
    for k in range(300):
        states.append((w.snapshot(), w.bits()))
        w.run([(k + 1) / 64])
    for state, bits in states[::-7] + states[::7]:
        assert w.fmi2SetFMUstate(w.component, state) == OK and w.bits() == bits
    for state, _ in states:
        assert w.fmi2FreeFMUstate(w.component, byref(state)) == OK and not state


HEADER = 3  # words: mark, size, checksum of what follows


def checksum(data: bytes) -> int:
    """That of support/bytes.hpp: each word of 64 bits is multiplied in and mixed by a shift."""
    total = 0xCBF29CE484222325
    for (word,) in struct.iter_unpack("<Q", data):
        total = (total ^ word) * 0x100000001B3 % 2**64
        total ^= total >> 29
    return total


def words_of(blob: bytes) -> tuple[int, ...]:
    return struct.unpack(f"<{len(blob) // 8}Q", blob)


def signed(words) -> bytes:
    """The bytes of these words with the checksum right."""
    head, body = words[: HEADER - 1], struct.pack(f"<{len(words) - HEADER}Q", *words[HEADER:])
    return struct.pack("<3Q", *head, checksum(body)) + body


def as_word(x: float) -> int:
    return struct.unpack("<Q", struct.pack("<d", x))[0]


def place_of(w, row: str) -> int:
    """The word of a row of the table in wheel/snapshot.cpp."""
    parameters, inputs = w.references["F_X"], 7 * 4
    after = HEADER + parameters
    stop, asked = after + 1, after + 3
    phase = asked + inputs + 2
    of_phase = ("phase", "ended by", "s", "law", "sigma", "layer", "origin")
    t = phase + len(of_phase) + inputs
    places = {"stop time": stop, "tolerance": stop + 1, **{name: phase + k for k, name in enumerate(of_phase)}}
    places |= {"t": t, "last change": t + 1, "y": t + 2}
    of_events = t + 14  # for each: whether it lies below zero, how often it occurred, when it last did
    places |= {"below": of_events + 3 * LOST_CONTACT, "pulls": of_events + 3 * LOST_CONTACT + 1}
    places |= {"below flat": of_events + 3 * FELL_FLAT, "times flat": of_events + 3 * FELL_FLAT + 1}
    return (places | {"transitions": of_events + 3 * EVENTS})[row]


def forged(w, blob: bytes, **changes: int | float) -> bytes:
    """The blob with rows changed, whole numbers or doubles, and its checksum set right."""
    words = list(words_of(blob))
    for row, value in changes.items():
        words[place_of(w, row.replace("_", " "))] = as_word(value) if isinstance(value, float) else value
    return signed(words)


CREATED, INITIALIZING, FAULTY, INITIAL, AT_START, STEPPING, UNFOLDED, EVENT_MODE, CONTINUOUS_TIME, ENDED = range(10)
SPIN_CHANGES, LOST_GRIP, LOST_CONTACT, FELL_FLAT, EVENTS = range(4, 9)  # of the list in wheel/run.hpp
PASSING, STICKING = 2, 3


def test_a_phase_that_no_instance_can_have_been_in_is_refused(wheel):
    running, fresh = bring_to(wheel(), "step complete"), bring_to(wheel(), "instantiated")
    before, blob, young = running.serialized(), running.serialized(), fresh.serialized()
    assert forged(running, blob) == blob
    assert words_of(blob)[place_of(running, "phase")] == UNFOLDED
    wrong = [{"phase": phase} for phase in (13, EVENT_MODE, 2**63, AT_START, INITIAL, STEPPING)]
    wrong += [{"stop_time": np.nan}, {"stop_time": -np.inf}, {"tolerance": 1.0}, {"t": -1.0}, {"t": np.inf}]
    wrong += [{"last_change": 9.0}, {"origin": 9.0}, {"s": -1.0}, {"s": 0.1}, {"law": 0}, {"law": 2}]
    wrong += [{"below": 1}, {"below": 2}, {"below_flat": 1}, {"times_flat": 1}, {"pulls": 1}]
    wrong += [{"phase": ENDED}, {"ended_by": FELL_FLAT}, {"phase": ENDED, "ended_by": SPIN_CHANGES}, {"layer": 1}]
    for changes in wrong:
        assert running.restore(forged(running, blob, **changes)) == ERROR, changes
        assert running.take_messages()[-1].text.startswith(DAMAGED.split(" (")[0]), changes
    for t, fault in ((-1.0, "a change lies ahead of the time reached"), (np.inf, "time reached, s")):
        assert running.restore(forged(running, blob, t=t)) == ERROR
        assert running.take_messages()[-1].text == DAMAGED.format(fault)
    words = list(words_of(blob))
    words[place_of(running, "phase") - 2] = 2  # a third kind
    assert running.restore(signed(words)) == ERROR
    assert running.take_messages()[-1].text == DAMAGED.format("whose solver moves the wheel")
    for phase in (INITIAL, AT_START, STEPPING, UNFOLDED, ENDED):  # a step would use a solver that is not there
        assert running.restore(forged(running, young, phase=phase)) == ERROR
    assert running.serialized() == before
    assert running.restore(forged(running, blob, stop_time=9.0)) == OK  # the partner: it can have been in this one
    assert running.step_to(1.0) == OK and running.step_to(9.5) == ERROR


@pytest.mark.parametrize("keep_contact", [False, True])
def test_a_law_a_ground_or_a_count_that_no_rolling_wheel_has_is_refused(wheel, keep_contact):
    w = wheel().start(s=0.03, keep_contact=keep_contact)
    assert w.run([0.7])
    blob = w.serialized()
    grounds = ({"below": k} for k in ((2, 3) if keep_contact else (1, 2)))
    signs = ({"sigma": x} for x in (-0.5, 0.5, 2.0, np.nan))
    for changes in (*grounds, *signs, {"law": 1}, {"layer": 2}):
        assert w.restore(forged(w, blob, **changes)) == ERROR, changes
    first, words = place_of(w, "transitions"), words_of(blob)
    for place in range(first, first + 6):  # the counters
        assert w.restore(signed([*words[:place], 2**63 - 1, *words[place + 1 :]])) == ERROR, place
    assert w.restore(blob) == OK  # the partner


def test_a_choice_that_is_no_number_reads_as_the_least_integer(wheel):
    """While parameters are set they may be anything; under the sanitizers a conversion of no number is a fault."""
    w = bring_to(wheel(), "initialization")
    words = list(words_of(w.serialized()))
    words[HEADER + w.references["formulation"]] = as_word(np.nan)
    assert w.back(signed(words)).get("formulation") == [-(2**31)]


@pytest.mark.parametrize("changes", [(0, 0.0), (0, -0.5), (0, 3.2), (0, 1e-320), (1, 1e300), (2, -1e300), (3, 1e200)])
@pytest.mark.parametrize("start", [{}, {"s": 0.03}, {"s": 0.03, "method": "adams"}])
def test_a_state_that_is_no_state_of_a_wheel_is_refused(wheel, start, changes):
    """theta outside (0, pi), rates whose energy is infinite: the check of the initial state, for any state."""
    w = wheel().start(**start)
    assert w.run([0.5])
    blob, (entry, value) = w.serialized(), changes
    words = list(words_of(blob))
    words[place_of(w, "y") + entry] = as_word(value)
    assert w.restore(signed(words)) == ERROR
    assert w.take_messages()[-1].text == DAMAGED.format("the state is outside the model")


def test_a_state_of_another_version_is_refused_with_a_sentence(wheel):
    """Version 2.0.0 had a header for the call state in front of the mark; later ones have another mark."""
    w = wheel().start()
    words = list(words_of(w.serialized()))
    for old in ([2, as_word(np.inf), 77, 0x3430554D46484557, *words[1:]], [words[0] - (1 << 56), *words[1:]]):
        assert w.restore(struct.pack(f"<{len(old)}Q", *old)) == ERROR
        assert w.take_messages()[-1].text == DAMAGED.format("the mark of this version is missing")


def test_an_infinite_stop_time_is_none(wheel):
    w = wheel()
    assert w.fmi2SetupExperiment(w.component, 0, 0.0, 0.0, 1, np.inf) == OK
    assert (w.enterInitializationMode(), w.exitInitializationMode(), w.step(2.0)) == (OK, OK, OK)
    assert wheel().back(w.serialized()).bits() == w.bits()
    assert wheel().start(stop=1.0).step(2.0) == ERROR


@pytest.mark.parametrize("method", ["adams", "bdf", "runge_kutta"])
def test_a_place_in_a_layer_is_refused_where_the_method_was_chosen(wheel, method):
    law = {"friction_law": "regularized", "omega_s": 1e-6, "s": 0.03}
    chosen, automatic = (wheel(logging=True).start(method=m, **law) for m in (method, "automatic"))
    for w in (chosen, automatic):
        assert w.step(0.1) == OK
        assert w.restore(w.serialized()) == OK
    for layer in (PASSING, STICKING):
        assert chosen.restore(forged(chosen, chosen.serialized(), layer=layer)) == ERROR
        assert "the law of friction does not fit" in chosen.sentences[-1]
    assert words_of(automatic.serialized())[place_of(automatic, "layer")] != 0  # the partner
