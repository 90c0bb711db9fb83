"""Fixtures for every suite, also for those of folders of their own: the built FMU and a run of it by fmpy."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract, read_model_description, simulate_fmu

from support.driver import HEADLINE
from support.paths import build_folder


@pytest.fixture(scope="session")
def fmu_path() -> Path:
    return build_folder() / "wheel.fmu"


@pytest.fixture(scope="session")
def fmu(fmu_path: Path) -> Iterator[str]:
    """The unpacked FMU."""
    folder = extract(str(fmu_path))
    yield folder
    shutil.rmtree(folder)


@pytest.fixture(scope="session")
def description(fmu: str):
    return read_model_description(fmu)


@pytest.fixture(scope="session")
def simulate(fmu: str, description):
    """simulate(step, stop, tolerance, **start values) -> record array of all outputs, by `fmpy.simulate_fmu`."""

    def run(
        step: float = 0.1,
        stop: float = 10.0,
        tolerance: float | None = None,
        output: tuple[str, ...] = HEADLINE,
        **start_values: float,
    ) -> np.ndarray:
        return simulate_fmu(
            fmu,
            model_description=description,
            output_interval=step,
            stop_time=stop,
            relative_tolerance=tolerance,
            start_values=start_values,
            output=output,
        )

    return run
