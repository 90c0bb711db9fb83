"""Ctrl-C on a terminal ends a command and all that it has started, with status 130 and without a false word; any other
signal n with 128 + n, unless it is ignored. What a killed build leaves spoils none."""

import os
import signal
import subprocess
import sys
import time
from functools import partial
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
    "test quick": ("Built preset release.", 2.0),
    "example car": ("Built preset release.", 0.3, 1.0),
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
    heeded = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # a background job of a script ignores it
    how = {"env": os.environ | {MARK: mark}, "preexec_fn": heeded, "timeout": 600, "encoding": "utf-8"}
    try:
        child = pexpect.spawn(words[0], words[1:], **how)
    except OSError as fault:  # as in a container without /dev/pts
        pytest.skip(f"There is no terminal for the test: {fault}.")
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


# A command that works until the file `go` is there, in the place of ./scripts/help.
WORKS = """
import sys, time
from pathlib import Path
from types import ModuleType
from wheelfmu import __main__

def main(_words):
    print("at work", flush=True)
    while not Path("go").exists():
        time.sleep(0.01)

module = ModuleType("works")
module.reads, module.main, module.STAYS = lambda words: words, main, True
__main__.module_of = lambda name: module
sys.exit(__main__.main("help"))
"""


@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
def test_a_signal_ends_a_command_with_its_status_unless_it_is_ignored_from_the_start(tmp_path: Path, number) -> None:
    """Ignored: SIGHUP by nohup, SIGINT of a script's job in the background. Partner: the same command that heeds it."""
    outcome = {}
    for action in (signal.SIG_IGN, signal.SIG_DFL):
        (tmp_path / "go").unlink(missing_ok=True)
        how = {"cwd": tmp_path, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        how["preexec_fn"] = partial(signal.signal, number, action)
        with subprocess.Popen([sys.executable, "-c", WORKS], **how) as command:
            assert command.stdout and command.stdout.readline() == "at work\n"
            command.send_signal(number)
            if action == signal.SIG_IGN:
                (tmp_path / "go").touch()
            outcome[action] = (command.wait(timeout=600), command.communicate()[1])
    assert outcome[signal.SIG_IGN] == (0, "")
    assert outcome[signal.SIG_DFL] == (128 + number, "\nhelp: interrupted.\n")


@pytest.mark.parametrize("way", ["spawn", "forkserver"])  # the latter is the way of Python 3.14
def test_processes_of_python_end_with_a_command_at_once_and_without_a_word(tmp_path: Path, way: str) -> None:
    program = f"""
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from wheelfmu.commands import processes

if __name__ == "__main__":
    pool = ProcessPoolExecutor(1, mp_context=get_context({way!r}))
    pool.submit(abs, -1).result()
    begin = time.monotonic()
    processes.end_all()
    assert time.monotonic() - begin < processes.PATIENCE / 2 and not processes.running()
"""
    (tmp_path / "program.py").write_text(program)
    done = subprocess.run([sys.executable, tmp_path / "program.py"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_what_a_killed_build_has_begun_is_made_again(tmp_path: Path) -> None:
    rule = """
cmake_minimum_required(VERSION 3.25)
project(parts NONE)
foreach(part 1 2)
  add_custom_command(OUTPUT ${part} COMMAND sh ${CMAKE_SOURCE_DIR}/make.sh ${part})
endforeach()
add_custom_command(OUTPUT 2 DEPENDS 1 APPEND)
add_custom_target(all_parts ALL DEPENDS 2)
"""
    (tmp_path / "CMakeLists.txt").write_text(rule)
    (tmp_path / "make.sh").write_text("printf 'a pa' >$1; [ $1 = 1 ] || [ -e ../repaired ] || kill -9 0; echo rt >>$1")
    program = "from pathlib import Path; from wheelfmu.fmu.building import build\n"
    program += f"build('parts', Path({str(tmp_path / 'built')!r}), Path({str(tmp_path)!r}), [])"
    command, built = [sys.executable, "-c", program], tmp_path / "built"
    assert subprocess.run(command, start_new_session=True, check=False).returncode == -signal.SIGKILL
    assert [(built / part).read_text() for part in "12"] == ["a part\n", "a pa"]
    (tmp_path / "repaired").touch()
    subprocess.run(command, check=True)
    assert [(built / part).read_text() for part in "12"] == ["a part\n", "a part\n"]
