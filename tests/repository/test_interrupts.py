"""Ctrl-C on a terminal ends a command and all that it has started, with status 130 and without a false word."""

import os
import time
from io import StringIO
from pathlib import Path

import pexpect
import psutil
import pytest

from wheelfmu.fmu.paths import ROOT

MARK = "WHEEL_TEST_OF_INTERRUPTS"
COMMANDS = {
    "run": ("Built preset release.", 0.05, 0.4, 1.5, 3.0),
    "study fates --overwrite --out {place}/z": ("", 3.0),
    "page {place}/page.html": ("", 1.5),
    "test quick": ("the release build", 2.0),
    "example car": ("Built preset release.", 0.5, 4.0),
}
CASES = [(line, words, delay) for line, (words, *delays) in COMMANDS.items() for delay in delays]


def marked(mark: str) -> list[psutil.Process]:
    """Processes that have the mark in their environment."""
    found = psutil.process_iter(["environ", "status"])  # none of the environment of those that are not ours
    own = [one for one in found if (one.info["environ"] or {}).get(MARK) == mark]
    return [one for one in own if one.info["status"] != psutil.STATUS_ZOMBIE]


def at_terminal(words: list[str], until: str, delay: float, mark: str) -> tuple[int | None, str, float]:
    """Runs a command on a terminal; `delay` after it prints `until`, or starts its own program, comes Ctrl-C.

    Its exit status, what it printed, and how long it took to end."""
    printed = StringIO()
    child = pexpect.spawn(words[0], words[1:], env=os.environ | {MARK: mark}, timeout=600, encoding="utf-8")
    child.logfile_read = printed
    if until:
        child.expect_exact(until)
    else:
        while "wheelfmu" not in psutil.Process(child.pid).cmdline():  # set-up gives its place to the command
            time.sleep(0.05)
    child.expect([pexpect.EOF, pexpect.TIMEOUT], timeout=delay)
    child.sendintr()
    begin = time.monotonic()
    child.expect(pexpect.EOF)
    child.wait()
    return child.exitstatus, printed.getvalue(), time.monotonic() - begin


def unfinished() -> set[str]:
    """Folders of results that are being written."""
    return {path.name for path in (ROOT / "results").rglob(".new-*")}


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
