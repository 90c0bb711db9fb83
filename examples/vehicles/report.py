"""What the page of axle and car is written with: a Markdown table, and what it was made with."""

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


def made() -> dict[str, str]:
    """Machine and versions."""
    cpu_info = Path("/proc/cpuinfo")
    models = [line for line in cpu_info.read_text().splitlines() if "model name" in line] if cpu_info.exists() else []
    return {
        "measured on": models[0].split(":", 1)[1].strip() if models else platform.machine(),
        "compiler": subprocess.run(["cc", "--version"], capture_output=True, text=True).stdout.split("\n")[0],
        "Python": platform.python_version(),
        **{name: version(name) for name in ("FMPy", "numpy", "scipy")},
    }
