"""The car: chassis, driver and a wheel per strut, wired from the layout car/car.toml; the verdict on its manoeuvres.

Steering angles to the left; lateral acceleration and load in the words of ISO 8855. Each manoeuvre of
car/manoeuvres.toml is judged by closed forms (car_judges.py) and by the same car as one set of equations.
"""

from __future__ import annotations

import tomllib
from functools import partial
from math import cos, pi, sin, tan
from pathlib import Path

import numpy as np

from . import component
from .component import Component
from .hubs import FORCE, MOMENT, POSE, road, upright, wire
from .master import Connection, Run, Signal, System, simulate
from .options import EXAMPLES, Manoeuvre, manoeuvres

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
AT_REST = 0.5  # m: a car that moves less has not set off
ROLL_BACK = 1e-3  # m
OFF_PATH = 0.5  # m: farther from its path a car does not drive it
DRY_ROAD = 1.0  # friction coefficient of tyres on dry asphalt, about
COMPARED = ("X", "Y", "psi", "roll", "pitch", "v", "omega")
MANOEUVRES = manoeuvres("car")
STRAIGHT, CIRCLE, STEP, EIGHT, LANE, HILL, TOO_FAST = MANOEUVRES.values()
# Of each part of the driver's programme: its size, when it begins, how long it takes.
PROGRAMME = (("delta_0", "t_delta", "ramp_delta"), ("M_0", "t_on", "ramp_M"), ("M_0", "t_off", "ramp_M"),
             ("B_0", "t_brake", "ramp_M"), ("B_hold", "t_release", "ramp_M"), ("v_1", "t_v", "ramp_v"))  # fmt: skip
NEVER = 1e6  # s, the default instant of a part that does not come
Table = dict[str, np.ndarray]


def axles() -> dict[str, list[str]]:
    """Wheels that stand side by side, by the axle's name."""
    places = sorted({float(w["x"]) for w in WHEELS.values()}, reverse=True)
    names = {places[-1]: "rear", places[0]: "front"}
    return {names.get(x, f"axle {k + 1}"): [n for n, w in WHEELS.items() if w["x"] == x] for k, x in enumerate(places)}


AXLES = axles()


def chassis_start(manoeuvre: Manoeuvre) -> dict[str, float]:
    """Parameters of chassis.fmu."""
    return {"v_start": manoeuvre["v"], **manoeuvre.of("chassis")}


def driver_start(manoeuvre: Manoeuvre) -> dict[str, float]:
    """Parameters of driver.fmu."""
    return {"v_0": manoeuvre["v"], "v_1": manoeuvre["v"], "L": WHEELBASE, **manoeuvre.of("driver")}


def wheel_start(manoeuvre: Manoeuvre, name: str) -> dict[str, float]:
    """Parameters of a wheel.fmu; the chassis starts at the origin unless its parameters say otherwise."""
    (x, y), psi = (manoeuvre[f"{axis}_{name}"] for axis in "xy"), manoeuvre["psi_start"]
    X = manoeuvre["X_start"] + x * cos(psi) - y * sin(psi)
    Y = manoeuvre["Y_start"] + x * sin(psi) + y * cos(psi)
    return {**road(manoeuvre), **upright(X, Y, psi, manoeuvre["v"], 0.0, R)}


def system(fmus: dict[str, Path], manoeuvre: Manoeuvre, step: float = 0.001, t_couple: float | None = None) -> System:
    """The car. A master that begins with zero inputs, as that of a package, finds the chassis free until t_couple."""
    wheels = [Component(name, fmus["wheel"], wheel_start(manoeuvre, name)) for name in WHEELS]
    start = {**({"t_couple": t_couple} if t_couple else {}), **chassis_start(manoeuvre)}
    bodies = Component("chassis", fmus["chassis"], start), Component("driver", fmus["driver"], driver_start(manoeuvre))
    return System("car", [*wheels, *bodies], CONNECTIONS, step, manoeuvre.stop, ("chassis", "driver"))


def package(fmus: dict[str, Path], manoeuvre: Manoeuvre, step: float = 0.0005) -> System:
    """The content of car.ssp."""
    return system(fmus, manoeuvre, step, 3 * step)


def drive(
    fmus: dict[str, Path],
    manoeuvre: Manoeuvre,
    step: float = 0.001,
    exchange: str = "derivatives",
    grid: float = 0.01,
    **how: bool,
) -> Run:
    """The coupled manoeuvre."""
    run = simulate(system(fmus, manoeuvre, step), RECORD, exchange, grid, **how)
    return Run(complete(run.table, manoeuvre), run.ending, run.cost)


run = drive


sentence = partial(component.sentence, names=NAMES)


def complete(table: Table, _manoeuvre: Manoeuvre) -> Table:
    """With a_y, the acceleration of the whole car's centre of mass to the left of the heading [m/s2], from the ground's
    forces; beta, the sideslip angle of the chassis' centre of mass [rad], from differences of its place; and mu, the
    friction that each axle requires."""
    if len(table["time"]) < 3:
        return table
    c, s = np.cos(table["psi"]), np.sin(table["psi"])
    forces = [sum(table[f"{w}.lambda_{k}"] for w in WHEELS) / MASS for k in (1, 2)]
    moved = [np.gradient(table[n], table["time"], edge_order=2) for n in ("X", "Y")]
    beta = np.arctan2(c * moved[1] - s * moved[0], np.abs(c * moved[0] + s * moved[1]))
    required = {f"{axle}.mu": axle_friction(table, axle) for axle in AXLES}
    return {**table, "a_y": c * forces[1] - s * forces[0], "beta": beta, **required}


