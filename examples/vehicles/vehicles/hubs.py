"""How a wheel is wired to a body with hubs: the body's names are the wheel's with the wheel's name behind."""

from __future__ import annotations

from math import pi

from .master import Connection
from .options import Manoeuvre

POSE = ("X_O", "Y_O", "Z_O", "X_O_dot", "Y_O_dot", "Z_O_dot", "psi", "theta", "psi_dot", "theta_dot")
FORCE = ("F_X", "F_Y", "F_Z")
MOMENT = ("M_1", "M_2", "M_3")


def wire(
    body: str, wheel: str, pose: tuple[str, ...] = POSE, load: tuple[str, ...] = FORCE + MOMENT
) -> list[Connection]:
    """Pose and velocity to the body, forces and moments to the wheel."""
    return [
        *(((wheel, name), (body, f"{name}_{wheel}")) for name in pose),
        *(((body, f"{name}_{wheel}"), (wheel, name)) for name in load),
    ]


def upright(x: float, y: float, heading: float, speed: float, turn: float, R: float) -> dict[str, float]:
    """Start of an upright wheel that rolls at `speed` [m/s] along its heading [rad] and turns at `turn` [rad/s]."""
    pose = {"psi_start": heading, "theta_start": pi / 2, "X_O_start": x, "Y_O_start": y}
    return {**pose, "phi_dot_start": -speed / R, "psi_dot_start": turn, "theta_dot_start": 0.0}


def road(manoeuvre: Manoeuvre) -> dict[str, float]:
    """The wheels' parameters that a manoeuvre gives: friction, slope, and the grip that a wheel checks, if any."""
    names = ("s", "slope", "slope_direction", "mu_max")
    return {name: manoeuvre[name] for name in names if manoeuvre.given.get(name)}
