"""What the independent reference has computed is kept in build/reference: it does not depend on the core."""

import hashlib
import pickle
from collections.abc import Callable
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from wheelfmu.fmu.paths import ROOT

FOLDER = ROOT / "build" / "reference"


@cache
def sources() -> bytes:
    """All that the reference's results follow from, besides the question."""
    here = Path(__file__).parent
    files = [*sorted((here / "reference").glob("*.py")), here / "scenes.py", here / "schedule.py"]
    versions = "".join(version(name) for name in ("numpy", "scipy"))
    return b"".join(file.read_bytes() for file in files) + versions.encode()


def kept(question: tuple, answer: Callable[[], Any]) -> Any:
    """The answer of the same question under the same sources, or a new one. `question` holds all that it depends on."""
    file = FOLDER / hashlib.sha256(sources() + repr(question).encode()).hexdigest()
    if file.exists():
        return pickle.loads(file.read_bytes())
    found = answer()
    FOLDER.mkdir(parents=True, exist_ok=True)
    written = file.with_suffix(f".{id(found)}")
    written.write_bytes(pickle.dumps(found))
    written.replace(file)  # at once: other processes read it
    return found
