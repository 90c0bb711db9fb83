"""The evaluation of published measurements: coast-downs of known rolling resistance, and the mapping onto the FMU."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import pytest
from support.bounds import beyond, within
from support.motion import Library

from reports import coast_down, validation
from reports.coast_down import DRUM_LENGTH, DRUM_MASS, LOAD, SHARE, WHEELS

TYRE, C, R = "Michelin 44-406", 2.5e-3, 0.24  # R in m
MASSES = np.array([DRUM_MASS, SHARE * WHEELS[TYRE]])


class Coast(NamedTuple):
    """A rim that slows down by a + b v^2, from 25 m/s on; SI."""

    a: float
    b: float

    def to_rest(self, v: np.ndarray | float) -> np.ndarray:
        """Seconds from v on."""
        return np.arctan(v * np.sqrt(self.b / self.a)) / np.sqrt(self.a * self.b)

    def speed(self, to_rest: np.ndarray) -> np.ndarray:
        return np.sqrt(self.a / self.b) * np.tan(np.sqrt(self.a * self.b) * to_rest)

    def revolutions(self, length: float) -> np.ndarray:
        """Instants at which the rim has turned once more, down to 1 m/s: v^2 + a / b falls like exp(-2 b x)."""
        squares = (25**2 + self.a / self.b) * np.exp(-2 * self.b * length * np.arange(1, 5000)) - self.a / self.b
        return self.to_rest(25) - self.to_rest(np.sqrt(squares[squares > 1]))


ALONE = Coast(0.01, 2e-4), Coast(0.03, 2e-3)  # drum, wheel
DRAG = MASSES @ ALONE  # without contact: N, N / (m/s)^2
TOGETHER = Coast(*(DRAG + [C * LOAD, 0]) / MASSES.sum())


def write(path: Path, drum: np.ndarray, wheel: np.ndarray) -> None:
    """A file of the rig: a row per trigger with the counts before it; the drum has a false one after each 40th."""
    counted = np.sort(np.concatenate([drum, drum[::40] + 0.03])), wheel
    times = np.sort(np.concatenate([*counted, [drum[-1] + 100]]))
    columns = np.zeros((len(times), 5))
    columns[:, 0], columns[:, 2:5:2] = 1e6 * times, np.transpose([np.searchsorted(of, times) for of in counted])
    np.savetxt(path, columns, "%.0f", ",")


def evaluate(folder: Path, later: float = 0.0) -> tuple[pd.DataFrame, pd.DataFrame]:
    """What is found in a pair of runs, and in the same pair under another name, so many seconds later."""
    for kind, (drum, wheel) in (("Contact", (TOGETHER, TOGETHER)), ("Separate", ALONE)):
        runs = drum.revolutions(DRUM_LENGTH), wheel.revolutions(2 * np.pi * R)
        for direction, shift in (("Left", 0.0), ("Right", later)):
            write(folder / f"{TYRE} - {kind} - {direction} - 60 psi.csv", *(shift + run for run in runs))
    return coast_down.evaluate(*coast_down.read(folder))


def test_a_known_rolling_resistance_is_found_in_coast_downs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = evaluate(tmp_path)
    assert list(found["speed"]) == list(coast_down.SPEEDS)
    within(np.abs(found["C"] / C - 1).max(), 5e-3, "C")
    within(abs(found["R"].iloc[0] / R - 1), 1e-3, "rolling radius")
    monkeypatch.setattr(coast_down, "SHARE", 0.0)
    without_wheel, _ = evaluate(tmp_path)
    beyond(np.abs(without_wheel["C"] / C - 1).max(), 0.05, "C where the wheel has no inertia")


def test_one_run_under_two_names_counts_once(tmp_path: Path) -> None:
    found, left_out = evaluate(tmp_path)
    assert set(found["direction"]) == {"Left"}
    assert list(left_out["reason"]) == [f"a copy of {TYRE}, 60 psi, left"]
    found, left_out = evaluate(tmp_path, 1.000003)
    assert set(found["direction"]) == {"Left", "Right"}
    assert left_out.empty


def test_a_coast_down_of_the_fmu_is_that_of_drum_and_wheel(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    speeds = np.array(coast_down.SPEEDS)
    run = pd.DataFrame({"speed": speeds, "drag": DRAG @ [speeds**0, speeds**2]}).assign(R=R, M=MASSES.sum())

    def apart() -> float:
        t, v = validation.coast(library, run, C)
        return np.abs(TOGETHER.speed(TOGETHER.to_rest(v[0]) - t) - v).max()

    within(apart(), 0.01, "speed")  # m/s; the drag is held over steps of 0.1 s
    monkeypatch.setattr(validation, "LOAD", 0.95 * LOAD)
    beyond(apart(), 0.1, "speed at 95 % of the load")


def test_a_thin_disk_on_its_steady_circle_keeps_inclination_and_energy(
    library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    inclination, rate = np.radians(10), validation.turn_rate
    off, loss = validation.held_disk(library, inclination, 5.0, s=1e-5)
    within(off, 1e-8, "inclination")
    within(loss, 1e-9, "energy")
    monkeypatch.setattr(validation, "turn_rate", lambda at: 1.01 * rate(at))
    off, _ = validation.held_disk(library, inclination, 5.0)
    beyond(off, 1e-3, "inclination at 101 % of the precession")
