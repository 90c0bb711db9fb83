"""The other process of the serialization test: restores each state of a folder and prints a hash of what follows."""

from __future__ import annotations

import sys
from hashlib import sha256
from pathlib import Path

from fmpy import read_model_description
from support.driver import OK, FMU2Wheel


def continue_run(w: FMU2Wheel, t: float) -> bytes:
    """All bits over the next two seconds, and the state at the end."""
    w.time = t
    return b"".join([*w.run([t + k / 4 for k in range(1, 9)]), w.serialized()])


def main(folder: str, states: Path) -> None:
    description = read_model_description(folder)
    for path in sorted(states.glob("*.state")):
        w = FMU2Wheel(folder, description)
        assert w.restore(path.read_bytes()) == OK
        print(path.name, sha256(continue_run(w, 1.75)).hexdigest())
        w.close()


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
