"""Where the project and its build are."""

import fcntl
import os
import shutil
import subprocess
from ctypes import CDLL
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
CMAKE = ("cmake", "-G", "Unix Makefiles")  # whatever the variable CMAKE_GENERATOR is


def build_folder() -> Path:
    """The build under test: WHEEL_BUILD, or that of the preset release."""
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release"))


def without_stale_cache(folder: Path, source: Path, *lines: str) -> None:
    """A build folder; empty where the cache, which holds absolute paths, has another checkout, generator or line."""
    cache = folder / "CMakeCache.txt"
    wanted = (f"CMAKE_HOME_DIRECTORY:INTERNAL={source}\n", f"CMAKE_GENERATOR:INTERNAL={CMAKE[-1]}\n", *lines)
    if cache.exists() and not all(line in cache.read_text(encoding="utf-8", errors="replace") for line in wanted):
        shutil.rmtree(folder)
    folder.mkdir(parents=True, exist_ok=True)


def probe(folder: str) -> CDLL:
    """The shared library of tests/`folder`, made in the build under test."""
    built = build_target(f"{folder}_probe") / "tests" / folder
    return CDLL(str(next(built.glob(f"*{folder}_probe.*"))))


def build_target(name: str) -> Path:
    """Builds one of the programs for tests; test processes wait for each other. Returns the build folder."""
    folder = build_folder()
    with (folder / "test_targets.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        subprocess.run(["cmake", "--build", folder, "--target", name], check=True, capture_output=True)
    return folder


def copy_checkout(place: Path) -> None:
    """The files of the project, without anything that is built or installed."""
    copy = 'git ls-files -coz --exclude-standard | xargs -0 cp --parents -t "$0"'
    subprocess.run(["bash", "-c", copy, place], cwd=ROOT, check=False)  # a file may be deleted
