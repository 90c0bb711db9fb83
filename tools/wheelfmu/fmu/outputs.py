"""Files that a command writes: none that it reads or that others wrote, whole or not at all, one process at a time.

Standard library alone.
"""

import os
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

from wheelfmu.fmu.values import Fault

BEGIN = time.monotonic()


def check(
    outputs: Iterable[Path], inputs: Iterable[Path], ours: Callable[[Path], bool], *, overwrite: bool = False
) -> None:
    """Fault if an output is an input, or a folder that holds one, or a file that is there and is not `ours`."""
    read = [path.resolve() for path in inputs]
    for path in outputs:
        place = path.resolve()
        if hit := [source for source in read if place == source or place in source.parents]:
            raise Fault(f"{path} cannot be written: {hit[0]} is read. Choose another place for the results.")
        if place.is_file() and not overwrite and not ours(place):
            raise Fault(f"{path} is there and is not of this command: choose another place, or give --overwrite.")


@contextmanager
def fresh(path: Path) -> Iterator[Path]:
    """A path to write to, beside `path`; what is written moves into its place if no error is raised."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        yield new
        new.replace(path)
    finally:
        new.unlink(missing_ok=True)


@contextmanager
def alone(place: Path) -> Iterator[None]:
    """One process of this machine at a time uses a place; the others wait."""
    import fcntl

    name = sha256(str(place.resolve()).encode()).hexdigest()[:16]
    with (Path(tempfile.gettempdir()) / f"wheel-{os.getuid()}-{name}.lock").open("w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print(f"Waiting for another process that writes to {place}.", file=sys.stderr)
            fcntl.flock(file, fcntl.LOCK_EX)
        yield


@contextmanager
def new_folder(place: Path) -> Iterator[Path]:
    """A folder that is empty at first and gone at the end, in a place that no other process uses; any left by a process
    that was killed goes, too."""
    with alone(place):
        for left in place.glob(".new-*"):
            shutil.rmtree(left)
        with tempfile.TemporaryDirectory(dir=place, prefix=".new-") as new:
            yield Path(new)


def elapsed() -> float:
    """Seconds since this process began."""
    return time.monotonic() - BEGIN


def step(text: str) -> None:
    """A line above what a long command does next, with the seconds since it began."""
    print(f"\n== {text} ({elapsed():.0f} s)", flush=True)


def deliver(source: Path, target: Path) -> None:
    """A copy in its place at once: a process that has the old file open keeps it."""
    with fresh(target) as new:
        shutil.copy(source, new)
