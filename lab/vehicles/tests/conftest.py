"""The example FMUs, built once per session, and the folders the examples are imported from."""

import sys

import pytest

from lab.vehicles import suspended
from lab.vehicles.vehicle import Fmus, Table, build_all
from wheelfmu.fmu.paths import ROOT


@pytest.fixture(scope="session")
def fmus(tmp_path_factory: pytest.TempPathFactory) -> Fmus:
    """wheel, and the FMUs compiled from C++."""
    return build_all(tmp_path_factory.mktemp("examples"))


@pytest.fixture(scope="session")
def truth(fmus: Fmus) -> Table:
    """The launch of the suspended wheel at a quarter of the smallest step that is compared with it."""
    return suspended.fine(fmus, 0.000625 / 4)
