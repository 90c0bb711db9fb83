"""Programs that a command starts, and their end with it. Each has a session of its own, so that Ctrl-C reaches the
command alone, which then ends them all."""

import ctypes
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

PR_SET_CHILD_SUBREAPER = 36
PATIENCE = 5.0  # s, for a program to end by itself
ROUND = 0.2  # s, between two looks for adopted processes that have ended
SAFE = {"PYTHONSAFEPATH": "1"}  # the processes of pytest-xdist import nothing from the current folder
STARTED: set[int] = set()
starting = threading.Lock()


class Failed(Exception):
    """A program has ended with this status, and has said why."""

    def __init__(self, status: int) -> None:
        self.status = status


def adopt() -> None:
    """Processes whose parent has gone become this one's children; once they have ended, they vanish."""
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    threading.Thread(target=bury, daemon=True).start()


def table() -> Iterator[tuple[int, str, int, int]]:
    """Of each process its number, state, parent and session."""
    for entry in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):  # it has ended
            state, parent, _, session = entry.read_text(errors="replace").rpartition(")")[2].split()[:4]
            yield int(entry.parent.name), state, int(parent), int(session)


def any_ended() -> bool:
    """Whether a child is to be reaped: by one system call, where the table reads a file of every process."""
    with suppress(ChildProcessError):  # there is no child
        return os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT) is not None
    return False


def bury() -> None:
    """Reaps adopted processes: those of other sessions that were not started here."""
    me, own = os.getpid(), os.getsid(0)
    while True:
        time.sleep(ROUND)
        for pid, state, parent, session in table() if any_ended() else ():
            with suppress(ChildProcessError), starting:
                if (state, parent) == ("Z", me) and session != own and pid not in STARTED:
                    os.waitpid(pid, os.WNOHANG)


def start(*words: object, **how: Any) -> subprocess.Popen:
    with starting:
        one = subprocess.Popen([str(word) for word in words], start_new_session=True, **how)
        STARTED.add(one.pid)
    return one


def status(*words: object, **how: Any) -> int:
    """Runs a program to its end."""
    return start(*words, **how).wait()


def check(*words: object, **how: Any) -> None:
    """The same; Failed where it fails."""
    if code := status(*words, **how):
        raise Failed(code if code > 0 else 128 - code)


def python(module: str, *words: object) -> list[str]:
    """Words that run a module of this interpreter, whatever is in the current folder."""
    return [sys.executable, "-P", "-m", module, *map(str, words)]


def command(name: str, *words: object) -> list[str]:
    """Words that run another command."""
    return python("wheelfmu", name, *words)


def side_by_side(*programs: list[str], **how: Any) -> None:
    """All run to their end; Failed if one has."""
    codes = [one.wait() for one in [start(*words, **how) for words in programs]]
    if any(codes):
        raise Failed(1)


def descendants() -> list[int]:
    """Processes that descend from this one and run."""
    parents = {pid: parent for pid, state, parent, _ in table() if state != "Z"}
    found = [os.getpid()]
    for one in found:
        found += [pid for pid, parent in parents.items() if parent == one]
    return found[1:]


def end_all() -> None:
    """Ends them: by SIGTERM, after some patience by SIGKILL."""
    signal.setitimer(signal.ITIMER_REAL, 0)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM):
        signal.signal(number, signal.SIG_IGN)
    begin, signalled = time.monotonic(), set()
    while left := descendants():
        killed = time.monotonic() - begin > PATIENCE
        for pid in left:
            with suppress(ProcessLookupError):
                if killed or pid not in signalled:
                    os.kill(pid, signal.SIGKILL if killed else signal.SIGTERM)
        signalled |= {*left}
        with suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        time.sleep(0.02)
