"""States and their bytes: without pointers, the same in every process; damaged ones are refused.

A checksum guards against accidents, not against bytes from elsewhere: here it is made right again after each change.
Run under the sanitizers with the contract tests.
"""

import struct
from ctypes import POINTER, addressof, byref, c_char, c_size_t, cast
from multiprocessing import get_context

import numpy as np
import pytest
from fmpy.fmi2 import fmi2FMUstate

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, FMU2Wheel
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import KINDS

UNKNOWN = "this FMU did not create the state"
HEADER, SUM = 3, 2  # words: mark, size, checksum of what follows; the place of the last
DAMAGED = "fmi2DeSerializeFMUstate: the bytes are"


def test_damaged_truncated_and_foreign_bytes_are_refused_and_the_instance_is_untouched(wheel):
    w, other = (wheel().start(stop=9.0, s=0.03).to(1.3) for _ in range(2))
    blob, rng = bytes(w.serialized()), np.random.default_rng(2)
    w.back(blob)
    places = range(len(blob))
    flipped = [blob[:k] + bytes([blob[k] ^ 1 << int(rng.integers(8))]) + blob[k + 1 :] for k in places]
    foreign = blob + b"\0", bytes(len(blob)), rng.bytes(len(blob)), blob[::-1], blob[8:] + blob[:8]
    for wrong in (*flipped, *(blob[:size] for size in places), *foreign):
        assert w.restore(wrong) == ERROR
        assert w.said().startswith(DAMAGED)
    assert w.serialized() == blob
    assert w.run([3.0]) == other.run([3.0])


def test_too_small_an_array_is_refused_and_too_large_a_one_is_not(wheel):
    w = wheel().start()
    state, size = w.snapshot(), c_size_t()
    assert w.ask("SerializedFMUstateSize", state, byref(size)) == OK
    blob = (c_char * (size.value + 8))()
    assert w.ask("SerializeFMUstate", state, blob, size.value - 1) == ERROR
    assert w.said() == "fmi2SerializeFMUstate: the array is shorter than the state."
    assert blob.raw == bytes(size.value + 8)
    assert w.ask("SerializeFMUstate", state, blob, size.value + 8) == OK
    assert blob.raw[: size.value] == w.serialized() and blob.raw[size.value :] == bytes(8)


def test_a_state_is_reused_where_it_is_not_null(wheel):
    """Ten thousand snapshots into one state: the memory stays one block, whatever its size."""
    w = wheel().start(s=0.03)
    state, early = w.snapshot(), wheel().snapshot()
    place = state.value
    assert {w.ask("GetFMUstate", byref(state)) for _ in range(10000)} == {OK}
    assert state.value == place
    assert w.ask("GetFMUstate", byref(early)) == OK  # a smaller block grows
    ahead = w.run([1.0])
    assert w.ask("SetFMUstate", early) == OK
    w.time = 0.0
    assert w.run([1.0]) == ahead


def test_a_state_that_takes_a_shorter_one_is_no_longer_than_it(wheel):
    """That of a run that is stepped through holds the solver's history, that of a new instance none."""
    w, size = wheel().start(s=0.03).to(0.5), c_size_t()
    state, long, fresh = w.snapshot(), len(w.serialized()), wheel().serialized()
    assert w.reset() == w.ask("GetFMUstate", byref(state)) == w.ask("SerializedFMUstateSize", state, byref(size)) == OK
    assert size.value == len(fresh) < long
    assert w.start(s=0.03).ask("SetFMUstate", state) == OK and w.serialized() == fresh
    w.free(state)


def test_a_restored_instance_logs_its_faults_again(wheel):
    w = wheel().initializing(m=-1.0, r_0=0.0)
    assert w.get_one("tau")[0] == DISCARD and len(logged := w.texts()) == 2
    other = wheel().back(w.serialized())
    for each in (w, other):
        each.take_messages()
        each.get_one("tau")
    assert other.texts() == logged and not w.texts()  # the partner: once for each instance
    for each in (w, other):  # the end of initialization names all faults, logged before or not
        assert each.exitInitializationMode() == ERROR and each.texts() == logged


