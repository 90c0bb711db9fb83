"""The footer of a report: machine, compiler, versions, commit; no names of users or folders."""

from __future__ import annotations

import os
import platform
import re
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def build_folder() -> Path:
    return Path(os.environ.get("WHEEL_BUILD", ROOT / "build" / "release"))


def _output(*command: str) -> str:
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()


def processor() -> str:
    text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    name = re.search(r"^model name\s*:\s*(.+)$", text, re.MULTILINE)
    return name[1] if name else platform.processor() or platform.machine()


def cached(name: str) -> str:
    """An entry of the build's CMakeCache.txt."""
    text = (build_folder() / "CMakeCache.txt").read_text()
    entry = re.search(rf"^{name}:[A-Z]+=(.*)$", text, re.MULTILINE)
    return entry[1] if entry else ""


def compiler() -> str:
    """First line of what the build's C++ compiler says of itself, and the flags of a release."""
    first = _output(cached("CMAKE_CXX_COMPILER"), "--version").splitlines()[:1]
    return f"{first[0] if first else 'unknown'}, {cached('CMAKE_CXX_FLAGS_RELEASE')}"


def commit() -> str:
    """The commit of the measured sources; files made by the reports themselves do not count as a change."""
    if not _output("git", "rev-parse", "HEAD"):
        return "unknown"
    changed = _output("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs/results")
    return _output("git", "rev-parse", "--short=12", "HEAD") + (", with local changes" if changed else "")


def load() -> float:
    """Mean number of running programs in the last minute."""
    return os.getloadavg()[0]


def busy() -> str:
    """A sentence where other programs disturbed the timings."""
    if load() < 0.75 * (os.cpu_count() or 1):
        return ""
    return f"The machine was busy with other work (load {load():.1f}): take the smallest."


def footer(script: str) -> str:
    libraries = ("FMPy", "numpy", "scipy", "matplotlib")
    lines = [
        f"Made by `{script}` on {datetime.now(UTC):%Y-%m-%d}.",
        f"Machine: {processor()}, {os.cpu_count()} processors, load {load():.1f}, {platform.system()}.",
        f"Compiler: {compiler()}. Python {platform.python_version()}, "
        + ", ".join(f"{name} {version(name)}" for name in libraries)
        + ".",
        f"Commit: {commit()}.",
    ]
    return "---\n\n" + "  \n".join(lines)
