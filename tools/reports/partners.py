"""The wheel among other FMUs: the examples of examples/vehicles, run and judged.

The two vehicles are measured by functions of that package, which the tests of the examples call too.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from support.motion import Run
from support.paths import ROOT
from support.scenes import PAPER
from support.schedule import Schedule

from .page import Report, part

UPRIGHT = {"theta_start": np.pi / 2, "psi_start": 0.0, "X_O_start": 0.0}


def fmus(report: Report) -> dict[str, Path]:
    """Every FMU of the examples, built."""
    from vehicles.build import build_all

    if "fmus" not in report.kept:
        report.kept["fmus"] = build_all(ROOT / "build" / "examples")
    return report.kept["fmus"]


@part(20)
def driven_wheel(report: Report) -> None:
    """the driven, balanced wheel"""
    from vehicles import balance, drawing

    drive = balance.drive(fmus(report))
    found = balance.judge(drive)
    report.figures(alone=found["fall"], tilt=found["line_tilt"], circle=abs(found["circle_radius"] - balance.RADIUS))
    report.figures(scatter=found["circle_scatter"], speed=found["speed_error"])
    drawing.draw(balance.BALANCE, balance.CIRCLE, drive, report.folder / "partners_driven.png")


@part(25)
def suspended_wheel(report: Report) -> None:
    """the suspended wheel against one set of equations"""
    from vehicles import drawing, errors, suspended

    truth, units = suspended.together(), fmus(report)
    steps = suspended.STEPS[:3] if report.quick else suspended.STEPS
    found = suspended.convergence(units, truth, steps)
    names = {"positions held": "values held", "held": "positions that follow", "derivatives": "first derivatives"}
    columns = {"step, ms": 1000 * np.array(steps)} | {names[kind]: values for kind, values in found.of.items()}
    columns["share lost to the lag of a held position"] = [suspended.drag_share(h) for h in steps]
    report.table("orders", pd.DataFrame(columns))
    linear = found.of["derivatives"]
    report.figures(order=2 - min(errors.orders(steps, linear)), linear=linear[-1])
    package = suspended.SUSPENDED.package(units, suspended.LAUNCH, 0.001, ROOT / "build" / "examples")
    shares = [{"step, ms": 1000 * h, "error": suspended.package_distance(package, h, truth)} for h in steps[1:4]]
    report.table("package", shares)
    limits = [
        {"step, ms": 1000 * h}
        | {e: "breaks" if suspended.ends(units, h, e) else "runs" for e in ("held", "derivatives")}
        for h in suspended.LARGE_STEPS
    ]
    report.table("limits", limits)
    launch = suspended.coupled(units, 0.000625, "derivatives", grid=0.005)
    drawing.draw(suspended.SUSPENDED, suspended.LAUNCH, launch, report.folder / "partners_suspended.png", errors=found)


@part(3)
def ground(report: Report) -> None:
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
        wheel.start(s=0.0, phi_dot_start=-20.0, **UPRIGHT)
        wheel.step_to(0.5)
        wheel.set(s=5 * s)
        wheel.step_to(2.0)
        sand = wheel.get("omega_z")[0] - (-20 + 5 * held / J * 1.5)
    of_ramp = np.abs(ramp["omega_z"] - rate / J / 2 * np.maximum(times - release, 0) ** 2).max()
    standing, breaking = (np.abs(run["omega_z"]).max() for run in (still, moving))
    report.figures(standing=standing, breaking=breaking, ramp=of_ramp, sand=abs(sand))
    report.table("log", [{"sentence": sentence} for sentence in moving.messages + ramp.messages])
