"""A coast-down of known rolling resistance on the FMU."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pandas as pd
import pytest
from support.bounds import beyond, within
from support.motion import Library

from reports import validation
from reports.validation import LOAD

C, R = 2.5e-3, 0.24  # R in m
MASSES = np.array([17.8, 0.41])  # kg, of drum and wheel at their rims


class Coast(NamedTuple):
    """A rim that slows down by a + b v^2, from 25 m/s on; SI."""

    a: float
    b: float

    def to_rest(self, v: np.ndarray | float) -> np.ndarray:
        """Seconds from v on."""
        return np.arctan(v * np.sqrt(self.b / self.a)) / np.sqrt(self.a * self.b)

    def speed(self, to_rest: np.ndarray) -> np.ndarray:
        return np.sqrt(self.a / self.b) * np.tan(np.sqrt(self.a * self.b) * to_rest)


ALONE = Coast(0.01, 2e-4), Coast(0.03, 2e-3)  # drum, wheel
DRAG = MASSES @ ALONE  # without contact: N, N / (m/s)^2
TOGETHER = Coast(*(DRAG + [C * LOAD, 0]) / MASSES.sum())


def test_a_coast_down_of_the_fmu_is_that_of_drum_and_wheel(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    speeds = np.arange(3.0, 22.0, 3.0)
    run = pd.DataFrame({"speed": speeds, "drag": DRAG @ [speeds**0, speeds**2]}).assign(R=R, M=MASSES.sum())

    def apart() -> float:
        t, v = validation.coast(library, run, C)
        return np.abs(TOGETHER.speed(TOGETHER.to_rest(v[0]) - t) - v).max()

    within(apart(), 0.01, "speed")  # m/s; the drag is held over steps of 0.1 s
    monkeypatch.setattr(validation, "LOAD", 0.95 * LOAD)
    beyond(apart(), 0.1, "speed at 95 % of the load")
