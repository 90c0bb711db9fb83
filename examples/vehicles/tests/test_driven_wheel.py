"""Driven wheel: a pythonfmu controller keeps upright what alone would fall, along a line and a circle."""

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from support.bounds import beyond, within
from support.paths import ROOT
from vehicles import balance
from vehicles.vehicle import Fmus


def test_the_controlled_wheel_drives_its_course_where_the_wheel_alone_falls(fmus: Fmus) -> None:
    drive = balance.drive(fmus)
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


def test_the_sentence_of_a_fall_has_the_lowest_angle_and_that_at_the_end() -> None:
    """A wheel that comes down on either side and rises again; one whose record ends lying flat."""
    plane = {"rises": [90, 60, 40, 1.2, 30, 84.4, np.nan], "ends": [90, 60, 40, 20, 10, 3, 0.1]}
    ends = {"rises": "down to 1 degree to the ground, and is at 84 degrees at the end"}
    ends |= {"ends": "down to 0 degrees to the ground, and is at 0 degrees at the end"}
    for name, angles in plane.items():
        for side in (np.radians(angles), np.pi - np.radians(angles)):
            said = balance.fallen({"time": np.arange(7.0), "theta": side})
            assert said.startswith("leans over by more than 45 degrees after 2.00 s") and ends[name] in said


ONE_DRIVE = """
import sys
from vehicles import balance, build, component
if sys.argv[1] == "kept":
    component.let_go_of_python = lambda fmu: None
balance.drive(dict(zip(sys.argv[2::2], map(build.Path, sys.argv[3::2]))), balance.CIRCLE.changed(stop=0.1))
"""


# Of glibc: each block has pages for itself, which are gone once it is freed: who touches them then gets SIGSEGV.
FENCED = {"MALLOC_MMAP_THRESHOLD_": "0", "MALLOC_ARENA_MAX": "1"}


@pytest.mark.parametrize(("state", "status"), [("released", 0), ("kept", -signal.SIGSEGV)])
def test_the_process_ends_without_touching_what_the_interpreter_of_the_controller_has_freed(
    fmus: Fmus, state: str, status: int
) -> None:
    paths = os.pathsep.join(map(str, (ROOT / "examples" / "vehicles", ROOT / "tests")))
    command = [sys.executable, "-B", "-c", ONE_DRIVE, state, *(text for pair in fmus.items() for text in pair)]
    assert subprocess.run(command, env=os.environ | FENCED | {"PYTHONPATH": paths}).returncode == status
