"""The unfolded free wheel alone: a shared library made in the folder under test."""

import ctypes

import pytest
from support.paths import probe


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    return probe("orbit")
