"""What the independent reference has computed is kept in the user's cache: it does not depend on the core.

One folder for each state of the reference's sources; the newest few stay.
"""

import hashlib
import os
import pickle
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from shutil import rmtree
from typing import Any

from wheelfmu.fmu.files import fresh

FOLDERS = 4


@cache
def folder() -> Path:
    """Of all that the reference's results follow from, besides the question."""
    here, usual = Path(__file__).parent, os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    files = [*sorted((here / "reference").glob("*.py")), here / "scenes.py", here / "schedule.py"]
    packages = repr([version(name) for name in ("numpy", "scipy")])
    sources = b"".join(file.read_bytes() for file in files) + packages.encode()
    found = Path(usual) / "wheel.fmu" / "reference" / hashlib.sha256(sources).hexdigest()[:16]
    with suppress(FileExistsError):  # the one process that makes it removes the oldest
        found.mkdir(parents=True)
        for old in sorted(found.parent.iterdir(), key=os.path.getmtime)[:-FOLDERS]:
            rmtree(old, ignore_errors=True)
    return found


def kept(question: tuple, answer: Callable[[], Any]) -> Any:
    """The answer of the same question under the same sources, or a new one. `question` holds all that it depends on."""
    file = folder() / hashlib.sha256(repr(question).encode()).hexdigest()[:32]
    if file.exists():
        return pickle.loads(file.read_bytes())
    found = answer()
    with fresh(file) as new:  # in a folder that another checkout may have removed meanwhile
        new.write_bytes(pickle.dumps(found))
    return found
