"""An older version of the project, built in build/report, to be measured in the same run as this one."""

from __future__ import annotations

import subprocess
from pathlib import Path

from support.paths import ROOT

from .native import work_folder
from .page import cached


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
