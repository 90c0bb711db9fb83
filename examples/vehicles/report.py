"""What the page of axle and car is written with: a Markdown table and a footer."""

from __future__ import annotations

import platform
import subprocess
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from .build import ROOT

RESULTS = ROOT / "docs" / "results"


def table(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """A Markdown table."""
    head = list(head)
    lines = [head, ["---"] * len(head), *[[str(cell) for cell in row] for row in rows]]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def footer() -> str:
    """Machine and versions."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("FMPy", "numpy", "scipy", "pythonfmu"))
    cpu_info = Path("/proc/cpuinfo")
    models = [line for line in cpu_info.read_text().splitlines() if "model name" in line] if cpu_info.exists() else []
    processor = models[0].split(":", 1)[1].strip() if models else platform.machine()
    compiler = subprocess.run(["cc", "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    return (
        f"\nMeasured on {processor}, {platform.system()}, {compiler}; Python {platform.python_version()}, {packages}."
    )
