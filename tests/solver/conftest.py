"""The solver alone, a shared library made in the folder under test; a test that names the method runs for each."""

import ctypes
from functools import partial

import pytest
import solving
from support.paths import build_target


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    folder = build_target("solver_probe")
    return ctypes.CDLL(str(next((folder / "tests" / "solver").glob("*solver_probe.*"))))


@pytest.fixture
def solver(library):
    """solver(method, problem, ...) -> a solver at t = 0."""
    return partial(solving.Solver, library)


@pytest.fixture(params=solving.METHODS)
def method(request):
    return request.param
