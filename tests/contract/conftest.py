"""Fixtures of the contract tests: instances that are freed whatever happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from reference.tables import read_table
from support.driver import FMU2Wheel


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
