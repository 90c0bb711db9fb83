"""The columns of a solution: the outputs of the contract, energy, work and residuals.

Fixed axes for positions, velocities and reactions; Euler angles read from the attitude.
"""

from dataclasses import dataclass
from math import atan2, hypot, nan, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .frames import cross, slope, to_fixed
from .modes import GRIPS, Contacts, Mode
from .motion import State, angle_rates
from .newton_euler import arm


class Row(NamedTuple):
    """One reported instant."""

    t: float
    y: State
    mode: Mode


class Ending(NamedTuple):
    """Why and when a run ended before its last time: kind is "flat", "lift-off" or "jams"."""

    kind: str
    time: float


@dataclass(frozen=True)
class Solution:
    """Columns by name (solution["X_O"]), transitions and ending.

    events: (t, mode) of the exact law, the first at the start; mode is the sign of omega_z, 0 held.
    contacts: (t, 1 slides or 0 grips), the first at the start; a second 1 goes on in another direction at once.
    work_inputs, work_friction, work_sliding: J since the start.  residual_velocity, residual_height:
    |v_O - w x p - u| (m/s), Z_O less the height of O above its contact (m).
    """

    t: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]
    events: list[tuple[float, int]]
    ended: Ending | None
    contacts: list[tuple[float, int]]

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]


def _turned(angle: float, near: float) -> float:
    """The angle shifted by whole turns to the one next to `near`."""
    return angle + 2 * pi * round((near - angle) / (2 * pi))


def _values(contacts: Contacts, state: State, mode: Mode) -> dict[str, float]:
    y, wheel = state.tolist(), contacts.wheel
    now = contacts.now(mode, state)
    n, w, v = now.R[2], (y[4], y[5], y[6]), y[10:13]
    ux, uy, s = slope(n)
    line = to_fixed(now.R, (uy, -ux, 0.0))
    psi_dot, theta_dot, phi_dot = angle_rates(n, w)
    p = arm(wheel, n)
    u = contacts.slip(mode, state)
    gap = [a - b for a, b in zip(v, to_fixed(now.R, cross(w, p)), strict=True)]
    X, Y, N = now.force
    spin = wheel.J_x * w[0] ** 2 + wheel.J_y * w[1] ** 2 + wheel.J_z * w[2] ** 2
    watched = contacts.watched(mode.ground)
    return {
        **dict(zip(("X_O", "Y_O", "Z_O"), y[7:10], strict=True)),
        **dict(zip(("X_O_dot", "Y_O_dot", "Z_O_dot"), v, strict=True)),
        "psi": _turned(atan2(line[1], line[0]), y[13]),
        "theta": atan2(s, n[2]),
        "phi": _turned(atan2(ux, uy), y[14]),
        **{"psi_dot": psi_dot, "theta_dot": theta_dot, "phi_dot": phi_dot},
        **{"omega_z": w[2], "tau": now.tau, "lambda_1": X, "lambda_2": Y, "lambda_3": N},
        **{"lambda_x": X * line[0] + Y * line[1], "lambda_y": Y * line[0] - X * line[1]},
        **{"slip_x": u[0] * line[0] + u[1] * line[1], "slip_y": u[1] * line[0] - u[0] * line[1]},
        "contact_mode": int(mode.contact != GRIPS),
        "friction_mode": mode.sigma if watched else np.sign(w[2]),
        "mu_required": hypot(X, Y) / (N or nan),
        "E": (wheel.m * sum(c * c for c in v) + spin) / 2
        - wheel.m * sum(a * b for a, b in zip(wheel.gravity, y[7:10], strict=True)),
        **{"work_inputs": y[15], "work_friction": y[16], "work_sliding": y[17]},
        "residual_velocity": hypot(gap[0] - u[0], gap[1] - u[1], gap[2]),
        "residual_height": y[9] - to_fixed(now.R, p)[2],
    }


def solution(contacts: Contacts, rows: list[Row], events: list, ended: Ending | None, slides: list) -> Solution:
    """Of the recorded rows and transitions."""
    table = [_values(contacts, row.y, row.mode) for row in rows]
    columns = {name: np.array([line[name] for line in table], dtype=float) for name in table[0]}
    return Solution(np.array([row.t for row in rows]), columns, events, ended, slides)
