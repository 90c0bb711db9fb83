"""The columns of a solution: the outputs of the contract, energy, work and residuals.

Fixed axes for positions, velocities and reactions; Euler angles read from the attitude.
"""

from dataclasses import dataclass
from math import atan2, hypot, nan, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .frames import cross, slope, to_fixed
from .motion import OMEGA_Z, State, angle_rates, respond
from .newton_euler import arm, axle_moment
from .switching import Mode, Switch


class Row(NamedTuple):
    """One reported instant."""

    t: float
    y: State
    mode: Mode


class Ending(NamedTuple):
    """Why and when a run ended before its last time: kind is "flat" or "lift-off"."""

    kind: str
    time: float


@dataclass(frozen=True)
class Solution:
    """Columns by name (solution["X_O"]), transitions and ending.

    events: (t, mode) of the exact law, the first at the start; mode is the sign of omega_z, 0 held.
    work_inputs, work_friction: J since the start.  residual_velocity, residual_height: |v_O - w x p| (m/s), Z_O less
    the height of O above its contact (m).
    """

    t: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]
    events: list[tuple[float, int]]
    ended: Ending | None

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        return self.columns[name]


def _turned(angle: float, near: float) -> float:
    """The angle shifted by whole turns to the one next to `near`."""
    return angle + 2 * pi * round((near - angle) / (2 * pi))


def _row(switch: Switch, row: Row) -> dict[str, float]:
    t, state, mode = row
    y = state.tolist()
    wheel = switch.contact.wheel
    R, answer = respond(switch.contact, switch.inputs, t, y)
    n, w, v = R[2], tuple(y[4:7]), y[10:13]
    tau = axle_moment(switch.law(mode, t), answer)
    ground = tuple(b + tau * u for b, u in zip(answer.base[6:9], answer.unit[6:9], strict=True))
    reaction = to_fixed(R, ground)
    ux, uy, s = slope(n)
    line = to_fixed(R, (uy, -ux, 0.0))
    psi_dot, theta_dot, phi_dot = angle_rates(n, w)
    p = arm(wheel, n)
    slip = [a - b for a, b in zip(v, to_fixed(R, cross(w, p)), strict=True)]
    spin = wheel.J_x * w[0] ** 2 + wheel.J_y * w[1] ** 2 + wheel.J_z * w[2] ** 2
    return {
        **dict(zip(("X_O", "Y_O", "Z_O"), y[7:10], strict=True)),
        **dict(zip(("X_O_dot", "Y_O_dot", "Z_O_dot"), v, strict=True)),
        "psi": _turned(atan2(line[1], line[0]), y[13]),
        "theta": atan2(s, n[2]),
        "phi": _turned(atan2(ux, uy), y[14]),
        **{"psi_dot": psi_dot, "theta_dot": theta_dot, "phi_dot": phi_dot},
        **dict(zip(("omega_z", "tau", "work_inputs", "work_friction"), (w[2], tau, y[15], y[16]), strict=True)),
        **dict(zip(("lambda_1", "lambda_2", "lambda_3"), reaction, strict=True)),
        "E": (wheel.m * sum(c * c for c in v) + spin) / 2
        - wheel.m * sum(a * b for a, b in zip(wheel.gravity, y[7:10], strict=True)),
        "mu_required": hypot(reaction[0], reaction[1]) / (reaction[2] or nan),
        "friction_mode": mode.sigma if switch.watched(mode.ground) else np.sign(y[OMEGA_Z]),
        "residual_velocity": hypot(*slip),
        "residual_height": y[9] - to_fixed(R, p)[2],
    }


def build(switch: Switch, rows: list[Row], events: list[tuple[float, int]], ended: Ending | None) -> Solution:
    """The solution of the recorded rows."""
    table = [_row(switch, row) for row in rows]
    columns = {name: np.array([line[name] for line in table], dtype=float) for name in table[0]}
    return Solution(np.array([row.t for row in rows]), columns, events, ended)
