"""Builds with CMake and makefiles, whatever the variable CMAKE_GENERATOR names; one process at a time in a folder.

The imports at the head are of the standard library alone.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from ctypes import CDLL
from pathlib import Path
from subprocess import PIPE, STDOUT
from typing import Any, TextIO

from .files import alone, named
from .paths import build_folder

CMAKE = ("cmake", "-G", "Unix Makefiles")
BAR = "{desc}: {percentage:3.0f} % |{bar:20}|"
SHOWN = 60  # lines of the log of a build that failed


def without_stale_cache(folder: Path, source: Path, line: str) -> None:
    """A build folder; empty where the cache, which holds absolute paths, has another checkout, generator or line."""
    cache = folder / "CMakeCache.txt"
    wanted = (f"CMAKE_HOME_DIRECTORY:INTERNAL={source}\n", f"CMAKE_GENERATOR:INTERNAL={CMAKE[-1]}\n", line)
    if cache.exists() and not all(line in cache.read_text(encoding="utf-8", errors="replace") for line in wanted):
        shutil.rmtree(folder)
    folder.mkdir(parents=True, exist_ok=True)


@contextmanager
def whole(folder: Path) -> Iterator[None]:
    """A folder while it is written to. Files of a process that was killed meanwhile are removed first: one may be cut
    short and still be newer than its sources."""
    mark = folder / "unfinished"
    if mark.exists():
        begin = mark.stat().st_mtime_ns
        for path in [path for path in folder.rglob("*") if path.is_file() and path != mark]:
            if path.stat().st_mtime_ns >= begin:
                path.unlink()
    mark.touch()
    yield
    mark.unlink()


def build(
    name: str, folder: Path, source: Path, configure: Iterable[object], building: Iterable[object] = (), stale: str = ""
) -> None:
    """Configures and builds a folder; SystemExit with the end of FOLDER.log where that fails.

    building: options of cmake --build, the folder by default; stale: a line that a cache must have to be kept."""
    log = folder.with_name(f"{folder.name}.log")
    to_configure = [*CMAKE, "-S", source, "-B", folder, *configure]
    to_build = ["cmake", "--build", *(building or [folder]), "--parallel", os.cpu_count()]
    if not sys.stderr.isatty():  # without a progress bar
        print(f"Building {name}.", flush=True)
    with alone(folder), named(log):
        without_stale_cache(folder, source, stale)
        with whole(folder), log.open("w", encoding="utf-8") as file:
            done = all(succeeds(name, [str(word) for word in step], source, file) for step in (to_configure, to_build))
    if not done:
        print(*log.read_text(encoding="utf-8").splitlines()[-SHOWN:], sep="\n", file=sys.stderr)
        raise SystemExit(f"The build of {name} failed; the whole log is {log}.")


def succeeds(name: str, words: list[str], place: Path, log: TextIO) -> bool:
    """Runs CMake, with a progress bar on a terminal."""
    from .progress import bar

    how: dict[str, Any] = {"cwd": place, "stdout": PIPE, "stderr": STDOUT, "text": True, "errors": "replace"}
    with (
        subprocess.Popen(words, **how) as cmake,
        bar(total=100, desc=f"Building {name}", bar_format=BAR, leave=False) as done,
    ):
        for line in cmake.stdout or ():
            log.write(line)
            if found := re.match(r"\[ *(\d+)%\] Building", line):
                done.update(int(found[1]) - done.n)
    return not cmake.returncode


def build_target(name: str) -> Path:
    """Builds one of the programs for tests in the build under test, whose folder is returned."""
    folder = build_folder()
    with alone(folder), whole(folder):
        done = subprocess.run(["cmake", "--build", folder, "--target", name], check=False, capture_output=True)
    done.check_returncode()
    return folder


def probe(folder: str) -> CDLL:
    """The shared library of tests/`folder`, made in the build under test."""
    built = build_target(f"{folder}_probe") / "tests" / folder
    return CDLL(str(next(built.glob(f"*{folder}_probe.*"))))
