"""Instances and states whose memory is watched, by what a caller does with them. glibc only.

    python -m robustness.handles FOLDER WHAT

FOLDER holds the unpacked FMU. With MALLOC_MMAP_THRESHOLD_=0 each block has pages of its own; those of all instances and
states but one of each are fenced off, and who touches them gets SIGSEGV. WHAT is used then: own, the ones not fenced
off; an instance or a state that is. With short_memory.so preloaded, freed: handles that were freed, while their memory
is still there.
"""

import mmap
import sys
from ctypes import CDLL, byref, c_long, c_size_t, c_void_p

from fmpy import read_model_description
from fmpy.fmi2 import fmi2FMUstate
from support.driver import ERROR, OK, FMU2Wheel

C = CDLL(None)
OWN, COUNT = 3, 8


def pages_of(block: int) -> tuple[c_void_p, c_size_t]:
    """Start and size of the pages of a block of memory, which are its own."""
    offset = block % mmap.PAGESIZE
    assert offset <= 16, "the block shares a page"
    return c_void_p(block - offset), c_size_t(C.malloc_usable_size(c_void_p(block)))


def use(w: FMU2Wheel, state: fmi2FMUstate) -> None:
    """Every call that takes a state of t = 0.1 s; new instances and states come and go."""
    assert w.ask("SetFMUstate", state) == OK
    w.time = 0.1
    ahead = w.run([0.2])
    assert w.restore(w.serialized()) == w.ask("GetFMUstate", byref(state)) == OK
    with w.new() as other:
        assert other.ask("SetFMUstate", state) == OK and [other.bits()] == ahead
    assert w.terminate() == w.reset() == OK


def fenced(loaded: FMU2Wheel, what: str) -> None:
    wheels = [loaded.new().start(s=0.03).by(0.1) for _ in range(COUNT)]
    states = [w.snapshot() for w in wheels]
    own, state = wheels.pop(OWN), states.pop(OWN)
    fenced_off = [pages_of(block) for block in (*(w.component for w in wheels), *(state.value for state in states))]
    assert {C.mprotect(*pages, 0) for pages in fenced_off} == {0}
    use(wheels[0] if what == "instance" else own, states[0] if what == "state" else state)
    own.free(state)
    own.close()
    assert {C.mprotect(*pages, mmap.PROT_READ | mmap.PROT_WRITE) for pages in fenced_off} == {0}
    for other, taken in zip(wheels, states, strict=True):
        other.ask("SetFMUstate", taken)
        other.free(taken)
        other.close()


def freed(loaded: FMU2Wheel) -> None:
    for name in ("watching", "holding"):
        c_long.in_dll(C, name).value = 1
    w, other = (loaded.new().start(s=0.03).by(0.1) for _ in range(2))
    state, size, buffer = w.snapshot(), c_size_t(), bytes(1 << 17)
    use(w, state)
    gone, component = fmi2FMUstate(state.value), w.component
    w.free(state)
    w.close()
    answers = [other.ask("SetFMUstate", gone), other.ask("SerializedFMUstateSize", gone, byref(size))]
    assert [*answers, other.ask("SerializeFMUstate", gone, buffer, len(buffer))] == [ERROR] * 3
    assert other.ask("FreeFMUstate", byref(gone)) == OK and gone  # no effect: it would be null
    w.component = component
    assert [w.terminate(), w.reset(), w.ask("GetFMUstate", byref(gone))] == [ERROR] * 3
    w.close()


if __name__ == "__main__":
    library = FMU2Wheel(sys.argv[1], read_model_description(sys.argv[1]))
    if sys.argv[2] == "freed":
        freed(library)
    else:
        fenced(library, sys.argv[2])
