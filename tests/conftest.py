"""Shared pieces of the tests: the built FMU, and how a scene is simulated through fmpy."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from reference.tables import read_table
from support.driver import FMU2Wheel
from support.fixtures import description, fmu, fmu_path, simulate
from support.motion import Library


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "contract: quick tests of the C interface, run under sanitizers too")


@pytest.fixture(scope="session")
def library(fmu: str) -> Library:
    """The unpacked FMU as a function from a scene to its motion; instances come and go."""
    return Library(fmu)


@pytest.fixture(scope="session")
def reference_tables() -> dict[str, dict[str, np.ndarray]]:
    """The trusted tables of the paper's two scenes, every 0.1 s."""
    return {scene: read_table(f"paper_{scene}") for scene in ("free", "friction")}


@pytest.fixture
def wheel(fmu: str, description) -> Iterator[Callable[..., FMU2Wheel]]:
    """wheel(...) -> a new instance in the state "instantiated"; freed after the test."""
    made: list[FMU2Wheel] = []

    def make(**options) -> FMU2Wheel:
        made.append(FMU2Wheel(fmu, description, **options))
        return made[-1]

    yield make
    for instance in made:
        if instance.component:
            instance.close()


@pytest.fixture(scope="session")
def reference_events() -> np.ndarray:
    """The instants, s, of the 37 transitions of the paper's friction scene, from the trusted table."""
    return read_table("paper_friction_events")["t"][1:]
