"""Files that a command writes: none that it reads or that others wrote, whole or not at all, one process at a time.

Standard library alone.
"""

import errno
import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from secrets import token_hex

from wheelfmu.fmu.values import Fault

BEGIN = time.monotonic()
# Of a disk or a place, not of a program: full, out of order, another user's, something else.
OF_PLACES = (
    "EACCES",
    "EPERM",
    "EROFS",
    "ENOSPC",
    "EDQUOT",
    "EFBIG",
    "EIO",
    "EEXIST",
    "EISDIR",
    "ENOTDIR",
    "ENAMETOOLONG",
)


@contextmanager
def worded(name: str, status: int = 2) -> Iterator[None]:
    """A Fault, or an error of a disk or a place, ends the program `name` with one sentence, the end of its reader with
    none."""
    try:
        try:
            yield
        finally:
            sys.stdout.flush()
    except Fault as fault:
        print(f"{name}: {fault}", file=sys.stderr)
        sys.exit(status)
    except OSError as fault:
        kind = errno.errorcode.get(fault.errno or 0)
        if kind in OF_PLACES:
            print(f"{name}: {fault.filename or 'the output'}: {fault.strerror}.", file=sys.stderr)
        elif kind != "EPIPE":
            raise
        if kind == "EPIPE" or not fault.filename:  # what is not printed yet is not tried again
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(status if kind != "EPIPE" else 128 + signal.SIGPIPE)


@contextmanager
def named(path: Path) -> Iterator[None]:
    """An error of a disk that is full, which has no name, gets that of the file."""
    try:
        yield
    except OSError as fault:
        fault.filename = fault.filename or str(path)
        raise


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
    if path.is_dir():
        raise Fault(f"{path} is a folder, and a file is to be written there: rename or delete the folder.")
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_name(f".{token_hex(4)}.{path.name}")  # of no other process, in another container either
    try:
        with named(path):
            yield new
            new.replace(path)
    finally:
        new.unlink(missing_ok=True)


@contextmanager
def alone(place: Path) -> Iterator[None]:
    """One process at a time uses a place; the others wait. The lock is beside it, the same for all users."""
    from filelock import FileLock, Timeout

    place = place.resolve()
    place.parent.mkdir(parents=True, exist_ok=True)
    lock = FileLock(place.with_name(f".{place.name}.lock"), mode=0o666)
    try:
        lock.acquire(blocking=False)
    except Timeout:
        print(f"Waiting for another process that writes to {place}.", file=sys.stderr)
        lock.acquire()
    try:
        yield
    finally:
        lock.release()


@contextmanager
def new_folder(place: Path) -> Iterator[Path]:
    """A folder that is empty at first and gone at the end, in a place that no other process uses; any left by a process
    that was killed goes, too."""
    with alone(place):
        for left in place.glob(".new-*"):
            shutil.rmtree(left)
        with named(place), tempfile.TemporaryDirectory(dir=place, prefix=".new-") as new:
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
