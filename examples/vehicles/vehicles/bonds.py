"""Energy that a coupling adds or takes, bond by bond.

A bond is an effort (force, moment) that a body hands to a wheel, and the flow (velocity, angular velocity) that the
wheel hands back. What the body gives is the integral of its own effort with the flow it was told; what the wheel
receives is that of the effort it was told with its own flow. The difference is what the coupling added. Both are taken
over each communication step with straight lines between the values at its ends.
"""

from __future__ import annotations

import numpy as np

from .hubs import FORCE
from .master import KINDS, Signal

BONDS = {
    **{name: f"{axis}_O_dot" for name, axis in zip(FORCE, "XYZ", strict=True)},
    "M_1": "theta_dot",
    "M_2": "psi_dot",
}


def _signals(body: str, wheel: str, bond: str, kind: str) -> tuple[Signal, Signal]:
    """Effort and flow: at the begin of each step, their rates there, or at its end."""
    before = "" if kind == "value" else f"{kind} "
    return (body, f"{before}{bond}_{wheel}"), (wheel, f"{before}{BONDS[bond]}")


def record(body: str, wheels: tuple[str, ...]) -> list[Signal]:
    """What a master has to record at every step."""
    return [s for w in wheels for bond in BONDS for kind in KINDS for s in _signals(body, w, bond, kind)]


def added(table: np.ndarray, body: str, wheels: tuple[str, ...], step: float, lines: bool) -> dict[str, np.ndarray]:
    """The energy added in each of BONDS, J, by wheel; lines: inputs go on straight lines, else they are held."""

    def both(wheel: str, bond: str, kind: str) -> list[np.ndarray]:
        return [table[".".join(signal)][:-1] for signal in _signals(body, wheel, bond, kind)]

    found = {wheel: np.zeros(len(BONDS)) for wheel in wheels}
    for wheel in wheels:
        for k, bond in enumerate(BONDS):
            (e, f), (e_dot, f_dot), (e_end, f_end) = (both(wheel, bond, kind) for kind in KINDS)
            h = step * lines
            received, given = product(e, e + h * e_dot, f, f_end), product(e, e_end, f, f + h * f_dot)
            found[wheel][k] = step * float((received - given).sum())
    return found


def product(a0: np.ndarray, a1: np.ndarray, b0: np.ndarray, b1: np.ndarray) -> np.ndarray:
    """Mean of the product of two straight lines."""
    return (2 * a0 * b0 + a0 * b1 + a1 * b0 + 2 * a1 * b1) / 6
