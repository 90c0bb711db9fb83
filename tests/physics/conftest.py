"""Tests that name the formulation run for both."""

import pytest


@pytest.fixture(params=[2, 3], ids=["reduced", "multibody"])
def formulation(request) -> int:
    return request.param
