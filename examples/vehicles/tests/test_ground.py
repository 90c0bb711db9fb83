"""Drive torque, rolling friction and sand: the stick condition, release and a tunable s against closed forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.bounds import beyond, within
from vehicles import ground


def test_a_standing_wheel_stays_until_the_torque_beats_s_N(fmus: dict[str, Path]) -> None:
    table = ground.stand(fmus, 0.99).table
    assert np.all(table["omega_z"] == 0)
    assert np.all(table["X_O"] == 0)


@pytest.mark.parametrize("share", [1.01, 2.0])
def test_beyond_s_N_it_moves_as_the_closed_form_says(fmus: dict[str, Path], share: float) -> None:
    """Partner of the standing wheel. omega_z = -(share - 1) s N t / J while the torque is on."""
    table = ground.stand(fmus, share).table
    on = (table["time"] > 0.1) & (table["time"] < 0.495)
    exact = -(share - 1) * 0.01 * ground.M * ground.G / ground.J * (table["time"][on] - 0.1)
    within(np.abs(table["omega_z"][on] - exact).max(), 1e-15, "spin off, rad/s")


def test_it_rolls_out_and_stands_again(fmus: dict[str, Path]) -> None:
    run = ground.stand(fmus, 1.01)
    assert run.table["omega_z"][-1] == 0
    assert run.log == [
        "t = 0.1 s: release, omega_z becomes negative.",
        "t = 0.504 s: stick, omega_z is held at zero.",  # 0.4 s of 1 % excess, then s N alone: 4 ms
    ]


def test_a_growing_torque_releases_the_wheel_inside_a_step(fmus: dict[str, Path]) -> None:
    """The torque is given with its derivative: the release is found between communication points."""
    run = ground.ramp(fmus)
    within(np.abs(run.table["omega_z"] - ground.ramp_speed(run.table["time"])).max(), 1e-15, "spin off, rad/s")
    late = np.abs(run.table["omega_z"] - ground.ramp_speed(run.table["time"], release=0.506)).max()
    beyond(late, 1e-4, "spin off, released 1 ms late, rad/s")
    assert run.log == ["t = 0.505 s: release, omega_z becomes negative."]


def test_a_wheel_that_rolls_onto_sand_slows_down_from_there(fmus: dict[str, Path]) -> None:
    run = ground.sand(fmus)
    within(np.abs(run.table["omega_z"] - ground.sand_speed(run.table["time"])).max(), 2e-13, "spin off, rad/s")
    late = np.abs(run.table["omega_z"] - ground.sand_speed(run.table["time"], at=0.51)).max()
    beyond(late, 1e-3, "spin off, sand 10 ms late, rad/s")
    assert run.log == []  # it rolls on as before: no transition of the slip


def test_a_force_that_lifts_the_wheel_ends_the_run(fmus: dict[str, Path]) -> None:
    """N >= 0: the ground does not pull; F_Z grows through m g = 196.2 N at 0.5 s."""
    weight = ground.M * ground.G
    with pytest.raises(Exception, match="lifted off the ground"):
        ground.run(fmus, 1.0, {**ground.UPRIGHT, "phi_dot_start": -5.0}, lambda t: {"F_Z": 2 * weight * t})
