"""What a picture shows of wheel.fmu: dense enough for the fastest rotation, with events at their instants."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from support.bounds import beyond, relative_error, within

from wheelfmu.diagrams import paper, reading
from wheelfmu.fmu import presets
from wheelfmu.fmu.paths import build_folder
from wheelfmu.truth.closed_forms import upright_stiffness
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import PAPER

UPRIGHT = {"theta_start": np.pi / 2, "psi_start": 0.0}
LOCKED = UPRIGHT | {"guided": 1, "phi_dot_start": -20.0, "M_brake": 400.0, "mu_max": 0.5, "mu_slide": 0.4, "s": 0.0}


@pytest.fixture(scope="module")
def library() -> Iterator[Library]:
    loaded = Library.unpacked(build_folder() / "wheel.fmu")
    yield loaded
    loaded.remove()


def test_a_fast_nutation_has_forty_rows_in_each_period_and_no_beat(library: Library) -> None:
    """Between its turning points theta swings with one amplitude; partner: rows of 10 ms show another at each swing."""
    start = UPRIGHT | {"theta_start": np.radians(80), "phi_dot_start": -60.0}
    one = reading.read(library, "free", start, 4.0)
    period = 2 * np.pi / upright_stiffness(PAPER, -60.0) ** 0.5
    beyond(period / np.diff(one["time"]).max(), 38, "rows in a period of the nutation")

    def low_points(theta: np.ndarray) -> np.ndarray:
        inside = theta[1:-1]
        return inside[(inside < theta[:-2]) & (inside < theta[2:])]

    swing = np.ptp(one["theta"])
    within(np.ptp(low_points(one["theta"])), 0.005 * swing, "low points of theta apart, rad")
    coarse = library.simulate(np.arange(401) * 0.01, **start)["theta"]
    beyond(np.ptp(low_points(coarse)), 0.03 * swing, "low points in rows of 10 ms apart, rad")


def test_extremes_and_instants_are_those_of_the_motion(library: Library) -> None:
    """Locked from v = 7 m/s with mu = 0.4: it slides v / (mu g) long over v^2 / (2 mu g), fastest as it locks."""
    v, slowing = 20.0 * 0.35, 0.4 * 9.81
    one = reading.read(library, "free", LOCKED, 4.0)
    within(abs(one.rest - v / slowing), 1e-8, "instant of rest, s")
    within(abs(one["X_O"][-1] - one["X_O"][0] - v * v / 2 / slowing), 1e-7, "distance, m")
    locks = one.instants[1]
    within(abs(one.peak(one.slip)[1] - (v - slowing * locks)), 1e-7, "largest slip, m/s")
    beyond(np.abs(np.arange(0, 4, 0.01) - one.rest).min(), 1e-3, "instant of rest off the rows of 10 ms, s")


def test_the_friction_coefficient_that_the_papers_wheel_needs_is_right_to_four_digits(library: Library) -> None:
    """Beside a reading about the instant; partner: the largest of rows of 10 ms."""
    one = reading.read(library, "friction", {"s": 0.03}, 10.0)
    at, most = one.peak(one["mu_required"])
    fine = library.simulate([0.0, *(at + np.linspace(-2e-3, 2e-3, 401))], s=0.03)["mu_required"][1:].max()
    within(relative_error(most, fine), 1e-5, "largest mu_required, relative")
    rows = library.simulate(np.arange(1001) * 0.01, s=0.03)["mu_required"].max()
    beyond(relative_error(rows, fine), 1e-4, "that of rows of 10 ms, relative")


def test_a_mode_changes_at_the_instant_of_its_event_and_two_close_events_have_a_row_between(library: Library) -> None:
    one = reading.read(library, "friction", {"s": 0.03}, 10.0)
    assert one.transitions == len(one.instants) == 37
    changes = one.edges[1:-1][np.diff(one.mode) != 0]
    assert changes.tolist() == [*one.instants]
    times = reading.times_of(1.0, 0.0, [0.5, 0.5 + 1e-6, 0.7])
    assert {0.5, 0.5 + 1e-6, 0.7, 0.0, 1.0} < {*times} and ((times > 0.5) & (times < 0.5 + 1e-6)).sum() == 1
    assert np.diff(times).min() > 4e-7 and np.diff(times).max() < 6e-4


def test_an_early_end_is_the_last_row(library: Library) -> None:
    one = reading.read(library, "free", {"phi_dot_start": 0.0}, 10.0)
    within(abs(one["time"][-1] - 0.5927504147), 1e-8, "end, s")
    assert one.ending == "lies flat at $t$ = 0.5928 s"


@pytest.mark.parametrize(
    ("spin", "free", "carried"), [(-2.0, 0.01, 0.01), (-20.0, 0.002, 0.005), (-60.0, 0.001, 0.002)]
)
def test_the_interval_of_the_rows_follows_the_fastest_period_of_the_start(spin, free, carried) -> None:
    """Forty rows in the period of the nutation, 1.593 times as fast as the spin; of the spin on a wheel carrier."""
    own = {name: v.preset for name, v in paper.SETTINGS.items()} | {"phi_dot_start": spin}
    assert (presets.interval(own, 0.01), presets.interval(own | {"guided": 1.0}, 0.01)) == (free, carried)
    fast = upright_stiffness(PAPER, 1e4) ** 0.5
    within(relative_error(presets.nutation(own, 1e4), fast), 1e-6, "nutation at high spin, relative")
