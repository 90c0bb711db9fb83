"""The evaluation of published measurements: coast-downs of known rolling resistance, and the mapping onto the FMU."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from support.bounds import beyond, within
from support.motion import Library
from support.paths import ROOT

from publishing.documents import read_figures
from reports import coast_down, validation
from reports.coast_down import DRUM_LENGTH, DRUM_MASS, LOAD, SHARE, WHEELS

TYRE, C, R = "Michelin 44-406", 2.5e-3, 0.24  # R in m
WHEEL_MASS = SHARE * WHEELS[TYRE]
SRMD = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref" / "credibility.srmd"
STATED = {"spread": "%", "spread_median": "%", "coast": "%", "coast_speed": "m/s", "again": "%"}
STATED |= {"load_most": "N", "load_exponent": ""}


def drum_alone(v: float) -> float:
    return 0.01 + 2e-4 * v**2


def wheel_alone(v: float) -> float:
    return 0.03 + 2e-3 * v**2


def in_contact(v: float) -> float:
    drag = DRUM_MASS * drum_alone(v) + WHEEL_MASS * wheel_alone(v)
    return (C * LOAD + drag) / (DRUM_MASS + WHEEL_MASS)


def revolutions(slows, length: float) -> np.ndarray:
    """Instants in s at which a rim that starts at 25 m/s and slows down has turned once more, down to 1 m/s."""
    stop = lambda _t, y: y[1] - 1.0  # noqa: E731
    stop.terminal = True
    run = solve_ivp(lambda _t, y: (y[1], -slows(y[1])), (0, 5000), (0, 25), "DOP853", None, True, stop, rtol=1e-10)
    turns = np.arange(length, run.y[0, -1], length)
    grid = np.interp(turns, run.y[0], run.t)
    near = [(max(t - 60, 0.0), min(t + 60, run.t[-1])) for t in grid]
    return np.array([brentq(lambda t, x=x: run.sol(t)[0] - x, *ends) for x, ends in zip(turns, near, strict=True)])


def write(path: Path, drum: np.ndarray, wheel: np.ndarray) -> None:
    """A file of the rig: a row per trigger with the counts before it; the drum has a false one after each 40th."""
    drum = np.sort(np.concatenate([drum, drum[::40] + 0.03]))
    events = sorted([(t, 0) for t in drum] + [(t, 1) for t in wheel])
    counts, rows = [0, 0], []
    for t, which in [*events, (events[-1][0] + 1, 0)]:
        rows.append(f"{round(1e6 * t)},0,{counts[0]},0,{counts[1]}")
        counts[which] += 1
    path.write_text("\n".join(rows))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Left: a pair of runs; right: the same pair under another name."""
    folder, length = tmp_path_factory.mktemp("rig"), 2 * np.pi * R
    both = revolutions(in_contact, DRUM_LENGTH), revolutions(in_contact, length)
    alone = revolutions(drum_alone, DRUM_LENGTH), revolutions(wheel_alone, length)
    for direction in ("Left", "Right"):
        write(folder / f"{TYRE} - Contact - {direction} - 60 psi.csv", *both)
        write(folder / f"{TYRE} - Separate - {direction} - 60 psi.csv", *alone)
    return folder


def test_a_known_rolling_resistance_is_found_in_coast_downs(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = coast_down.evaluate(*coast_down.read(folder))
    assert list(found["speed"]) == list(coast_down.SPEEDS)
    within(np.abs(found["C"] / C - 1).max(), 5e-3, "C")
    within(abs(found["R"].iloc[0] / R - 1), 1e-3, "rolling radius")
    monkeypatch.setattr(coast_down, "SHARE", 0.0)
    without_wheel, _ = coast_down.evaluate(*coast_down.read(folder))
    beyond(np.abs(without_wheel["C"] / C - 1).max(), 0.05, "C where the wheel has no inertia")


def later(text: str) -> str:
    """The same by 1.000003 s: another run."""
    return re.sub(r"(?m)^\d+", lambda t: str(int(t[0]) + 1_000_003), text)


def test_one_run_under_two_names_counts_once(folder: Path, tmp_path: Path) -> None:
    found, left_out = coast_down.evaluate(*coast_down.read(folder))
    assert set(found["direction"]) == {"Left"}
    assert list(left_out["reason"]) == [f"a copy of {TYRE}, 60 psi, left"]
    for path in folder.glob("*.csv"):
        text = path.read_text()
        (tmp_path / path.name).write_text(later(text) if "Right" in path.name else text)
    found, left_out = coast_down.evaluate(*coast_down.read(tmp_path))
    assert set(found["direction"]) == {"Left", "Right"}
    assert left_out.empty


def test_a_coast_down_of_the_fmu_is_that_of_drum_and_wheel(library: Library, monkeypatch: pytest.MonkeyPatch) -> None:
    speeds = np.array(coast_down.SPEEDS)
    drag = DRUM_MASS * drum_alone(speeds) + WHEEL_MASS * wheel_alone(speeds)
    run = pd.DataFrame({"speed": speeds, "drag": drag}).assign(R=R, M=DRUM_MASS + WHEEL_MASS)

    def apart() -> float:
        t, v = validation.coast(library, run, C)
        true = solve_ivp(lambda _t, v: -in_contact(v[0]), (0, t[-1]), (speeds[-1],), "DOP853", t, rtol=1e-10)
        return np.abs(v - true.y[0]).max()

    within(apart(), 0.01, "speed")  # m/s; the drag is held over steps of 0.1 s
    monkeypatch.setattr(validation, "LOAD", 0.95 * LOAD)
    beyond(apart(), 0.1, "speed at 95 % of the load")


def test_a_thin_disk_on_its_steady_circle_keeps_inclination_and_energy(
    library: Library, monkeypatch: pytest.MonkeyPatch
) -> None:
    inclination = np.radians(10)
    off, loss = validation.held_disk(library, inclination, 5.0, s=1e-5)
    within(off, 1e-8, "inclination")
    within(loss, 1e-9, "energy")
    monkeypatch.setattr(
        validation, "turn_rate", lambda at: 1.01 * np.sqrt(4 * validation.GRAVITY / (0.0375 * np.sin(at)))
    )
    off, _ = validation.held_disk(library, inclination, 5.0)
    beyond(off, 1e-3, "inclination at 101 % of the precession")


def test_the_credibility_in_the_archive_has_the_figures_of_the_data() -> None:
    figures, text = read_figures(), SRMD.read_text(encoding="utf-8")
    stated = [f"{figures[f'validation.{name}']} {unit}".strip() for name, unit in STATED.items()]
    assert [words for words in stated if words not in text] == []
