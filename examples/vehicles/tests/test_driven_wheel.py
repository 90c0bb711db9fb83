"""Driven wheel: a pythonfmu controller keeps upright what alone would fall, along a line and a circle."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.bounds import beyond, within
from support.paths import ROOT
from vehicles import balance
from vehicles.vehicle import Table


@pytest.fixture(scope="module")
def drive(fmus: dict[str, Path]) -> Table:
    return balance.drive(fmus)


def test_the_controlled_wheel_drives_its_course_where_the_wheel_alone_falls(drive: Table) -> None:
    found = balance.judge(drive)
    within(found["fall"], 2, "the wheel alone falls, s")
    assert balance.fall_time(drive) == np.inf
    known = np.isfinite(drive["alone.theta"])  # partner: the same figures of the wheel alone, which ends early
    alone = balance.judge({n: drive.get(f"alone.{n}", x)[known] for n, x in drive.items()})
    bounds = {"line_tilt": (0.01, 10), "line_heading": (0.03, 30)}  # deg
    bounds |= {"circle_scatter": (0.003, 0.1), "speed_error": (0.003, 0.1)}  # m, rad/s
    for name, (bound, broken) in bounds.items():
        within(found[name], bound, name)
        beyond(alone[name], broken, f"{name} of the wheel alone")
    within(abs(found["circle_radius"] - balance.RADIUS), 0.01, "radius off, m")
    within(found["circle_tilt"], 10, "tilt on the circle, deg")  # a wheel turns to the side it leans to


def test_a_controller_of_the_speed_alone_lets_the_wheel_fall(fmus: dict[str, Path]) -> None:
    """Partner: it is M_1 that holds the wheel up."""
    table = balance.drive(fmus, balance.CIRCLE.changed(k_theta=0.0, c_theta=0.0, stop=3.0))
    beyond(np.abs(table["theta"] - np.pi / 2).max(), np.pi / 4, "tilt, rad")


ONE_DRIVE = """
import sys
from vehicles import balance, build, component
if sys.argv[1] == "kept":
    component.let_go_of_python = lambda fmu: None
balance.drive(dict(zip(sys.argv[2::2], map(build.Path, sys.argv[3::2]))), balance.CIRCLE.changed(stop=0.1))
"""


@pytest.mark.parametrize(("state", "status"), [("released", 0), ("kept", -signal.SIGSEGV)])
def test_the_process_ends_without_touching_what_the_interpreter_of_the_controller_has_freed(
    fmus: dict[str, Path], tmp_path: Path, state: str, status: int
) -> None:
    fence = tmp_path / "fence.so"
    subprocess.run(["c++", "-shared", "-fPIC", "-o", fence, Path(__file__).with_name("fence.cpp")], check=True)
    paths = os.pathsep.join(map(str, (ROOT / "examples" / "vehicles", ROOT / "tests")))
    environment = os.environ | {"LD_PRELOAD": str(fence), "PYTHONPATH": paths}
    parts = [text for pair in fmus.items() for text in pair]
    run = subprocess.run([sys.executable, "-B", "-c", ONE_DRIVE, state, *parts], env=environment, check=False)
    assert run.returncode == status
