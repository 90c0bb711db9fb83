"""Energy that a coupling adds or takes, bond by bond.

A bond is an effort (force, moment) that a body hands to a wheel, and the flow (velocity, angular velocity) that the
wheel hands back. What the body gives is the integral of its own effort with the flow it was told; what the wheel
receives is that of the effort it was told with its own flow. The difference is what the coupling added. Both are taken
over each communication step with straight lines between the values at its ends.
"""

from __future__ import annotations

import numpy as np

from .component import Component, Values
from .hubs import FORCE
from .master import Connection, Master

BONDS = {
    **{name: f"{axis}_O_dot" for name, axis in zip(FORCE, "XYZ", strict=True)},
    "M_1": "theta_dot",
    "M_2": "psi_dot",
}


class BondMaster(Master):
    """A master that keeps count: `added[wheel]` is the energy added in each of BONDS so far, J."""

    def __init__(
        self, components: list[Component], connections: list[Connection], body: str, wheels: tuple[str, ...]
    ) -> None:
        super().__init__(components, connections)
        source = self.components[body]
        self.added = {wheel: np.zeros(len(BONDS)) for wheel in wheels}
        self.ends = {
            wheel: (Values(source, [f"{name}_{wheel}" for name in BONDS]), self._flows(wheel)) for wheel in wheels
        }

    def _flows(self, wheel: str) -> Values:
        return Values(self.components[wheel], list(BONDS.values()))

    def _step(self, t: float, h: float, rollback: bool, reject: bool) -> None:
        if rollback:
            raise ValueError("bonds are counted for held values and for derivatives.")
        begin = {}
        for wheel, (effort, flow) in self.ends.items():
            rates = np.zeros((2, len(BONDS)))
            if self.lines:
                rates[:] = effort.rates(), flow.rates()
            begin[wheel] = effort.get().copy(), flow.get().copy(), *rates
        super()._step(t, h, rollback, reject)
        for wheel, (effort, flow) in self.ends.items():
            e, f, e_dot, f_dot = begin[wheel]
            received = h * product(e, e + h * e_dot, f, flow.get())
            self.added[wheel] += received - h * product(e, effort.get(), f, f + h * f_dot)

    def count(self, stop: float, step: float, exchange: str) -> dict[str, np.ndarray]:
        """Runs, and gives the energy added by bond and wheel."""
        self.lines = exchange == "derivatives"
        self.table_of = self.run(stop, step, [], exchange)
        return self.added


def product(a0: np.ndarray, a1: np.ndarray, b0: np.ndarray, b1: np.ndarray) -> np.ndarray:
    """Mean of the product of two straight lines."""
    return (2 * a0 * b0 + a0 * b1 + a1 * b0 + 2 * a1 * b1) / 6
