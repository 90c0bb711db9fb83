"""Driven wheel: a pythonfmu controller keeps upright what alone would fall, along a line and a circle."""

import numpy as np
from support.bounds import beyond, within
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
