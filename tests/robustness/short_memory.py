"""Lives of one instance in which memory runs short, at each allocation in turn, once or from there on.

    LD_PRELOAD=short_memory.so python short_memory.py FOLDER FORMULATION LAW METHOD

FOLDER holds the unpacked FMU. It fails where a promise is broken: an error has its message; once there is memory again,
the same instance goes on with the bits of an undisturbed life.
"""

import sys
from ctypes import CDLL, c_long

from fmpy import read_model_description

from wheelfmu.fmu.driver import ERROR, FMU2Wheel, Message

number, first, last = (c_long.in_dll(CDLL(None), name) for name in ("number", "first_failing", "last_failing"))
NEVER = 2**62
loaded = FMU2Wheel(sys.argv[1], read_model_description(sys.argv[1]))
values = dict(zip(("formulation", "friction_law", "method"), map(int, sys.argv[2:5]), strict=True)) | {"s": 0.3}


def run(w: FMU2Wheel) -> list[bytes]:
    """From instantiated, through sticks and releases, then back by a copy out of bytes."""
    taken = number.value
    rows = w.start(**values).run([0.1 * k for k in range(1, 31)])
    assert number.value == taken, "a step takes memory"
    blob = w.serialized()
    rows += w.run([3.1])
    assert w.restore(blob) != ERROR
    w.time = 3.0
    return rows + w.run([3.1])


def life(failing: tuple[int, int]) -> list[bytes]:
    """Rows after the shortage; none where no instance could be made."""
    logged: list[Message] = []
    loaded.on_message, number.value, (first.value, last.value) = logged.append, 0, failing
    try:
        w = loaded.new()
    except Exception:
        assert logged, "no instance and no message"
        return []
    try:
        run(w)
    except AssertionError:
        assert w.sentences, "an error without a message"
    first.value = last.value = 0
    assert w.reset() == 0, "an instance that was short of memory cannot be reset"
    rows = run(w)
    w.close()
    return rows


undisturbed = life((NEVER, NEVER))
allocations = number.value
for n in range(1, allocations + 1):
    for failing in ((n, n), (n, NEVER)):
        assert life(failing) in ([], undisturbed), "other bits"
print(allocations)
