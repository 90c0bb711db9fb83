"""A vehicle: FMUs that are wired, and what is recorded of their run, added to it, and judged.

A body with hubs names its variables as the wheels do, with _ and the wheel's name behind.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from math import pi
from pathlib import Path

import numpy as np

from . import ssp
from .component import Component, Ended, loaded
from .master import Connection, Master, Signal
from .options import Manoeuvre, file

Fmus = dict[str, Path]
Table = dict[str, np.ndarray]
Names = tuple[str, ...]
POSE = ("X_O", "Y_O", "Z_O", "X_O_dot", "Y_O_dot", "Z_O_dot", "psi", "theta", "psi_dot", "theta_dot")
FORCE = ("F_X", "F_Y", "F_Z")
LOAD = (*FORCE, "M_1", "M_2", "M_3")


@dataclass(frozen=True)
class Run:
    """Columns on a grid; how it ended, if early; microseconds per step, as Master.cost has it."""

    table: Table
    ending: Ended | None
    cost: dict[str, float]

    @property
    def whole(self) -> Table:
        """The table of a run that reached its end; raises Ended for another."""
        if self.ending:
            raise self.ending
        return self.table


@dataclass(frozen=True)
class Vehicle:
    """`name`: of its package; `wheels`: what pictures call the components that are wheels, whose columns are
    "wheel.variable"; other components' columns go by the variable's name alone."""

    name: str
    parts: Callable[[Fmus, Manoeuvre], list[Component]]
    connections: list[Connection]
    record: list[Signal]
    verdict: Callable[[Table, Manoeuvre], tuple[bool, list[str]]]  # of a run that reached its end
    wheels: dict[str, str] = field(default_factory=dict)
    complete: Callable[[Table, Manoeuvre, Fmus], Table] = lambda table, _manoeuvre, _fmus: table
    tracks: dict[str, Names] = field(default_factory=dict)  # besides those of the wheels: label, columns of X and Y
    waits: bool = False  # whether a package sets t_couple
    subtitle: Callable[[Manoeuvre], str] = lambda _manoeuvre: ""

    def drive(
        self, fmus: Fmus, of: Manoeuvre, h: float = 1e-3, exchange: str = "derivatives", grid: float = 0.01, **how: bool
    ) -> Run:
        """The co-simulation, recorded every `grid`, or every step, to its end or to where a component ends it; with the
        columns that `complete` adds."""
        components, rows, ending = self.parts(fmus, of), [], None
        with loaded(*components):
            master = Master(components, self.connections)
            try:
                for t in master.steps(of.stop, h, exchange, max(1, round(grid / h)), **how):
                    rows.append([t, *master.read(self.record)])
            except Ended as end:
                ending = end
            cost = master.cost()
        names = ["time", *(f"{part}.{name}" if part in self.wheels else name for part, name in self.record)]
        columns = np.reshape(rows, (-1, len(names))).T
        return Run(self.complete(dict(zip(names, columns, strict=True)), of, fmus), ending, cost)

    def package(self, fmus: Fmus, manoeuvre: Manoeuvre, step: float, folder: Path) -> Path:
        """Its SSP package. A master that begins with zero inputs finds the body free until t_couple."""
        waits = {"t_couple": 3 * step} if self.waits and "t_couple" not in manoeuvre.given else {}
        parts = self.parts(fmus, manoeuvre.changed(**waits))
        return ssp.build(folder / f"{self.name}.ssp", parts, self.connections, step, manoeuvre.stop)

    def describe(self, end: Ended) -> str:
        """Which component ended a run, and when."""
        who = f"{self.wheels[end.component]} wheel" if end.component in self.wheels else end.component
        return f"The {who} ended the run at t = {end.time:.3f} s: {end.message}"


def recorded(vehicle: str, wheels: Iterable[str] = ()) -> list[Signal]:
    """The signals that manoeuvres.toml lists by component; a row with {wheel} stands for one row per wheel."""
    rows = [(row, w) for row in file(vehicle)["record"] for w in (wheels if "{wheel}" in "".join(row) else [""])]
    return [(part.format(wheel=w), name.format(wheel=w)) for (part, *names), w in rows for name in names]


def wire(body: str, wheel: str, behind: str, pose: Names = POSE, load: Names = LOAD) -> list[Connection]:
    """Pose and velocity to the body, forces and moments to the wheel; `behind` ends the body's names."""
    return [
        *(((wheel, name), (body, name + behind)) for name in pose),
        *(((body, name + behind), (wheel, name)) for name in load),
    ]


def upright(x: float, y: float, heading: float, speed: float, turn: float, R: float) -> dict[str, float]:
    """Start of an upright wheel that rolls at `speed` [m/s] along its heading [rad] and turns at `turn` [rad/s]."""
    pose = {"psi_start": heading, "theta_start": pi / 2, "X_O_start": x, "Y_O_start": y}
    return {**pose, "phi_dot_start": -speed / R, "psi_dot_start": turn, "theta_dot_start": 0.0}


def road(manoeuvre: Manoeuvre) -> dict[str, float]:
    """The wheels' parameters that a manoeuvre gives: friction, slope, and the grip that a wheel checks, if any."""
    names = ("s", "slope", "slope_direction", "mu_max")
    return {name: manoeuvre[name] for name in names if manoeuvre.given.get(name)}
