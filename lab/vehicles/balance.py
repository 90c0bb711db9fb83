"""Driven wheel: a controller FMU keeps a wheel upright along a line and then a circle; alone it falls over.

The wheel rolls at 2 rad/s (0.7 m/s), below the speed at which upright rolling is stable, with rolling friction, and
starts with a small push to the side. Fixed axes; theta is 90 degrees upright.
"""

from math import inf, pi

import numpy as np
from fmpy import simulate_fmu

from .options import Manoeuvre, file, manoeuvres
from .vehicle import Fmus, Table, Vehicle, road

CIRCLE = manoeuvres("balance")["circle"]
T_CIRCLE, RADIUS, SPEED = CIRCLE["t_circle"], CIRCLE["R"], 0.7  # s, m, m/s
TURN = 2 * pi * RADIUS / SPEED  # s
# theta_dot_start is the push.
START = {"psi_start": 0, "theta_start": pi / 2, "phi_dot_start": -2, "theta_dot_start": 0.1, "X_O_start": 0}
OF_WHEEL = file("balance")["record"][0][1:]  # the columns of the wheel


def beside_alone(table: Table, course: Manoeuvre, fmus: Fmus) -> Table:
    """With the wheel without the controller, up to where its run ends, in columns alone.NAME."""
    rows, how = len(table["time"]), {"fmi_type": "CoSimulation", "output": OF_WHEEL, "output_interval": course.grid}
    how["start_values"] = START | road(course)
    alone = simulate_fmu(str(fmus["wheel"]), stop_time=course.stop, **how)[:rows]
    return table | {f"alone.{n}": np.pad(alone[n], (0, rows - len(alone)), constant_values=np.nan) for n in OF_WHEEL}


def fall_time(table: Table, of: str = "") -> float:
    """When the wheel first leans by more than 45 degrees, s; infinite if never."""
    fallen = np.abs(table[f"{of}theta"] - pi / 2) > pi / 4
    return float(table["time"][fallen.argmax()]) if fallen.any() else inf


def judge(table: Table) -> dict[str, float]:
    """The figures of a run: on the line in its last second, on the circle in its last turn."""
    t, tilt = table["time"], np.degrees(np.abs(table["theta"] - pi / 2))
    line, turn = (t > T_CIRCLE - 1) & (t <= T_CIRCLE), t > CIRCLE.stop - TURN
    x, y = table["X_O"][turn], table["Y_O"][turn]
    a, b, c = np.linalg.lstsq(np.column_stack([x, y, np.ones_like(x)]), x**2 + y**2, rcond=None)[0]
    radius = np.sqrt(c + (a**2 + b**2) / 4)
    return {
        "fall": fall_time(table, "alone."),
        "line_tilt": tilt[line].max(),  # deg, largest deviation from upright
        "line_heading": np.degrees(np.abs(table["psi"][line])).max(),  # deg, from the line's direction
        "circle_radius": radius,  # m, of the circle through the last turn
        "circle_scatter": np.abs(np.hypot(x - a / 2, y - b / 2) - radius).max(),  # m, from that circle
        "circle_tilt": tilt[t > T_CIRCLE].max(),  # deg, from upright on the whole circle
        "speed_error": np.abs(table["omega_z"][turn] + 2).max(),  # rad/s, of omega_z from -2
    }


def verdict(table: Table, course: Manoeuvre) -> tuple[bool, list[str]]:
    """Of the wheel alone, and of the one that was to drive a circle."""
    wanted, leans = course["R"], "leans over by more than 45 degrees after"
    single, fall = f"Alone it {leans} {fall_time(table, 'alone.'):.2f} s.", fall_time(table)
    if np.isfinite(fall):
        return False, [single, f"Failed: the controller does not hold it: it {leans} {fall:.2f} s."]
    found = judge(table)
    radius, scatter, tilt = (found[f"circle_{name}"] for name in ("radius", "scatter", "tilt"))
    held = f"leaning by up to {tilt:.1f} degrees; its last turn is within {scatter:.2g} m of a circle of {radius:.4g} m"
    if max(abs(radius - wanted), scatter) < 0.05 * wanted:
        return True, [single, f"Controlled it stays up, {held}; {wanted:g} m was set."]
    return False, [single, f"Failed: the controller keeps it from falling over, {held}, not of {wanted:g} m."]


BALANCE = Vehicle("balance", lambda course: {"wheel": START | road(course)}, verdict, complete=beside_alone)


def drive(fmus: Fmus, course: Manoeuvre = CIRCLE) -> Table:
    """Both runs as the example takes them."""
    return BALANCE.drive(fmus, course).table