def test_a_state_outlives_its_instance_and_is_freed_once(wheel):
    w, other = wheel().start(), wheel()
    state, ahead = w.snapshot(), w.run([1.0])
    w.close()
    assert other.ask("SetFMUstate", state) == OK
    assert other.run([1.0]) == ahead
    other.free(state)
    other.free(state)
    assert other.ask("SetFMUstate", state) == ERROR


def test_a_caller_that_passes_a_state_where_its_address_belongs_frees_nothing(wheel):
    """fmusim 0.0.39 does so after saving and after restoring a state."""
    w = wheel().start(s=0.03)
    state = w.snapshot()
    # What fmi2FreeFMUstate takes for the state is the first word of the state, a null pointer.
    assert w.ask("FreeFMUstate", cast(state, POINTER(fmi2FMUstate))) == OK
    ahead = w.run([1.5])
    assert w.ask("SetFMUstate", state) == OK
    w.time = 0.0
    assert w.run([1.5]) == ahead
    w.free(state)


OWN = (c_char * 64)()  # memory of the caller's


def no_states(w: FMU2Wheel) -> list[fmi2FMUstate]:
    """Pointers to something else: an instance, its middle, memory of the caller's; and odd numbers."""
    return [fmi2FMUstate(value) for value in (w.component, w.component + 8, addressof(OWN), 1, 2**64 - 1)]


def test_a_pointer_to_something_else_is_refused_as_a_state_is_not_freed_and_can_take_one(wheel):
    w, other = wheel().start(s=0.03).to(0.5), wheel().start(s=0.03).to(0.5)
    blob, size, buffer = w.serialized(), c_size_t(), bytes(1 << 17)
    w.take_messages()
    for state in [*no_states(w), *no_states(other)]:
        value = state.value
        answers = [w.ask("SetFMUstate", state), w.ask("SerializedFMUstateSize", state, byref(size))]
        assert [*answers, w.ask("SerializeFMUstate", state, buffer, len(buffer))] == [ERROR] * 3
        assert [text.split(": ")[1] for text in w.texts()] == [f"{UNKNOWN}."] * 3
        assert w.ask("FreeFMUstate", byref(state)) == OK and state.value == value
        for take in (("GetFMUstate",), ("DeSerializeFMUstate", blob, len(blob))):
            state.value = value
            assert w.ask(*take, byref(state)) == w.ask("SetFMUstate", state) == OK  # the partner
            w.free(state)
    assert OWN.raw == bytes(64) and w.run([1.0]) == other.run([1.0])


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
    assert len({state for _, state in expected}) == len(KINDS)  # the partner: no two scenes have the same bits


def checksum(data: bytes) -> int:
    """FNV-1a over words of 64 bits with a mixing shift, as support/bytes.hpp has it."""
    total = 0xCBF29CE484222325
    for (word,) in struct.iter_unpack("<Q", data):
        total = (total ^ word) * 0x100000001B3 % 2**64
        total ^= total >> 29
    return total


def words_of(blob: bytes) -> tuple[int, ...]:
    return struct.unpack(f"<{len(blob) // 8}Q", blob)


def signed(words) -> bytes:
    """The bytes of these words with the checksum right."""
    body = struct.pack(f"<{len(words) - HEADER}Q", *words[HEADER:])
    return struct.pack("<3Q", *words[:SUM], checksum(body)) + body


def test_a_state_of_another_version_is_refused_with_a_message(wheel):
    """Version 2.0.0 had a header for the call state in front of the mark; later ones have another mark."""
    w = wheel().start()
    words = list(words_of(w.serialized()))
    for old in ([2, 0x7FF8000000000000, 77, 0x3430554D46484557, *words[1:]], [words[0] - (1 << 56), *words[1:]]):
        assert w.restore(struct.pack(f"<{len(old)}Q", *old)) == ERROR
        assert w.said() == f"{DAMAGED} no state of this FMU, its version and kind of instance."


