"""The car: chassis, driver and a wheel per strut, wired from the layout car/car.toml; the verdict on its manoeuvres.

Steering angles to the left; lateral acceleration and load in the words of ISO 8855. Each manoeuvre of
car/manoeuvres.toml is compared with closed forms (car_judges.py).
"""

from collections.abc import Iterator
from math import cos, pi, sin, tan

import numpy as np

from .car_judges import NAMES, RIGHT, WHEELS, R, constants, demand, findings, force, friction, per_axle, slid
from .options import Manoeuvre, file
from .vehicle import DRY_ROAD, Fmus, Table, Vehicle, road, upright

LIMITS = file("car")["limits"]


def starts(manoeuvre: Manoeuvre) -> dict[str, dict[str, float]]:
    """Of wheels and driver; the chassis starts at the origin unless its parameters say otherwise."""
    X, Y, psi, v = (manoeuvre[name] for name in ("X_start", "Y_start", "psi_start", "v"))
    found = {"driver": {"L": manoeuvre.given.get("L", constants(manoeuvre).wheelbase)}}
    for name in WHEELS:
        x, y = (manoeuvre[f"{axis}_{name}"] for axis in "xy")
        place = X + x * cos(psi) - y * sin(psi), Y + x * sin(psi) + y * cos(psi)
        found[name] = {"guided": True} | road(manoeuvre) | beneath(manoeuvre, name) | upright(*place, psi, v, 0.0, R)
    return found


def beneath(manoeuvre: Manoeuvre, wheel: str) -> dict[str, float]:
    """The friction of a right wheel's road where it is another."""
    of = {name: manoeuvre[f"{name}_right"] for name in ("mu_max", "mu_slide")} if wheel in RIGHT else {}
    return {name: value for name, value in of.items() if value}


def complete(table: Table, manoeuvre: Manoeuvre, _fmus: Fmus) -> Table:
    """With a_y, the acceleration of the whole car's centre of mass to the left of the heading [m/s2], from the ground's
    forces; beta, the sideslip angle of the chassis' centre of mass [rad], from differences of its place; and mu, the
    friction that each axle requires."""
    if len(table["time"]) < 3:
        return table
    back = np.exp(-1j * table["psi"])  # from X + i Y to along + i across
    pushed = back * (force(table, WHEELS, 1) + 1j * force(table, WHEELS, 2)) / constants(manoeuvre).mass
    moved = back * np.gradient(table["X"] + 1j * table["Y"], table["time"], edge_order=2)
    required = {f"{axle}.mu": mu for axle, mu in friction(table).items()}
    angles = {"a_y": pushed.imag, "beta": np.arctan2(moved.imag, np.abs(moved.real))}
    return table | angles | required


def subtitle(manoeuvre: Manoeuvre) -> str:
    """Of a picture."""
    slope = f", slope {100 * tan(manoeuvre['slope']):.3g} %" if manoeuvre["slope"] else ""
    return f", from {3.6 * manoeuvre['v']:.0f} km/h{slope}"


def rolled_back(table: Table) -> float:
    """How far a wheel's centre goes back at most from where it has been, m; along X."""
    return max(float((np.maximum.accumulate(x) - x).max()) for x in (table[f"{w}.X_O"] for w in WHEELS))


def failures(table: Table, manoeuvre: Manoeuvre) -> Iterator[str]:
    """Why a run is not the manoeuvre: parts of the driver's programme that it does not reach, and what must hold at its
    end, by the names of `ends` in manoeuvres.toml."""
    for size, begin, ramp in file("car")["programme"]:
        end = manoeuvre[begin] + manoeuvre[ramp]
        if manoeuvre.given.get(size) and manoeuvre.stop < end < LIMITS["never"]:
            yield f"the run ends at {manoeuvre.stop:g} s, before {begin} + {ramp} = {end:g} s"
    moved, back, off = float(np.ptp(table["X"])), rolled_back(table), float(np.abs(table["off"]).max())
    whole = 2 * pi if manoeuvre["path"] == 1 else manoeuvre["x_back"] + 2 * manoeuvre["length"]
    share, turned = table["p"][-1] / whole, float(np.abs(table["psi"]).max())
    moves = any(table[f"{w}.{n}"][-1] for w in WHEELS for n in ("omega_z", "slip_x", "slip_y"))
    found = {
        "sets_off": (moved < LIMITS["at_rest"], f"the car does not set off: it moves by {moved:.2g} m"),
        "stands": (moves, f"the car still moves at the end, at {table['v'][-1]:.2g} m/s"),
        "keeps_course": (turned > LIMITS["off_course"], f"the car turns by up to {np.degrees(turned):.0f} deg"),
        "does_not_roll_back": (back > LIMITS["roll_back"], f"a wheel rolls back by {back:.3g} m"),
        "on_path": (off > LIMITS["off_path"], f"the car leaves its path by up to {off:.2g} m"),
        "to_its_end": (share < 1, f"the run ends after {100 * max(share, 0):.0f} % of the path"),
        "lifts_off": (True, "no wheel lifts off"),
    }
    yield from (why for end, (fails, why) in found.items() if fails and end in manoeuvre.ends)


def grip(table: Table) -> float:
    """Of the axle that requires most."""
    return max(demand(table).values())


def verdict(table: Table, manoeuvre: Manoeuvre) -> tuple[bool, list[str]]:
    """Whether a run that reached its end is the manoeuvre, and the reason or its demand on the road."""
    most = grip(table)
    needs = f"needs a road with a friction coefficient of {most:.2f} (per axle: {per_axle(demand(table))})"
    slippery = [f"the manoeuvre {needs}; a dry road has about {DRY_ROAD:g}"] if most > DRY_ROAD else []
    if reasons := [*failures(table, manoeuvre), *slippery]:
        return False, [f"Failed: {reasons[0]}."]
    note = "The wheels of an axle are taken together: without slip, nothing but bushings shares its lateral force."
    if times := slid(table):
        needs, note = "slides at the " + ", the ".join(f"{NAMES[w]} wheel for {t:.2f} s" for w, t in times.items()), ""
    least, name = min((table[f"{w}.lambda_3"].min(), name) for w, name in NAMES.items())
    lowest = f"Smallest wheel load: {least:.0f} N at the {name} wheel."
    values, faults = findings(table, manoeuvre)
    head = [f"Failed: {fault}." for fault in faults[:1]] or [f"Possible: it {needs}.", *filter(None, [note])]
    return not faults, [*head, lowest, *values]


CAR = Vehicle("car", starts, verdict, wheels=NAMES, complete=complete, subtitle=subtitle, grip=grip)
