"""Serialized states: bytes without pointers, the same in every process; damaged or foreign bytes are refused."""

from ctypes import POINTER, byref, c_size_t, cast, create_string_buffer
from multiprocessing import get_context

import numpy as np
import pytest
from fmpy.fmi2 import fmi2FMUstate
from support.driver import ERROR, OK, FMU2Wheel
from support.motion import Library
from support.scenes import KINDS


def test_a_blob_with_any_one_bit_flipped_is_refused_and_the_instance_is_untouched(wheel):
    w, other = (wheel().start(stop=9.0, s=0.03).to(1.3) for _ in range(2))
    blob = w.serialized()
    w.back(blob)
    rng = np.random.default_rng(2)
    for k in range(len(blob)):
        damaged = bytearray(blob)
        damaged[k] ^= 1 << int(rng.integers(8))
        assert w.restore(bytes(damaged)) == ERROR, k
        assert w.messages.pop().text.startswith(
            "fmi2DeSerializeFMUstate: the bytes are damaged or not a state of this FMU and version ("
        )
    assert w.serialized() == blob
    assert w.run([3.0]) == other.run([3.0])


def test_truncated_prolonged_and_foreign_blobs_are_refused(wheel):
    w = wheel().start()
    blob = w.serialized()
    w.back(blob)
    for size in range(len(blob)):
        assert w.restore(blob[:size]) == ERROR
    rng = np.random.default_rng(3)
    for foreign in (blob + b"\0", bytes(len(blob)), rng.bytes(len(blob)), blob[::-1], blob[8:] + blob[:8]):
        assert w.restore(foreign) == ERROR
    assert len(w.take_messages()) == len(blob) + 5
    assert w.serialized() == blob


def test_too_small_an_array_is_refused_and_too_large_a_one_is_not(wheel):
    w = wheel().start()
    state, size = w.snapshot(), c_size_t()
    assert w.fmi2SerializedFMUstateSize(w.component, state, byref(size)) == OK
    blob = create_string_buffer(size.value + 8)
    assert w.fmi2SerializeFMUstate(w.component, state, blob, size.value - 1) == ERROR
    assert w.take_messages()[0].text == "fmi2SerializeFMUstate: the array is shorter than the state."
    assert blob.raw == bytes(size.value + 8)
    assert w.fmi2SerializeFMUstate(w.component, state, blob, size.value + 8) == OK
    assert blob.raw[: size.value] == w.serialized() and blob.raw[size.value :] == bytes(8)


def test_a_state_is_reused_where_it_is_not_null(wheel):
    """Ten thousand snapshots into one state: the memory stays one block, whatever its size."""
    w, before_start = wheel().start(s=0.03), wheel()
    state = w.snapshot()
    place = state.value
    for _ in range(10000):
        assert w.fmi2GetFMUstate(w.component, byref(state)) == OK
    assert state.value == place
    early = before_start.snapshot()
    assert w.fmi2GetFMUstate(w.component, byref(early)) == OK  # a smaller block grows
    ahead = w.run([1.0])
    assert w.fmi2SetFMUstate(w.component, early) == OK
    w.time = 0.0
    assert w.run([1.0]) == ahead


def test_freeing_no_state_is_without_effect_and_a_state_outlives_its_instance(wheel):
    w, other = wheel().start(), wheel()
    null = fmi2FMUstate()
    assert w.fmi2FreeFMUstate(w.component, None) == OK
    assert w.fmi2FreeFMUstate(w.component, byref(null)) == OK
    state, ahead = w.snapshot(), w.run([1.0])
    w.close()
    assert other.fmi2SetFMUstate(other.component, state) == OK
    assert other.run([1.0]) == ahead
    assert other.fmi2FreeFMUstate(other.component, byref(state)) == OK and not state
    assert other.fmi2FreeFMUstate(other.component, byref(state)) == OK
    assert other.fmi2SetFMUstate(other.component, state) == ERROR


def test_a_caller_that_passes_a_state_where_its_address_belongs_frees_nothing(wheel):
    """fmusim 0.0.39 does so after saving and after restoring a state."""
    w = wheel().start(s=0.03)
    state = w.snapshot()
    misread = cast(state, POINTER(fmi2FMUstate))
    # What fmi2FreeFMUstate takes for the state is a word of its own memory, which was never handed out.
    assert w.fmi2FreeFMUstate(w.component, misread) == OK
    ahead = w.run([1.5])
    assert w.fmi2SetFMUstate(w.component, state) == OK
    w.time = 0.0
    assert w.run([1.5]) == ahead
    assert w.fmi2FreeFMUstate(w.component, byref(state)) == OK and not state


def test_the_bytes_depend_on_the_past_alone(wheel):
    """No pointer and no leftover goes into them: another instance, elsewhere in memory, has the same bytes."""
    for values in KINDS.values():
        w, other = wheel().start(**values), wheel().start(m=3.0).to(0.3)
        assert other.reset() == OK
        other.start(**values)
        assert w.run([0.5, 2.0]) == other.run([0.5, 2.0])
        assert w.serialized() == other.serialized()
        assert w.by(1e-3).serialized() != other.serialized()


def continued(w: FMU2Wheel) -> tuple[list[bytes], bytes]:
    """All bits over the two seconds after 1.75 s, and the state at the end."""
    return w.run([1.75 + k / 4 for k in range(1, 9)]), w.serialized()


def restored_and_continued(folder: str, blob: bytes) -> tuple[list[bytes], bytes]:
    with Library(folder).wheel() as w:
        return continued(w.back(blob))


@pytest.mark.local
def test_in_another_process_a_restored_wheel_goes_on_with_the_same_bits(wheel, fmu):
    blobs, expected = [], []
    for values in KINDS.values():
        w = wheel().start(**values).to(1.75)
        blobs.append((fmu, w.serialized()))
        expected.append(continued(w))
    with get_context("spawn").Pool(1) as pool:
        assert pool.starmap(restored_and_continued, blobs) == expected
    assert len({state for _, state in expected}) == len(KINDS)  # the partner: each scene has bits of its own
