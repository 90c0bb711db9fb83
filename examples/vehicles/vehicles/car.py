"""The car: chassis, driver and a wheel per strut, wired from the layout car/car.toml; the verdict on its manoeuvres.

Steering angles to the left; lateral acceleration and load in the words of ISO 8855. Each manoeuvre of
car/manoeuvres.toml is judged by closed forms (car_judges.py) and by the same car as one set of equations.
"""

from math import cos, pi, sin, tan

import numpy as np

from .car_judges import axle_friction, demand, findings, force, per_axle
from .component import Component
from .layout import AXLES, MASS, NAMES, WHEELS, R, chassis_start, driver_start
from .options import Manoeuvre
from .vehicle import LOAD, POSE, Fmus, Table, Vehicle, recorded, road, upright, wire

CONNECTIONS = [
    *(c for w in WHEELS for c in wire("chassis", w, f"_{w}", (*POSE, "tau", "lambda_3"), (*LOAD, "M_brake"))),
    *((("chassis", name), ("driver", name)) for name in ("X_R", "Y_R", "psi", "v")),
    *((("driver", name), ("chassis", name)) for name in ("delta", "delta_dot", "M_drive", "M_brake")),
]
AT_REST = 0.5  # m: a car that moves less has not set off
ROLL_BACK = 1e-3  # m
OFF_PATH = 0.5  # m: farther from its path a car does not drive it
DRY_ROAD = 1.0  # friction coefficient of tyres on dry asphalt, about
# Of each part of the driver's programme: its size, when it begins, how long it takes.
PROGRAMME = (("delta_0", "t_delta", "ramp_delta"), ("M_0", "t_on", "ramp_M"), ("M_0", "t_off", "ramp_M"),
             ("B_0", "t_brake", "ramp_M"), ("B_hold", "t_release", "ramp_M"), ("v_1", "t_v", "ramp_v"))  # fmt: skip
NEVER = 1e6  # s, the default instant of a part that does not come


def parts(fmus: Fmus, manoeuvre: Manoeuvre) -> list[Component]:
    """Wheels, chassis and driver; the chassis starts at the origin unless its parameters say otherwise."""
    psi, wheels = manoeuvre["psi_start"], []
    for name in WHEELS:
        x, y = (manoeuvre[f"{axis}_{name}"] for axis in "xy")
        X = manoeuvre["X_start"] + x * cos(psi) - y * sin(psi)
        Y = manoeuvre["Y_start"] + x * sin(psi) + y * cos(psi)
        start = {**road(manoeuvre), **upright(X, Y, psi, manoeuvre["v"], 0.0, R)}
        wheels.append(Component(name, fmus["wheel"], start))
    bodies = {"chassis": chassis_start(manoeuvre), "driver": driver_start(manoeuvre)}
    return [*wheels, *(Component(name, fmus[name], start) for name, start in bodies.items())]


def complete(table: Table, _manoeuvre: Manoeuvre, _fmus: Fmus) -> Table:
    """With a_y, the acceleration of the whole car's centre of mass to the left of the heading [m/s2], from the ground's
    forces; beta, the sideslip angle of the chassis' centre of mass [rad], from differences of its place; and mu, the
    friction that each axle requires."""
    if len(table["time"]) < 3:
        return table
    c, s = np.cos(table["psi"]), np.sin(table["psi"])
    forces = [force(table, WHEELS, k) / MASS for k in (1, 2)]
    moved = [np.gradient(table[n], table["time"], edge_order=2) for n in ("X", "Y")]
    beta = np.arctan2(c * moved[1] - s * moved[0], np.abs(c * moved[0] + s * moved[1]))
    required = {f"{axle}.mu": axle_friction(table, axle) for axle in AXLES}
    return {**table, "a_y": c * forces[1] - s * forces[0], "beta": beta, **required}


def subtitle(manoeuvre: Manoeuvre) -> str:
    """Of a picture."""
    slope = f", slope {100 * tan(manoeuvre['slope']):.3g} %" if manoeuvre["slope"] else ""
    return f", from {3.6 * manoeuvre['v']:.0f} km/h{slope}"


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


def unmet(table: Table, manoeuvre: Manoeuvre) -> dict[str, str]:
    """Why a run is not to end as it did, by the names of `ends` in manoeuvres.toml; empty where it is."""
    moved, back, off = float(np.ptp(table["X"])), rolled_back(table), float(np.abs(table["off"]).max())
    whole = 2 * pi if manoeuvre["path"] == 1 else manoeuvre["x_back"] + 2 * manoeuvre["length"]
    share, rolls = table["p"][-1] / whole, any(table[f"{w}.omega_z"][-1] for w in WHEELS)
    found = {
        "sets_off": (moved < AT_REST, f"the car does not set off: it moves by {moved:.2g} m"),
        "stands": (rolls, f"the car does not stand at the end: it rolls at {table['v'][-1]:.2g} m/s"),
        "does_not_roll_back": (back > ROLL_BACK, f"a wheel rolls back by {back:.3g} m"),
        "on_path": (off > OFF_PATH, f"the car leaves its path by up to {off:.2g} m"),
        "to_its_end": (share < 1, f"the run ends after {100 * max(share, 0):.0f} % of the path"),
        "lifts_off": (True, "no wheel lifts off"),
    }
    return {end: why for end, (fails, why) in found.items() if fails}


def verdict(table: Table, manoeuvre: Manoeuvre) -> tuple[bool, list[str]]:
    """Whether a run that reached its end is the manoeuvre, and the reason or its demand on the road."""
    reasons = [reason for end, reason in unmet(table, manoeuvre).items() if end in manoeuvre.ends]
    if why := cut_short(manoeuvre) or next(iter(reasons), ""):
        return False, [f"Failed: {why}."]
    asked = demand(table)
    most = max(asked.values())
    needs = f"needs a road with a friction coefficient of {most:.2f} (per axle: {per_axle(asked)})"
    if most > DRY_ROAD:
        return False, [f"Failed: the manoeuvre {needs}; a dry road has about {DRY_ROAD:g}."]
    least = min(WHEELS, key=lambda w: table[f"{w}.lambda_3"].min())
    lowest = f"{table[f'{least}.lambda_3'].min():.0f} N at the {NAMES[least]} wheel"
    taken = "The wheels of an axle are taken together: without slip, nothing but bushings shares its lateral force."
    return True, [f"Possible: it {needs}.", taken, f"Smallest normal force: {lowest}.", *findings(table, manoeuvre)]


RECORD = recorded("car", WHEELS)
CAR = Vehicle("car", parts, CONNECTIONS, RECORD, verdict, NAMES, complete, waits=True, subtitle=subtitle)
drive = CAR.drive
