"""Ctrl-C on a terminal ends a command and all that it has started, with status 130 and without a false word."""

import os
import pty
import select
import time
from pathlib import Path

import pytest

from wheelfmu.fmu.paths import ROOT

MARK = "WHEEL_TEST_OF_INTERRUPTS"
COMMANDS = {
    "run": ("Built preset release.", 0.0, 0.4, 1.5, 3.0),
    "study fates --overwrite --out {place}/z": ("", 3.0),
    "page {place}/page.html": ("", 1.5),
    "test quick": ("the release build", 2.0),
    "example car": ("Built preset release.", 0.5, 4.0),
}
CASES = [(line, words, delay) for line, (words, *delays) in COMMANDS.items() for delay in delays]


def marked(mark: str) -> list[int]:
    """Processes that have the mark in their environment."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/environ"):
        try:
            if f"{MARK}={mark}".encode() in entry.read_bytes() and "Z" not in stat_of(entry.parent):
                found.append(int(entry.parent.name))
        except OSError:  # it has ended, or is not ours
            continue
    return found


def stat_of(process: Path) -> str:
    return (process / "stat").read_text(errors="replace").rpartition(")")[2].split()[0]


def at_terminal(words: list[str], until: str, delay: float, mark: str) -> tuple[int, str, float]:
    """Runs a command on a terminal; `delay` after it prints `until`, or starts its own program, comes Ctrl-C.

    Its exit status, what it printed, and how long it took to end."""
    pid, terminal = pty.fork()
    if not pid:
        os.environ[MARK] = mark
        os.execv(words[0], words)
    printed, due, give_up = "", None, time.monotonic() + 600
    while time.monotonic() < give_up:
        ready, _, _ = select.select([terminal], [], [], 0.05)
        try:
            printed += os.read(terminal, 65536).decode(errors="replace") if ready else ""
        except OSError:  # the other end is closed
            break
        if due is None and (until in printed if until else running(pid)):
            due = time.monotonic() + delay
        if due and time.monotonic() > due:
            os.write(terminal, b"\x03")
            begin, due = time.monotonic(), float("inf")
    _, status = os.waitpid(pid, 0)
    os.close(terminal)
    return os.waitstatus_to_exitcode(status), printed, time.monotonic() - begin


def running(pid: int) -> bool:
    """Whether set-up has given its place to the command."""
    return b"-m\0wheelfmu" in (Path("/proc") / str(pid) / "cmdline").read_bytes()


def unfinished() -> set[str]:
    """Folders of results that are being written."""
    return {path.name for path in (ROOT / "results").glob(".new-*")}


@pytest.mark.parametrize(("line", "until", "delay"), CASES)
def test_a_command_ends_whole_at_ctrl_c(tmp_path: Path, line: str, until: str, delay: float) -> None:
    before = unfinished()
    words = ["/bin/bash", str(ROOT / "scripts" / line.split()[0]), *line.format(place=tmp_path).split()[1:]]
    status, printed, seconds = at_terminal(words, until, delay, str(tmp_path))
    assert (status, marked(str(tmp_path))) == (130, []), printed
    assert seconds < 30, printed
    assert not [said for said in ("Traceback", "could not", "is ready", "passed") if said in printed], printed
    left, give_up = unfinished() - before, time.monotonic() + 300
    while left and time.monotonic() < give_up:  # those of other tests' runs go
        time.sleep(0.2)
        left &= unfinished()
    assert not left
