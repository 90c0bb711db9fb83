"""The car: chassis, driver and a wheel per strut, wired from the layout car/car.toml; its manoeuvres.

Steering angles to the left; lateral acceleration and load in the words of ISO 8855. Five manoeuvres and one that is too
fast for the car; each is judged by closed forms (car_judges.py) and by the same car as one set of equations.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, field, replace
from math import atan, cos, pi, sin, tan
from pathlib import Path

import numpy as np

from . import options
from .build import EXAMPLES
from .component import Component, Ended
from .driver_path import DRIVER_DEFAULTS
from .hubs import FORCE, MOMENT, POSE, upright, wire
from .master import Connection, Master, Signal
from .ssp import System

LAYOUT = tomllib.loads((EXAMPLES / "car" / "car.toml").read_text())
WHEELS: dict[str, dict[str, float | str]] = LAYOUT["wheel"]
NAMES = {wheel: str(of["name"]) for wheel, of in WHEELS.items()}
X_REAR = float(np.mean([w["x"] for w in WHEELS.values() if not w["steer"]]))  # rear point from the centre of mass
WHEELBASE = float(np.mean([w["x"] for w in WHEELS.values() if w["steer"]])) - X_REAR  # m
TRACK = float(np.ptp([w["y"] for w in WHEELS.values() if w["steer"]]))  # m, of the steered wheels
R_0, R, M_WHEEL, J_Z, G = 0.3, 0.35, 20.0, 1.8, 9.81  # the wheels' defaults
MASS = LAYOUT["chassis"]["m_B"] + M_WHEEL * len(WHEELS)

CONNECTIONS: list[Connection] = [
    *(c for w in WHEELS for c in wire("chassis", w, (*POSE, "tau", "lambda_3"), (*FORCE, *MOMENT, "M_brake"))),
    *((("chassis", name), ("driver", name)) for name in ("X_R", "Y_R", "psi", "v")),
    *((("driver", name), ("chassis", name)) for name in ("delta", "delta_dot", "M_drive", "M_brake")),
]
OF_CHASSIS = ("X", "Y", "Z", "psi", "roll", "pitch", "v", "omega", "X_R", "Y_R")
OF_DRIVER = ("delta", "M_drive", "M_brake", "p", "off")
OF_WHEEL = ("X_O", "Y_O", "psi", "theta", "phi", "omega_z", "lambda_1", "lambda_2", "lambda_3", "mu_required", "tau")
RECORD: list[Signal] = [
    *(("chassis", name) for name in OF_CHASSIS),
    *(("driver", name) for name in OF_DRIVER),
    *(("chassis", f"{name}_{w}") for w in WHEELS for name in ("d", "delta")),
    *((w, name) for w in WHEELS for name in OF_WHEEL),
]
ROLL_BACK = 1e-3  # m
OFF_PATH = 0.5  # m: farther from its path a car does not drive it
DRY_ROAD = 1.0  # friction coefficient of tyres on dry asphalt, about
COMPARED = ("X", "Y", "psi", "roll", "pitch", "v", "omega")


@dataclass(frozen=True)
class Manoeuvre:
    """What the driver does, from which speed, for how long."""

    name: str
    title: str
    stop: float  # s
    v: float = 0.0  # m/s
    s: float = 0.0  # m, rolling friction of the wheels
    slope: float = 0.0  # rad, of the road
    slope_direction: float = 0.0  # rad from X to the left: where the road rises to
    driver: dict[str, float] = field(default_factory=dict)
    chassis: dict[str, float] = field(default_factory=dict)

    def driver_start(self) -> dict[str, float]:
        """Parameters of driver.fmu."""
        return {"v_0": self.v, "v_1": self.v, "L": WHEELBASE, **self.driver}

    def chassis_start(self) -> dict[str, float]:
        """Parameters of chassis.fmu."""
        return {"v_start": self.v, "s": self.s, **self.road(), **self.chassis}

    def road(self) -> dict[str, float]:
        """Parameters of chassis.fmu and of the wheels alike."""
        return {"slope": self.slope, "slope_direction": self.slope_direction}


HOLD_SPEED = {"k_v": 3000.0, "k_i": 1500.0}
STRAIGHT = Manoeuvre(
    "straight",
    "launch and straight braking",
    8.0,
    s=0.004,
    driver={"M_0": 1200.0, "t_on": 0.5, "t_off": 3.5, "B_0": 1800.0, "t_brake": 4.2},
)
CIRCLE = Manoeuvre(
    "circle",
    "steady circle, the speed rising (in the manner of ISO 4138)",
    25.0,
    3.0,
    driver={**HOLD_SPEED, "delta_0": 0.14, "t_delta": 0.5, "ramp_delta": 1.5, "v_1": 8.0, "t_v": 4.0, "ramp_v": 18.0},
)
STEP = Manoeuvre(
    "step",
    "step of the steering wheel (ISO 7401)",
    4.0,
    12.0,
    driver={**HOLD_SPEED, "delta_0": 0.07, "t_delta": 0.5, "ramp_delta": 0.5},
)
AT_ORIGIN = {"X_start": -X_REAR}  # the rear point begins where the path does
EIGHT = Manoeuvre(
    "eight", "figure of eight", 22.0, 5.0, driver={**HOLD_SPEED, "path": 1.0, "size": 20.0}, chassis=AT_ORIGIN
)
LANE = Manoeuvre(
    "lane", "double lane change", 7.0, 15.0, driver={**HOLD_SPEED, "path": 2.0, "length": 10.0}, chassis=AT_ORIGIN
)
HILL = Manoeuvre(
    "hill",
    "hill start, stop and park",
    9.0,
    s=0.004,
    slope=atan(0.15),
    driver={
        **{"B_hold": 2500.0, "t_release": 1.8, "M_0": 1500.0, "t_on": 1.2, "t_off": 4.0},
        **{"B_0": 2500.0, "t_brake": 5.6, "ramp_M": 0.6},
    },
)
TOO_FAST = replace(STEP, name="too_fast", title="the same step too fast", v=22.0)
MANOEUVRES = dict(zip(options.MANOEUVRES, (STRAIGHT, CIRCLE, STEP, EIGHT, LANE, HILL, TOO_FAST), strict=True))


def wheel_start(manoeuvre: Manoeuvre, name: str) -> dict[str, float]:
    """Parameters of a wheel.fmu; the chassis starts at the origin unless its parameters say otherwise."""
    place, psi = WHEELS[name], manoeuvre.chassis.get("psi_start", 0.0)
    x = manoeuvre.chassis.get("X_start", 0.0) + place["x"] * cos(psi) - place["y"] * sin(psi)
    y = manoeuvre.chassis.get("Y_start", 0.0) + place["x"] * sin(psi) + place["y"] * cos(psi)
    return {"s": manoeuvre.s, **manoeuvre.road(), **upright(x, y, psi, manoeuvre.v, 0.0, R)}


def components(fmus: dict[str, Path], manoeuvre: Manoeuvre) -> list[Component]:
    """The FMUs of the car."""
    wheels = [Component(name, fmus["wheel"], wheel_start(manoeuvre, name)) for name in WHEELS]
    chassis = Component("chassis", fmus["chassis"], manoeuvre.chassis_start())
    return [*wheels, chassis, Component("driver", fmus["driver"], manoeuvre.driver_start())]


def system(fmus: dict[str, Path], manoeuvre: Manoeuvre, step: float = 0.001) -> System:
    """What car.ssp holds. A master that begins with zero inputs finds the chassis uncoupled for its first steps."""
    waiting = replace(manoeuvre, chassis={"t_couple": 3 * step, **manoeuvre.chassis})
    return System("car", components(fmus, waiting), CONNECTIONS, step, manoeuvre.stop)


@dataclass(frozen=True)
class Run:
    """Columns "component.variable" on a grid, those of chassis and driver by variable; how it ended, if early."""

    table: dict[str, np.ndarray]
    ending: Ended | None = None
    cost: dict[str, float] = field(default_factory=dict)  # us per step, as Master.cost has it


def drive(
    fmus: dict[str, Path],
    manoeuvre: Manoeuvre,
    step: float = 0.001,
    exchange: str = "derivatives",
    grid: float = 0.01,
    **how: bool,
) -> Run:
    """The coupled manoeuvre."""
    ending = None
    with Master(components(fmus, manoeuvre), CONNECTIONS) as master:
        try:
            master.run(manoeuvre.stop, step, RECORD, exchange, round(grid / step), **how)
        except Ended as end:
            ending = end
        return Run(columns(master.table()), ending, master.cost())


def whole(
    fmus: dict[str, Path], manoeuvre: Manoeuvre, step: float, exchange: str, grid: float
) -> dict[str, np.ndarray]:
    """The table of a manoeuvre; raises Ended where it does not reach its end."""
    run = drive(fmus, manoeuvre, step, exchange, grid)
    if run.ending:
        raise run.ending
    return run.table


def columns(table: np.ndarray) -> dict[str, np.ndarray]:
    """By name, those of chassis and driver without the component."""
    return {n.removeprefix("chassis.").removeprefix("driver."): table[n] for n in table.dtype.names}


def sentence(end: Ended) -> str:
    """Which wheel ended the run, and when."""
    name = f"{NAMES[end.component]} wheel" if end.component in WHEELS else end.component
    return f"The {name} ended the run at t = {end.time:.3f} s: {end.sentence}"


def title(run: Run, manoeuvre: Manoeuvre) -> str:
    """Of a picture: the manoeuvre, its speed, and what ended it early."""
    ended = f"; ended at {run.ending.time:.2f} s" if run.ending else ""
    slope = f", slope {100 * tan(manoeuvre.slope):.3g} %" if manoeuvre.slope else ""
    return f"Car: {manoeuvre.title}, from {3.6 * manoeuvre.v:.0f} km/h{slope}{ended}"


def missed(table: dict[str, np.ndarray], manoeuvre: Manoeuvre) -> str:
    """Where a run that reached its end is not the manoeuvre that it was to be; empty where it is."""
    path = manoeuvre.driver.get("path")
    off = float(np.abs(table["off"]).max())
    if path and off > OFF_PATH:
        return f"the car leaves its path by up to {off:.2g} m"
    goal = {**DRIVER_DEFAULTS, **manoeuvre.driver}
    end = 2 * pi if path == 1 else goal["x_back"] + 2 * goal["length"]
    if path and table["p"][-1] < end:
        return f"the run ends after {100 * max(table['p'][-1], 0) / end:.0f} % of the path"
    back = rolled_back(table)
    if manoeuvre.name == HILL.name and back > ROLL_BACK:
        return f"a wheel rolls back by {back:.3g} m"
    if manoeuvre.name in (STRAIGHT.name, HILL.name) and any(table[f"{w}.omega_z"][-1] for w in WHEELS):
        return f"the car does not stand at the end: it rolls at {table['v'][-1]:.2g} m/s"
    return ""


def rolled_back(table: dict[str, np.ndarray]) -> float:
    """How far a wheel's centre goes back at most from where it has been, m; along X."""
    return max(float((np.maximum.accumulate(x) - x).max()) for x in (table[f"{w}.X_O"] for w in WHEELS))


