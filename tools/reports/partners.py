"""The wheel among other FMUs: the examples of examples/vehicles, run and judged.

The two vehicles are measured by functions of that package, which the tests of the examples call too.
"""

from __future__ import annotations

import numpy as np
import pandas as pd
from support.motion import Run
from support.paths import ROOT
from support.scenes import PAPER
from support.schedule import Schedule
from vehicles import balance, drawing, errors, suspended

from .page import Report, part

UPRIGHT = {"theta_start": np.pi / 2, "psi_start": 0.0, "X_O_start": 0.0}
NAMES = {"held": "positions that follow", "positions held": "values held", "derivatives": "first derivatives"}


@part(20)
def driven_wheel(report: Report) -> dict[str, float]:
    """the driven, balanced wheel"""
    drive = balance.drive(report.fmus)
    drawing.draw(balance.BALANCE, balance.CIRCLE, drive, report.folder / "partners_driven.png")
    found = balance.judge(drive)
    radius = abs(found["circle_radius"] - balance.RADIUS)
    of_line = {"alone": found["fall"], "tilt": found["line_tilt"], "circle": radius}
    return of_line | {"scatter": found["circle_scatter"], "speed": found["speed_error"]}


@part(25)
def suspended_wheel(report: Report) -> dict[str, object]:
    """the suspended wheel against one set of equations"""
    truth, units = suspended.together(), report.fmus
    steps = suspended.STEPS[:3] if report.quick else suspended.STEPS
    found = suspended.convergence(units, truth, steps)
    orders = pd.DataFrame(found).reset_index(drop=True).rename(columns=NAMES)
    orders.insert(0, "step, ms", 1000 * np.array(steps))
    orders["share lost to the lag of a held position"] = [suspended.drag_share(h) for h in steps]
    package = suspended.SUSPENDED.package(units, suspended.LAUNCH, 0.001, ROOT / "build" / "examples")
    launch = suspended.SUSPENDED.drive(units, suspended.LAUNCH, 0.000625, grid=0.005).whole
    drawing.draw(suspended.SUSPENDED, suspended.LAUNCH, launch, report.folder / "partners_suspended.png", errors=found)
    packaged = [{"step, ms": 1000 * h, "error": suspended.package_distance(package, h, truth)} for h in steps[1:4]]
    return {"orders": orders, "package": packaged, "order": 2 - min(errors.orders(found["derivatives"]))}


@part(5, {"step, ms": {1000 * h: h for h in suspended.LARGE_STEPS}})
def limits(report: Report, h: float) -> dict[str, str]:
    """the suspended wheel: steps that are too large"""
    runs = {e: suspended.SUSPENDED.drive(report.fmus, suspended.LAUNCH, h, e, h) for e in ("held", "derivatives")}
    return {e: "breaks" if run.ending else "runs" for e, run in runs.items()}


@part(3)
def ground(report: Report) -> dict[str, object]:
    """standing, breaking away, sand: an upright wheel on a line, where closed forms are exact"""
    s, times = 0.01, np.linspace(0, 1, 101)
    held, J = s * PAPER.m * PAPER.g, PAPER.J_z + PAPER.m * (PAPER.r_0 + PAPER.r) ** 2  # N m; kg m2, about the contact

    def pushed(*pieces: tuple[float, float | tuple[float, ...]]) -> Run:
        inputs = Schedule(tuple((t, {"M_3": torque}) for t, torque in pieces))
        return report.library.simulate(times, inputs=inputs, s=s, phi_dot_start=0.0, **UPRIGHT)

    still, moving = (pushed((0, 0.0), (0.1, -share * held), (0.5, 0.0)) for share in (0.99, 1.01))
    release, rate = 0.505, -held / 0.505  # s, N m/s
    ramp = pushed((0, (0.0, rate)))
    with report.library.wheel() as wheel:
        wheel.start(s=0.0, phi_dot_start=-20.0, **UPRIGHT).step_to(0.5)
        wheel.set(s=5 * s)
        wheel.step_to(2.0)
        sand = wheel.get("omega_z")[0] - (-20 + 5 * held / J * 1.5)
    late = ramp["omega_z"] - rate / J / 2 * np.maximum(times - release, 0) ** 2
    most = {"standing": still["omega_z"], "breaking": moving["omega_z"], "ramp": late, "sand": sand}
    log = [{"sentence": sentence} for sentence in moving.messages + ramp.messages]
    return {name: np.abs(values).max() for name, values in most.items()} | {"log": log}
