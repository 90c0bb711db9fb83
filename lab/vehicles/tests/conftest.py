"""The example FMUs, built once per session."""

import pytest

from lab.vehicles.car import Fmus, build_all


@pytest.fixture(scope="session")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> Fmus:
    """wheel, and the FMUs compiled from C++."""
    return build_all(tmp_path_factory.mktemp("examples"))