def axle_friction(table: Table, axle: str) -> np.ndarray:
    """Horizontal over normal force of an axle's wheels together: wheels that never slip are redundant across, and only
    the bushings decide which of them carries the lateral force."""
    force = [sum(table[f"{w}.lambda_{k}"] for w in AXLES[axle]) for k in (1, 2, 3)]
    return np.hypot(force[0], force[1]) / force[2]


def demand(table: Table) -> dict[str, float]:
    """Largest friction coefficient that each axle requires: the road on which the manoeuvre would be possible."""
    return {axle: float(np.nanmax(axle_friction(table, axle))) for axle in AXLES}


def worst(table: Table) -> tuple[str, int]:
    """The axle that requires most of the road, and the row in which it does."""
    asked = demand(table)
    axle = max(asked, key=asked.get)
    return axle, int(np.nanargmax(axle_friction(table, axle)))


def title(manoeuvre: Manoeuvre) -> str:
    """Of a picture."""
    slope = f", slope {100 * tan(manoeuvre['slope']):.3g} %" if manoeuvre["slope"] else ""
    return f"Car: {manoeuvre.title}, from {3.6 * manoeuvre['v']:.0f} km/h{slope}"


def tracks(_table: Table) -> dict[str, tuple[np.ndarray, ...]]:
    """Paths besides those of the wheels: none."""
    return {}


def rolled_back(table: Table) -> float:
    """How far a wheel's centre goes back at most from where it has been, m; along X."""
    return max(float((np.maximum.accumulate(x) - x).max()) for x in (table[f"{w}.X_O"] for w in WHEELS))


def cut_short(manoeuvre: Manoeuvre) -> str:
    """The part of the driver's programme that the run does not reach; empty where it covers all."""
    for size, begin, ramp in PROGRAMME:
        end = manoeuvre[begin] + manoeuvre[ramp]
        if manoeuvre[size] and manoeuvre.stop < end < NEVER:
            return f"the run ends at {manoeuvre.stop:g} s, before {begin} + {ramp} = {end:g} s"
    return ""


def sets_off(table: Table, _manoeuvre: Manoeuvre) -> str:
    moved = float(np.ptp(table["X"]))
    return f"the car does not set off: it moves by {moved:.2g} m" if moved < AT_REST else ""


def stands(table: Table, _manoeuvre: Manoeuvre) -> str:
    rolls = any(table[f"{w}.omega_z"][-1] for w in WHEELS)
    return f"the car does not stand at the end: it rolls at {table['v'][-1]:.2g} m/s" if rolls else ""


def does_not_roll_back(table: Table, _manoeuvre: Manoeuvre) -> str:
    back = rolled_back(table)
    return f"a wheel rolls back by {back:.3g} m" if back > ROLL_BACK else ""


def on_path(table: Table, manoeuvre: Manoeuvre) -> str:
    off, end = float(np.abs(table["off"]).max()), manoeuvre["x_back"] + 2 * manoeuvre["length"]
    share = table["p"][-1] / (2 * pi if manoeuvre["path"] == 1 else end)
    if off > OFF_PATH:
        return f"the car leaves its path by up to {off:.2g} m"
    return f"the run ends after {100 * max(share, 0):.0f} % of the path" if share < 1 else ""


def lifts_off(_table: Table, _manoeuvre: Manoeuvre) -> str:
    return "no wheel lifts off"


ENDS = {f.__name__: f for f in (sets_off, stands, does_not_roll_back, on_path, lifts_off)}


def missed(table: Table, manoeuvre: Manoeuvre) -> str:
    """Where a run that reached its end is not the manoeuvre that it was to be; empty where it is."""
    return cut_short(manoeuvre) or next(filter(None, (ENDS[name](table, manoeuvre) for name in manoeuvre.ends)), "")


def verdict(table: Table, manoeuvre: Manoeuvre) -> tuple[bool, list[str]]:
    """Whether a run that reached its end is the manoeuvre, and the reason or its demand on the road."""
    if why := missed(table, manoeuvre):
        return False, [f"Failed: {why}."]
    asked = demand(table)
    most = max(asked.values())
    each = ", ".join(f"{axle} {mu:.2f}" for axle, mu in asked.items())
    needs = f"needs a road with a friction coefficient of {most:.2f} (per axle: {each})"
    if most > DRY_ROAD:
        return False, [f"Failed: the manoeuvre {needs}; a dry road has about {DRY_ROAD:g}."]
    least = min(WHEELS, key=lambda w: table[f"{w}.lambda_3"].min())
    lowest = f"{table[f'{least}.lambda_3'].min():.0f} N at the {NAMES[least]} wheel"
    taken = "The wheels of an axle are taken together: without slip, nothing but bushings shares its lateral force."
    return True, [f"Possible: it {needs}.", taken, f"Smallest normal force: {lowest}."]
