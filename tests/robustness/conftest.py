"""Tests that name a kind run for each formulation by each method; `played` plays inputs to a new instance."""

from collections.abc import Callable

import pytest
from support.playing import Piece, play

from wheelfmu.fmu.driver import OK, FMU2Wheel, Value, Values
from wheelfmu.truth.scenes import FORCED


@pytest.fixture(params=FORCED, ids=lambda kind: "-".join(map(str, kind.values())))
def kind(request) -> Values:
    return request.param


@pytest.fixture
def played(wheel) -> Callable[..., list[float]]:
    """played(inputs, stop, cuts, names, **start): values at `stop`, reached through all pieces and cuts."""

    def run(inputs: list[Piece], stop: float, cuts=(), names=("theta",), **start: Value) -> list[float]:
        w: FMU2Wheel = wheel().start(**start)
        assert play(w, inputs, stop, cuts) == OK, w.sentences
        found = w.get(*names)
        w.close()
        return found

    return run
