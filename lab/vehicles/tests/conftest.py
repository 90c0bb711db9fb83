"""The example FMUs, built once per session."""

from pathlib import Path

import pytest

from lab.vehicles.car import Fmus, fmus_in


@pytest.fixture(scope="session")
def fmus(vehicles: Path) -> Fmus:
    """wheel, and the FMUs compiled from C++."""
    return fmus_in(vehicles)
