"""The solver alone, a shared library made in the folder under test; a test that names the method runs for each."""

import ctypes
from functools import partial

import pytest

from wheelfmu.fmu.building import probe

from . import solving


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    return probe("solver")


@pytest.fixture
def solver(library):
    """solver(method, problem, ...) -> a solver at t = 0."""
    return partial(solving.Solver, library)


@pytest.fixture(params=solving.METHODS)
def method(request):
    return request.param
