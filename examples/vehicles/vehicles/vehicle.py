"""A vehicle: FMUs that are wired, and what is recorded of their run, added to it, and judged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from . import ssp
from .component import Component, Ended
from .master import Connection, Run, Signal, System, Table, simulate
from .options import Manoeuvre

Fmus = dict[str, Path]


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

    def system(self, fmus: Fmus, manoeuvre: Manoeuvre, step: float) -> System:
        """Its FMUs with their start values."""
        return System(self.name, self.parts(fmus, manoeuvre), self.connections, step, manoeuvre.stop, self.bare)

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
        run = simulate(self.system(fmus, manoeuvre, step), self.record, exchange, grid, **how)
        return replace(run, table=self.complete(run.table, manoeuvre, fmus))

    def package(self, fmus: Fmus, manoeuvre: Manoeuvre, step: float, folder: Path) -> Path:
        """Its SSP package. A master that begins with zero inputs finds the body free until t_couple."""
        waits = {"t_couple": 3 * step} if self.waits and "t_couple" not in manoeuvre.given else {}
        return ssp.build(self.system(fmus, manoeuvre.changed(**waits), step), folder)

    def describe(self, end: Ended) -> str:
        """Which component ended a run, and when."""
        who = f"{self.wheels[end.component]} wheel" if end.component in self.wheels else end.component
        return f"The {who} ended the run at t = {end.time:.3f} s: {end.message}"
