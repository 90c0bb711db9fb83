"""Driven wheel: a pythonfmu controller keeps upright what alone would fall, along a line and a circle."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.bounds import beyond, within
from support.paths import ROOT
from vehicles import driven
from vehicles.driven import Table


@pytest.fixture(scope="module")
def drive(fmus: dict[str, Path]) -> Table:
    return driven.run(fmus).table


@pytest.fixture(scope="module")
def verdict(drive: Table) -> driven.Verdict:
    return driven.judge(drive)


def test_the_wheel_alone_falls_within_two_seconds(verdict: driven.Verdict) -> None:
    within(verdict.fall, 2, "falls, s")


def test_the_controlled_wheel_never_falls(drive: Table) -> None:
    assert driven.fall_time(drive) == np.inf


def test_it_rolls_upright_along_a_line(verdict: driven.Verdict) -> None:
    within(verdict.line_tilt, 0.01, "tilt, deg")
    within(verdict.line_heading, 0.03, "off the heading, deg")


def test_it_rolls_along_the_circle_asked_for(verdict: driven.Verdict) -> None:
    within(abs(verdict.circle_radius - driven.RADIUS), 0.01, "radius off, m")
    within(verdict.circle_scatter, 0.003, "off the circle, m")
    within(verdict.circle_tilt, 10, "tilt, deg")  # a wheel turns to the side it leans to


def test_it_holds_its_speed_against_rolling_friction(verdict: driven.Verdict) -> None:
    within(verdict.speed_error, 0.003, "spin off, rad/s")


def test_the_wheel_alone_fails_every_bound_of_the_course(drive: Table) -> None:
    """Partner: the same verdict on the run without controller."""
    known = np.isfinite(drive["alone.theta"])  # it ends early
    alone = driven.judge({n: drive.get(f"alone.{n}", x)[known] for n, x in drive.items()})
    beyond(alone.line_tilt, 10, "tilt, deg")
    beyond(alone.line_heading, 30, "off the heading, deg")
    beyond(alone.circle_scatter, 0.1, "off the circle, m")
    beyond(alone.speed_error, 0.1, "spin off, rad/s")


def test_a_controller_of_the_speed_alone_lets_the_wheel_fall(fmus: dict[str, Path]) -> None:
    """Partner: it is M_1 that holds the wheel up."""
    table = driven.controlled(fmus, driven.CIRCLE.changed(k_theta=0.0, c_theta=0.0, stop=3.0)).table
    beyond(np.abs(table["theta"] - np.pi / 2).max(), np.pi / 4, "tilt, rad")


ONE_DRIVE = """
import sys
from pathlib import Path
from vehicles import component, driven
if sys.argv[3] == "kept":
    component.let_go_of_python = lambda fmu: None
driven.controlled({"wheel": Path(sys.argv[1]), "balance": Path(sys.argv[2])}, driven.CIRCLE.changed(stop=0.1))
"""


def test_the_process_ends_without_touching_what_the_interpreter_of_the_controller_has_freed(
    fmus: dict[str, Path], tmp_path: Path
) -> None:
    fence = tmp_path / "fence.so"
    subprocess.run(["c++", "-shared", "-fPIC", "-o", fence, Path(__file__).with_name("fence.cpp")], check=True)
    paths = os.pathsep.join(map(str, (ROOT / "examples" / "vehicles", ROOT / "tests")))
    environment = os.environ | {"LD_PRELOAD": str(fence), "PYTHONPATH": paths}
    status = {
        state: subprocess.run(
            [sys.executable, "-B", "-c", ONE_DRIVE, fmus["wheel"], fmus["balance"], state], env=environment, check=False
        ).returncode
        for state in ("released", "kept")
    }
    assert status == {"released": 0, "kept": -signal.SIGSEGV}
