"""Driven wheel: a controller FMU keeps a wheel upright along a line and then a circle; alone it falls over.

The wheel rolls at 2 rad/s (0.7 m/s), below the speed at which upright rolling is stable, with rolling friction, and
starts with a small push to the side. Fixed axes; theta is 90 degrees upright.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np
from fmpy import simulate_fmu

from .component import Component
from .master import Connection, Master
from .ssp import System

STOP, STEP = 22.0, 0.005  # s
T_CIRCLE, RADIUS, SPEED = 5.0, 1.5, 0.7  # s, m, m/s: the parameters of balance.py
TURN = 2 * pi * RADIUS / SPEED  # s
START = {
    "s": 0.002,
    "psi_start": 0.0,
    "theta_start": pi / 2,
    "theta_dot_start": 0.1,  # the push, rad/s
    "phi_dot_start": -2.0,
    "X_O_start": 0.0,
}
MEASURED = ("theta", "theta_dot", "psi", "psi_dot", "phi_dot")
RECORD = ("X_O", "Y_O", "phi", *MEASURED, "omega_z", "lambda_3")


@dataclass(frozen=True)
class Drive:
    """The same wheel alone and controlled; column names are the wheel's variables."""

    alone: np.ndarray
    controlled: np.ndarray  # also M_1, M_3


def alone(fmus: dict[str, Path], stop: float = STOP) -> np.ndarray:
    """The wheel without the controller, up to where its model ends."""
    return simulate_fmu(str(fmus["wheel"]), start_values=START, stop_time=stop, output_interval=STEP, output=RECORD)


def parts(fmus: dict[str, Path], parameters: dict[str, float] | None = None) -> list[Component]:
    """Wheel and controller."""
    return [Component("wheel", fmus["wheel"], START), Component("balance", fmus["balance"], parameters or {})]


CONNECTIONS: list[Connection] = [
    *((("wheel", name), ("balance", name)) for name in MEASURED),
    *((("balance", name), ("wheel", name)) for name in ("M_1", "M_3")),
]


def system(fmus: dict[str, Path], parameters: dict[str, float] | None = None) -> System:
    """What balance.ssp holds."""
    return System("balance", parts(fmus, parameters), CONNECTIONS, STEP, STOP)


def controlled(fmus: dict[str, Path], parameters: dict[str, float] | None = None, stop: float = STOP) -> np.ndarray:
    """The wheel with the controller."""
    record = [("wheel", name) for name in RECORD] + [("balance", "M_1"), ("balance", "M_3")]
    with Master(parts(fmus, parameters), CONNECTIONS) as master:
        table = master.run(stop, STEP, record)
    table.dtype.names = ("time", *(variable for _, variable in record))
    return table


def run(fmus: dict[str, Path], parameters: dict[str, float] | None = None) -> Drive:
    """Both runs, the controller with these parameters."""
    return Drive(alone(fmus), controlled(fmus, parameters))


@dataclass(frozen=True)
class Verdict:
    """What the two runs showed, SI and degrees."""

    fall: float  # s, when the wheel alone first leans by more than 45 degrees; infinite if never
    line_tilt: float  # deg, largest departure from upright in the last second of the line
    line_heading: float  # deg, largest departure from the line's direction in that second
    circle_radius: float  # m, of the circle through the last turn
    circle_scatter: float  # m, largest departure from that circle
    circle_tilt: float  # deg, largest departure from upright on the circle
    speed_error: float  # rad/s, largest departure of omega_z from -2 in the last turn


def fall_time(table: np.ndarray) -> float:
    """When the wheel first leans by more than 45 degrees, s; infinite if never."""
    fallen = np.abs(table["theta"] - pi / 2) > pi / 4
    return float(table["time"][fallen.argmax()]) if fallen.any() else float("inf")


def judge(drive: Drive) -> Verdict:
    """The figures of a drive."""
    table = drive.controlled
    t, tilt = table["time"], np.degrees(np.abs(table["theta"] - pi / 2))
    line = (t > T_CIRCLE - 1) & (t <= T_CIRCLE)
    turn = t > STOP - TURN
    x, y = table["X_O"][turn], table["Y_O"][turn]
    a, b, c = np.linalg.lstsq(np.column_stack([x, y, np.ones_like(x)]), x**2 + y**2, rcond=None)[0]
    radius = np.sqrt(c + (a**2 + b**2) / 4)
    return Verdict(
        fall=fall_time(drive.alone),
        line_tilt=float(tilt[line].max()),
        line_heading=float(np.degrees(np.abs(table["psi"][line])).max()),
        circle_radius=float(radius),
        circle_scatter=float(np.abs(np.hypot(x - a / 2, y - b / 2) - radius).max()),
        circle_tilt=float(tilt[t > T_CIRCLE].max()),
        speed_error=float(np.abs(table["omega_z"][turn] + 2).max()),
    )


def fallen(table: np.ndarray) -> str:
    """When the wheel leans over, and how near its plane comes to the ground, on either side."""
    lowest = np.degrees((np.pi / 2 - np.abs(table["theta"] - np.pi / 2)).min())
    after = f"leans over by more than 45 degrees after {fall_time(table):.2f} s"
    return f"{after}, and is down to {lowest:.0f} degrees to the ground within {table['time'][-1]:.1f} s"


def verdict(drive: Drive, radius: float) -> list[str]:
    """What the two runs say, in sentences: of the wheel alone, and of the one that was to drive a circle."""
    found, alone = judge(drive), f"Alone it {fallen(drive.alone)}."
    if np.isfinite(fall_time(drive.controlled)):
        return [alone, f"The controller does not hold it: it {fallen(drive.controlled)}."]
    if not (abs(found.circle_radius - radius) < 0.05 * radius and found.circle_scatter < 0.05 * radius):
        off = f"within {found.circle_scatter:.2g} m of a circle of {found.circle_radius:.3g} m"
        held = f"The controller keeps it from falling over, but it leans by up to {found.circle_tilt:.0f} degrees"
        return [alone, f"{held}, and its last turn is not the circle of {radius:g} m: it is {off}."]
    circle = f"a circle of {found.circle_radius:.4f} m, where {radius:g} m was asked for"
    return [alone, f"Controlled it stays up, leaning by up to {found.circle_tilt:.1f} degrees, and drives {circle}."]
