"""A test that names one of these runs for each: formulation, law of friction, equal moments of inertia or any."""

import pytest

from wheelfmu.fmu import equations as eq


@pytest.fixture(params=[eq.REDUCED, eq.MULTIBODY], ids=["reduced", "multibody"])
def formulation(request) -> eq.Formulation:
    return request.param


@pytest.fixture(params=eq.LAWS.values(), ids=eq.LAWS.keys())
def law(request) -> int:
    return request.param


@pytest.fixture(params=[True, False], ids=["J_x = J_y", "any J"])
def symmetric(request) -> bool:
    return request.param
