"""The example FMUs, built once per session, and the folders the examples are imported from."""

import sys
from pathlib import Path

import numpy as np
import pytest
from support.paths import ROOT

sys.path.insert(0, str(ROOT / "examples" / "vehicles"))

from vehicles import build, suspended  # noqa: E402


@pytest.fixture(scope="session")
def fmus() -> dict[str, Path]:
    """wheel, the FMUs compiled from C++, and balance (made by pythonfmu)."""
    return build.build_all()


@pytest.fixture(scope="session")
def truth() -> dict[str, np.ndarray]:
    """Wheel and quarter car as one set of equations."""
    return suspended.together()
