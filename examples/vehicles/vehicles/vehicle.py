"""A vehicle: FMUs that are wired, and what is recorded of their run, added to it, and judged.

A body with hubs names its variables as the wheels do, with _ and the wheel's name behind.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import pi
from pathlib import Path

from . import ssp
from .component import Component, Ended
from .master import Connection, Run, Signal, Table, simulate
from .options import Manoeuvre

Fmus = dict[str, Path]
POSE = ("X_O", "Y_O", "Z_O", "X_O_dot", "Y_O_dot", "Z_O_dot", "psi", "theta", "psi_dot", "theta_dot")
FORCE = ("F_X", "F_Y", "F_Z")
LOAD = (*FORCE, "M_1", "M_2", "M_3")


@dataclass(frozen=True)
class Vehicle:
    """`name`: of its package; `wheels`: what pictures call the components that are wheels; `bare`: components whose
    columns go by the variable's name alone."""

    name: str
    parts: Callable[[Fmus, Manoeuvre], list[Component]]
    connections: list[Connection]
    record: list[Signal]
    verdict: Callable[[Table, Manoeuvre], tuple[bool, list[str]]]  # of a run that reached its end
    bare: tuple[str, ...]
    wheels: dict[str, str] = field(default_factory=dict)
    complete: Callable[[Table, Manoeuvre, Fmus], Table] = lambda table, _manoeuvre, _fmus: table
    tracks: Callable[[Table], dict[str, tuple]] = lambda _table: {}  # besides those of the wheels
    waits: bool = False  # whether a package sets t_couple
    subtitle: Callable[[Manoeuvre], str] = lambda _manoeuvre: ""

    def drive(
        self,
        fmus: Fmus,
        manoeuvre: Manoeuvre,
        step: float = 0.001,
        exchange: str = "derivatives",
        grid: float = 0.01,
        **how: bool,
    ) -> Run:
        """The co-simulation, with the columns that `complete` adds."""
        wired = self.parts(fmus, manoeuvre), self.connections
        run = simulate(*wired, self.record, manoeuvre.stop, step, exchange, grid, self.bare, **how)
        return replace(run, table=self.complete(run.table, manoeuvre, fmus))

    def package(self, fmus: Fmus, manoeuvre: Manoeuvre, step: float, folder: Path) -> Path:
        """Its SSP package. A master that begins with zero inputs finds the body free until t_couple."""
        waits = {"t_couple": 3 * step} if self.waits and "t_couple" not in manoeuvre.given else {}
        parts = self.parts(fmus, manoeuvre.changed(**waits))
        return ssp.build(folder / f"{self.name}.ssp", parts, self.connections, step, manoeuvre.stop)

    def describe(self, end: Ended) -> str:
        """Which component ended a run, and when."""
        who = f"{self.wheels[end.component]} wheel" if end.component in self.wheels else end.component
        return f"The {who} ended the run at t = {end.time:.3f} s: {end.message}"


def wire(
    body: str, wheel: str, behind: str, pose: tuple[str, ...] = POSE, load: tuple[str, ...] = LOAD
) -> list[Connection]:
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
