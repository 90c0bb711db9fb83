"""States that were never handed out, and bytes that no instance wrote: refused with a sentence, and nothing changes."""

from __future__ import annotations

import struct
from ctypes import addressof, byref, c_size_t, create_string_buffer

import numpy as np
import pytest
from fmpy.fmi2 import fmi2FMUstate
from support.driver import ERROR, OK

from contract.call_states import STATES, bring_to

pytestmark = pytest.mark.contract

UNKNOWN = "the state is not one that this FMU handed out"
DAMAGED = "fmi2DeSerializeFMUstate: the bytes are damaged or not a state of this FMU and version."


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
        assert w.restore(blob) == OK
        w.time = 0.5
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


CALL = struct.Struct("<4B4sdQ")  # call state, prepared, has a stop time, last status, nothing, stop time, checksum


def checksum(data: bytes) -> int:
    """FNV-1a over words of 64 bits with a mixing shift, as support/archive.hpp has it."""
    total = 0xCBF29CE484222325
    for (word,) in struct.iter_unpack("<Q", data):
        total = (total ^ word) * 0x100000001B3 % 2**64
        total ^= total >> 29
    return total


def forged(blob: bytes, **changes) -> bytes:
    """The blob with fields of its call state changed and their checksum set right."""
    names = ("state", "prepared", "has_stop", "last", "nothing", "stop", "sum")
    fields = dict(zip(names, CALL.unpack_from(blob), strict=True)) | changes
    head = CALL.pack(*fields.values())
    return head[:16] + struct.pack("<Q", checksum(head[:16])) + blob[CALL.size :]


def test_a_call_state_that_no_instance_can_have_been_in_is_refused(wheel):
    running, fresh = bring_to(wheel(), "step complete"), bring_to(wheel(), "instantiated")
    before, blob, young = running.serialized(), running.serialized(), fresh.serialized()
    assert forged(blob) == blob
    wrong = [
        {"state": 6},
        {"state": 255},
        {"prepared": 2},
        {"has_stop": 2},
        {"has_stop": 255},
        {"last": 1},
        {"last": 4},
    ]
    wrong += [{"last": 77}, {"nothing": b"\0\0\1\0"}, {"stop": 3.0}, {"last": 2}, {"state": 0}, {"state": 1}]
    wrong += [{"state": 3}, *({"has_stop": 1, "stop": x} for x in (np.nan, np.inf, -np.inf))]
    for changes in wrong:
        assert running.restore(forged(blob, **changes)) == ERROR, changes
        assert running.take_messages()[-1].text == DAMAGED
    for state in (2, 3, 4):  # never started: a step from there would use a solver that is not there
        assert running.restore(forged(young, state=state)) == ERROR
    assert running.restore(forged(young, state=1, prepared=1)) == ERROR
    assert running.serialized() == before
    assert running.restore(forged(blob, has_stop=1, stop=9.0)) == OK  # the partner: it can have been in this one
    assert running.step_to(1.0) == OK and running.step_to(9.5) == ERROR


@pytest.mark.parametrize("state", STATES)
def test_the_state_of_every_call_state_is_taken_by_an_instance_in_every_other(wheel, state):
    """What is checked is no more than what can be."""
    w = bring_to(wheel(), state)
    blob = w.serialized()
    for other in STATES:
        target = bring_to(wheel(), other)
        assert target.restore(blob) == OK, (state, other)
        assert target.serialized() == blob


def test_an_infinite_stop_time_is_none(wheel):
    w = wheel()
    assert w.fmi2SetupExperiment(w.component, 0, 0.0, 0.0, 1, np.inf) == OK
    assert (w.enterInitializationMode(), w.exitInitializationMode(), w.step(2.0)) == (OK, OK, OK)
    other = wheel()
    assert other.restore(w.serialized()) == OK and other.bits() == w.bits()
    assert wheel().start(stop=1.0).step(2.0) == ERROR
