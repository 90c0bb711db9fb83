"""Programs that a command starts, and their end with it. Each has a session of its own, so that Ctrl-C reaches the
command alone, which then ends them all."""

import ctypes
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from psutil import Process

PR_SET_CHILD_SUBREAPER = 36
PATIENCE = 5.0  # s, for a program to end by itself
SAFE = {"PYTHONSAFEPATH": "1"}  # the processes of pytest-xdist import nothing from the current folder


class Failed(Exception):
    """A program has ended with this status, and has said why."""

    def __init__(self, status: int) -> None:
        self.status = status


def start(*words: object, **how: Any) -> subprocess.Popen:
    return subprocess.Popen([str(word) for word in words], start_new_session=True, **how)


def ended(program: subprocess.Popen) -> int:
    """The exit status of a program at its end; 128 + n where signal n has ended it."""
    code = program.wait()
    return code if code >= 0 else 128 - code


def status(*words: object, **how: Any) -> int:
    """Runs a program to its end."""
    return ended(start(*words, **how))


def check(*words: object, **how: Any) -> None:
    """The same; Failed where it fails."""
    if code := status(*words, **how):
        raise Failed(code)


def python(module: str, *words: object) -> list[str]:
    """Words that run a module of this interpreter, whatever is in the current folder."""
    return [sys.executable, "-P", "-m", module, *map(str, words)]


def command(name: str, *words: object) -> list[str]:
    """Words that run another command."""
    return python("wheelfmu", name, *words)


def side_by_side(*programs: list[str]) -> None:
    """All run to their end; Failed if one has."""
    if code := max(map(ended, [start(*words) for words in programs])):
        raise Failed(code)


def running() -> list["Process"]:
    """Descendants that run; not Python's tracker of resources, which ignores signals and ends with this process."""
    import psutil

    found = []
    for one in psutil.Process().children(recursive=True):
        with suppress(psutil.Error):
            tracker = one.ppid() == os.getpid() and "multiprocessing.resource_tracker" in " ".join(one.cmdline())
            if one.status() != psutil.STATUS_ZOMBIE and not tracker:
                found.append(one)
    return found


def end_all() -> None:
    """Ends them: by SIGTERM, after some patience by SIGKILL."""
    import psutil

    signal.setitimer(signal.ITIMER_REAL, 0)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM):
        signal.signal(number, signal.SIG_IGN)
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)  # one whose parent ends first stays a descendant
    give_up, signalled = time.monotonic() + PATIENCE, set["Process"]()
    while left := running():
        late = time.monotonic() > give_up
        for one in left:
            with suppress(psutil.NoSuchProcess):
                if late or one not in signalled:
                    one.send_signal(signal.SIGKILL if late else signal.SIGTERM)
        signalled |= {*left}
        time.sleep(0.02)