def test_a_state_that_slides_although_its_wheel_cannot_is_refused(wheel):
    """It has no equations for a slip. The contact's word is the one that a start with slip sets to 1."""
    road = {"mu_max": 0.5, "mu_slide": 0.4}
    rolls, slides = (words_of(wheel().start(**road, **slip).serialized()) for slip in ({}, {"slip_x_start": 1.0}))
    (contact,) = (place for place, pair in enumerate(zip(rolls, slides, strict=True)) if pair == (0, 1))
    for w, taken in ((wheel().start(), False), (wheel().start().to(0.5), False), (wheel().start(**road), True)):
        words = words_of(w.serialized())
        assert words[contact] == 0
        assert (w.restore(signed([*words[:contact], 1, *words[contact + 1 :]])) == OK) == taken
        assert taken or w.said() == "fmi2SetFMUstate: a number is out of its bounds."
        assert taken or w.by(0.01).get("contact_mode") == [0]


def test_a_state_that_rests_in_a_law_while_it_slides_is_refused(wheel):
    """Whether it rests is the first word of the solver's history, which a wheel that has not moved lacks."""
    law = {"guided": True, "theta_start": 1.5, "s": 0.01, "friction_law": "regularized", "omega_s": 0.1}
    slides = law | {"mu_max": 0.5, "mu_slide": 0.4, "phi_dot_start": 0.0, "slip_x_start": 2.0, "M_brake": 900.0}
    for start, until, rests in ((slides, 0.1, False), (law | {"phi_dot_start": -0.1, "M_brake": 60.0}, 1.0, True)):
        w = wheel().start(**start)
        place = len(words_of(w.serialized()))
        words = words_of(w.to(until).serialized())
        assert (words[place], w.get("contact_mode")[0]) == (rests, not rests)
        forged = signed([*words[:place], 1, *words[place + 1 :]])
        assert (w.restore(forged) == OK) == rests  # the partner: one that does rest
        assert rests or w.said() == "fmi2SetFMUstate: a number is out of its bounds."


EXTREME = {"guided": True, "theta_start": 1.5, "phi_dot_start": 0.0, "m": 1e-9, "r_0": 1e-3, "r": 0.0, "s": 1e-5}
EXTREME |= {f"J_{axis}": moment for axis, moment in zip("xyz", (5e-16, 5e-16, 1e-15), strict=True)}


LOADS = [{"M_brake": 1e300}, {"M_brake": 1e300, "F_Z": -1e300}, {"F_Z": 1e300}, {"M_1": 1e300}]


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("law", [{}, {"friction_law": 2}, {"mu_max": 1.0, "mu_slide": 0.5}])
@pytest.mark.parametrize("guided", [True, False])
def test_whatever_loads_a_wheel_its_own_state_is_taken(wheel, load, law, guided):
    w = wheel().start(**EXTREME | law | {"guided": guided}).put(**load)
    for _ in range(2):
        w.step(1e-3)
        blob = w.serialized()
        assert wheel().back(blob).serialized() == blob


def test_a_run_restored_on_its_way_to_rest_in_a_regularized_law_goes_on_with_the_same_bits(wheel):
    """Collocation takes over there, with a first step that follows from the state in which the law began."""
    law = {"s": 0.03, "friction_law": 2, "omega_s": 1e-3}
    w, ends = wheel().start(**law).to(1.2), set()
    for t in np.linspace(1.203, 1.227, 9):
        state = w.to(t).serialized()
        ends |= {w.to(1.235).bits(), wheel().start(**law).back(state).to(1.235).bits()}
        w.back(state)
    assert len(ends) == 1
    assert wheel().start(**law, tolerance=1e-7).to(1.235).bits() not in ends  # the partner
