"""Lives of one instance in which memory runs short, at each allocation in turn, once or from there on.

    LD_PRELOAD=short_memory.so python -m robustness.short_memory FOLDER FORMULATION LAW METHOD

FOLDER holds the unpacked FMU. Prints as JSON what was counted. It fails where a
promise is broken: no crash, no leak; an error has its message; once there is memory again, the same instance and a new
one go on with the bits of an undisturbed life.
"""

import json
import sys
from ctypes import CDLL, c_long
from itertools import pairwise

from fmpy import read_model_description
from support.driver import ERROR, FMU2Wheel, Message

HOOK = CDLL(None)
FOR_GOOD = 2**62


def counted(name: str) -> c_long:
    return c_long.in_dll(HOOK, name)


def fail(first: int, last: int) -> None:
    """Only the allocations first to last fail, counted from now on; 0, 0: none."""
    numbers = {"watching": 1, "number": 0, "failed": 0, "first_failing": first, "last_failing": last}
    for name, value in numbers.items():
        counted(name).value = value


class Lives:
    def __init__(self, folder: str, choices: list[int]):
        self.values = dict(zip(("formulation", "friction_law", "method"), choices, strict=True)) | {"s": 0.3}
        self.loaded = FMU2Wheel(folder, read_model_description(folder))
        self.taken: dict[str, int] = {}

    def begin(self) -> FMU2Wheel | None:
        """An instance, or none: then the reason was logged."""
        logged: list[Message] = []
        self.loaded.on_message = logged.append
        try:
            return self.loaded.new()
        except Exception:
            assert logged, "no instance and no message"
            return None

    def run(self, w: FMU2Wheel) -> list[bytes]:
        """From instantiated, through sticks and releases, then back by a copy out of bytes. The first run counts the
        allocations of the start, of the steps, and of a snapshot that comes back from bytes."""
        marks = [0, counted("number").value]
        rows = w.start(**self.values).run([0.1 * k for k in range(1, 31)])
        marks.append(counted("number").value)
        blob = w.serialized()
        rows += w.run([3.1])
        assert w.restore(blob) != ERROR
        marks.append(counted("number").value)
        w.time = 3.0
        taken = [after - before for before, after in pairwise(marks)]
        self.taken = self.taken or dict(zip(("start", "run", "snapshots"), taken, strict=True))
        return rows + w.run([3.1])

    def live(self, first: int, last: int, undisturbed: list[bytes] | None) -> list[bytes]:
        fail(first, last)
        w = self.begin()
        if w:
            try:
                rows = self.run(w)
            except AssertionError:
                assert w.sentences and counted("failed").value, "an error without a message or a cause"
            counted("last_failing").value = 0
            assert w.reset() == 0, "an instance that was short of memory cannot be reset"
            rows = self.run(w)
            assert undisturbed in (None, rows), "other bits"
            w.close()
        assert counted("live").value == 0, "memory has leaked"
        return rows if w else []

    def disturbed(self, for_good: bool) -> int:
        """How many lives were: after each an undisturbed one."""
        usual = self.live(0, 0, None)
        n = 0
        while True:
            self.live(n + 1, FOR_GOOD if for_good else n + 1, usual)
            if not counted("failed").value:
                return n
            self.live(0, 0, usual)
            n += 1


if __name__ == "__main__":
    lives = Lives(sys.argv[1], [int(word) for word in sys.argv[2:5]])
    failures = {"failed once": lives.disturbed(False), "failed for good": lives.disturbed(True)}
    print(json.dumps(lives.taken | failures))
