"""An older version of the project beside this one: built in build/report, and measured in the same run, in turns."""

from __future__ import annotations

import subprocess
from pathlib import Path

from support.motion import Library
from support.paths import ROOT
from support.scenes import SCENES

from .native import Master, Task, work_folder
from .page import Report, cached

TURNS = 5
TASKS = {
    **{f"{name}, 100 steps": Task(SCENES[name].start) for name in ("free", "friction", "general inertia", "stiff law")},
    **{f"{name}, steps of 1 ms": Task(SCENES[name].start, 1e-3, 10_000) for name in ("free", "friction")},
    "an instance that is made, runs 0.1 s and is freed": Task({}, 0.1, 1),
}


def built(revision: str) -> Path:
    """revision: anything Git knows. Its wheel.fmu, built once for each commit."""
    git = ["git", "-C", str(ROOT)]
    commit = subprocess.run([*git, "rev-parse", "--short=12", revision], check=True, capture_output=True, text=True)
    folder = work_folder() / f"older_{commit.stdout.strip()}"
    fmu = folder / "build" / "wheel.fmu"
    if not fmu.exists():
        folder.mkdir(exist_ok=True)
        archive = subprocess.run([*git, "archive", revision], check=True, capture_output=True).stdout
        subprocess.run(["tar", "-x", "-C", folder], input=archive, check=True)
        source = cached("WHEEL_SUNDIALS_SOURCE") or cached("WHEEL_SUNDIALS_FETCHED")
        choice = [f"-DWHEEL_SUNDIALS_SOURCE={source}"] if source else []
        setting = ["-DCMAKE_BUILD_TYPE=Release", f"-DPython3_EXECUTABLE={ROOT / '.venv' / 'bin' / 'python'}", *choice]
        subprocess.run(["cmake", "-S", folder, "-B", fmu.parent, *setting], check=True, capture_output=True)
        make = ["cmake", "--build", fmu.parent, "--parallel", "2"]
        subprocess.run(make, check=True, capture_output=True)
    return fmu


def beside_older(report: Report) -> None:
    """beside an older version"""
    revision, rows = report.options["against"], []
    if revision:
        now, then = Master(report.library), Master(Library.unpacked(built(revision)))
        for what, task in TASKS.items():
            turns = [(now.run(task, 0.1).whole, then.run(task, 0.1).whole) for _ in range(TURNS)]
            ours, theirs = (1e6 * min(times) for times in zip(*turns, strict=True))
            rows.append({"run": what, "µs": ours, f"{revision}, µs": theirs, "ratio": ours / theirs})
    report.table("older", rows)
