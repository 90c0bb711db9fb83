"""The unfolded free wheel alone: a shared library made in the folder under test."""

import ctypes

import pytest
from support.paths import build_target


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    folder = build_target("orbit_probe")
    return ctypes.CDLL(str(next((folder / "tests" / "orbit").glob("*orbit_probe.*"))))
