"""The package of ./scripts/study on the import path, the built FMU, and small studies to run."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract

STUDIES = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(STUDIES))

from study import Study  # noqa: E402
from study.runs import Runner  # noqa: E402


@pytest.fixture(scope="session")
def fmu_path() -> Path:
    return Path(os.environ.get("WHEEL_BUILD", STUDIES.parents[1] / "build" / "release")) / "wheel.fmu"


@pytest.fixture(scope="session")
def runner(fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Runner]:
    """One instance in this process, as a worker has it."""
    runner = Runner(extract(str(fmu_path), str(tmp_path_factory.mktemp("fmu"))))
    yield runner
    runner.close()


@pytest.fixture(scope="session")
def fates() -> Study:
    """24 wheels of every fate: impossible ones, some that fall flat, one that lifts off, and those that roll on."""
    return Study(
        grid={
            "theta_start": np.radians([15.0, 75.0, 200.0]),
            "s": [0.0, 0.03],
            "phi_dot_start": [-2, 0.0, -6.0, -40.0],
        },
        measures={"lowest": "min(theta)", "down": "first(theta < 0.5)", "energy": "E"},
        history=["theta", "X_O"],
        stop_time=5.0,
        interval=0.05,
    )
