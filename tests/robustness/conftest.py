"""Tests that name a kind run for each formulation by each method."""

import pytest
from support.driver import Values
from support.scenes import FORCED


@pytest.fixture(params=FORCED, ids=lambda kind: "-".join(map(str, kind.values())))
def kind(request) -> Values:
    return request.param