def demand(table: dict[str, np.ndarray]) -> dict[str, float]:
    """Largest mu_required of each wheel: the road on which the manoeuvre would have been possible."""
    return {w: float(np.nanmax(table[f"{w}.mu_required"])) for w in WHEELS}


def worst(table: dict[str, np.ndarray]) -> tuple[str, int]:
    """The wheel that asks most of the road, and the row in which it does."""
    asked = demand(table)
    wheel = max(asked, key=asked.get)
    return wheel, int(np.nanargmax(table[f"{wheel}.mu_required"]))


def verdict(run: Run, manoeuvre: Manoeuvre) -> list[str]:
    """What the run says of the manoeuvre: that it is none, or what it asks of the road."""
    table = run.table
    why = sentence(run.ending) if run.ending else missed(table, manoeuvre)
    if why:
        return [f"This is no {manoeuvre.title}: {why}" + ("" if why.endswith(".") else ".")]
    asked = demand(table)
    most = max(asked.values())
    each = ", ".join(f"{NAMES[w]} {mu:.2f}" for w, mu in asked.items())
    possible = "possible" if most <= DRY_ROAD else f"not possible even on a dry road, about {DRY_ROAD:g}, but"
    lines = [f"{manoeuvre.title}: {possible} on a road with a friction coefficient of {most:.2f} ({each})."]
    if manoeuvre.name == HILL.name:
        lines.append(f"No wheel rolls back by more than {1000 * rolled_back(table):.3g} mm.")
    least = min(WHEELS, key=lambda w: table[f"{w}.lambda_3"].min())
    lowest = table[f"{least}.lambda_3"].min()
    return [*lines, f"Smallest normal force: {lowest:.0f} N at the {NAMES[least]} wheel."]
