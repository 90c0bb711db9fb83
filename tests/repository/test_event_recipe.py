"""An event that is added by CONTRIBUTING's recipe is logged at every crossing in every way of running, before and after
a snapshot. The crossings are those of theta and X_O, read on a fine grid."""

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from support import driver
from support import exchange as exchanging
from support.bounds import beyond, within
from support.driver import OK
from support.motion import Library

from .event_recipe import build

DIPS, LINE = re.compile(r"leans by more than .* from t = (\S+) s on"), re.compile(r"crosses the line at t = (\S+) s")
LEAN = 1.29  # rad: the level of the recipe
WAYS = {"unfolded": {}, "Runge-Kutta": {"method": 4}, "Adams": {"method": 2}, "multibody": {"formulation": 3}}
STOP = 6.0


@pytest.fixture(scope="module")
def patched(fmu: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    folder = tmp_path_factory.mktemp("event")
    unpacked = folder / "fmu"
    shutil.copytree(fmu, unpacked)
    (binary,) = unpacked.glob("binaries/*/wheel.so")
    shutil.copy(build(folder), binary)
    yield Library(Path(unpacked))


def falls(library: Library, name: str, level: float, **start: float) -> list[float]:
    """Where the output falls below the level, by the secant on a grid of a millisecond."""
    run = library.simulate(np.linspace(0, STOP, 6001), 1e-11, **start)
    t, x = run.t, run[name] - level
    k = np.flatnonzero((x[:-1] >= 0) & (x[1:] < 0))
    return [float(v) for v in t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k])]


def logged(pattern: re.Pattern, messages: list[str]) -> list[float]:
    return [float(found[1]) for message in messages if (found := pattern.search(message))]


def gap(want: list[float], got: list[float]) -> float:
    assert len(want) == len(got) >= 3
    return float(np.abs(np.array(want) - got).max())


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("step", [0.01, 1.0, STOP])
def test_every_crossing_is_logged_whatever_the_grid(library: Library, patched: Library, way: str, step: float) -> None:
    times = np.arange(0, STOP + step / 2, step)
    run = patched.simulate(times, 1e-11, **WAYS[way])
    want = falls(library, "theta", LEAN)
    within(gap(want, logged(DIPS, run.messages)), 1e-6, "instant, s")
    beyond(gap(falls(library, "theta", LEAN - 1e-3), logged(DIPS, run.messages)), 1e-5, "instant of another level, s")
    if way == "unfolded":  # it still is
        assert run.counters["n_rhs"] == library.simulate(times, 1e-11).counters["n_rhs"]


@pytest.mark.parametrize("way", WAYS)
def test_an_event_that_is_no_symmetry_of_the_motion_keeps_it_from_being_unfolded(library, patched, way: str) -> None:
    run = patched.simulate([0.0, 2.0, STOP], 1e-11, keep_contact=True, **WAYS[way])
    within(gap(falls(library, "X_O", -0.5, keep_contact=True), logged(LINE, run.messages)), 1e-6, "instant, s")
    within(gap(falls(library, "theta", LEAN), logged(DIPS, run.messages)), 1e-6, "instant, s")
    if way == "unfolded":
        assert run.counters["n_rhs"] > 2 * library.simulate([0.0, STOP], 1e-11, keep_contact=True).counters["n_rhs"]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("cut", [0.9, 2.1, 3.4])
def test_a_restored_run_logs_what_lies_ahead_and_nothing_else(patched: Library, way: str, cut: float) -> None:
    whole = patched.wheel(logging=True).start(**WAYS[way])
    assert whole.step_to(cut) == OK
    blob = whole.serialized()
    whole.take_messages()
    other = patched.wheel(logging=True)
    assert other.restore(blob) == OK
    assert other.take_messages() == []
    other.time = cut
    for wheel in (whole, other):
        wheel.set(M_1=1e-7)  # off the orbit
        assert wheel.step_to(STOP) == OK
    assert whole.sentences == other.sentences and min(logged(DIPS, other.sentences)) > cut


def test_another_solver_finds_it_by_its_indicator(library, patched, monkeypatch) -> None:
    names = (*driver.INDICATORS, "leans", "crosses_line")
    monkeypatch.setattr(driver, "INDICATORS", names)
    with exchanging.exchange(patched, logging=True, keep_contact=True) as wheel:
        run = exchanging.Run(wheel, 1e-10, exchanging.no_inputs)
        run.to(2.0)
        blob = wheel.serialized()
        run.to(STOP)
        found = wheel.sentences
        within(gap(falls(library, "X_O", -0.5, keep_contact=True), logged(LINE, found)), 1e-6, "instant, s")
        within(gap(falls(library, "theta", LEAN), logged(DIPS, found)), 1e-6, "instant, s")
        wheel.take_messages()
        assert wheel.restore(blob) == OK and wheel.take_messages() == []
        again = exchanging.Run(wheel, 1e-10, exchanging.no_inputs)
        again.t = 2.0
        again.to(STOP)
        later = [t for t in logged(DIPS, found) if t > 2.0]
        within(gap(later, logged(DIPS, wheel.sentences)), 1e-6, "instant after the snapshot, s")


def test_many_occurrences_are_counted_and_the_first_hundred_logged(patched: Library) -> None:
    run = patched.simulate([0.0, 1000.0], 1e-9)
    assert len(logged(DIPS, run.messages)) == 100
