"""Driven wheel: a controller keeps upright what alone would fall, along a line and a circle."""

import numpy as np
from support.bounds import beyond, within

from lab.vehicles import balance
from lab.vehicles.vehicle import Fmus


def test_the_controlled_wheel_drives_its_course_where_the_wheel_alone_falls(fmus: Fmus) -> None:
    drive = balance.drive(fmus)
    found = balance.judge(drive)
    within(found["fall"], 2, "instant at which the wheel alone falls, s")
    assert balance.fall_time(drive) == np.inf
    known = np.isfinite(drive["alone.theta"])  # partner: the same figures of the wheel alone, which ends early
    alone = balance.judge({n: drive.get(f"alone.{n}", x)[known] for n, x in drive.items()})
    bounds = {"line_tilt": (0.01, 10), "line_heading": (0.03, 30)}  # deg
    bounds |= {"circle_scatter": (0.003, 0.1), "speed_error": (0.003, 0.1)}  # m, rad/s
    for name, (bound, broken) in bounds.items():
        within(found[name], bound, name)
        beyond(alone[name], broken, f"{name} of the wheel alone")
    within(abs(found["circle_radius"] - balance.RADIUS), 0.01, "radius of the circle, m")
    within(found["circle_tilt"], 10, "tilt on the circle, deg")  # a wheel turns to the side it leans to
