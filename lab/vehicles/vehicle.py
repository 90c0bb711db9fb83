"""A vehicle: FMUs that are built and wired, the record of their run, and its verdict.

A body with hubs names its variables as the wheels do, with _ and the wheel's name behind.
"""

import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from math import inf, pi
from pathlib import Path

import numpy as np

from wheelfmu.fmu import building
from wheelfmu.fmu.paths import ROOT, build_folder

from . import ssp
from .master import Component, Connection, Ended, Master, Signal, loaded
from .options import EXAMPLES, ROAD, Manoeuvre, file

Fmus = dict[str, Path]
Table = dict[str, np.ndarray]
DRY_ROAD = 1.0  # friction coefficient of tyres on dry asphalt, about
STEPS = (0.01, 0.005, 0.0025)  # s, of which errors show orders
Errors = dict[str, dict[float, float]]  # relative to the range: by exchange and communication step


def build_all(folder: Path = ROOT / "build" / "examples") -> Fmus:
    """Every FMU of the examples by name, and the wheel; by CMake (../CMakeLists.txt)."""
    building.build("the examples", folder, EXAMPLES, [f"-DPython3_EXECUTABLE={sys.executable}"])
    return {fmu.stem: fmu for fmu in folder.glob("*.fmu")} | {"wheel": build_folder() / "wheel.fmu"}


def orders(errors: dict[float, float]) -> np.ndarray:
    """Observed order between neighbours of the errors by step."""
    return np.diff(np.log([*errors.values()])) / np.diff(np.log([*errors]))


@dataclass(frozen=True)
class Run:
    """Columns on a grid, and how it ended, if early."""

    table: Table
    ending: Ended | None = None

    @property
    def whole(self) -> Table:
        """The table of a run that reached its end; raises Ended for another."""
        if self.ending:
            raise self.ending
        return self.table


def row_of_brake(table: Table, run: Manoeuvre) -> int:
    """The row of t_brake, or the end of a shorter table."""
    return int(np.searchsorted(table["time"], run["t_brake"] - 1e-9))


def largest_grip(table: Table) -> float:
    """The largest friction coefficient that a wheel requires in a run; 0 where it is not recorded."""
    return max((float(np.nanmax(x)) for name, x in table.items() if name.endswith("mu_required")), default=0.0)


@dataclass(frozen=True)
class Vehicle:
    """`name`: of the command line; manoeuvres.toml has connections, columns, tracks. `wheels`: what pictures call the
    components that are wheels, whose columns are "wheel.variable"; other columns are the variable's name."""

    name: str
    starts: Callable[[Manoeuvre], dict[str, dict[str, float]]]  # start values of its wheels, and more of its models
    verdict: Callable[[Table, Manoeuvre], tuple[bool, list[str]]]  # of a run that reached its end
    wheels: dict[str, str] = field(default_factory=dict)
    complete: Callable[[Table, Manoeuvre, Fmus], Table] = lambda table, _manoeuvre, _fmus: table
    grip: Callable[[Table], float] = largest_grip
    subtitle: Callable[[Manoeuvre], str] = lambda _manoeuvre: ""

    def parts(self, fmus: Fmus, of: Manoeuvre) -> list[Component]:
        """The wheels, and the models with the parameters that a manoeuvre gives."""
        starts, models = self.starts(of), file(self.name)["models"]
        wheels = [Component(name, fmus["wheel"], start) for name, start in starts.items() if name not in models]
        return wheels + [Component(model, fmus[model], of.of(model) | starts.get(model, {})) for model in models]

    def rows(self, table: str) -> Iterator[list[str]]:
        """Of a table in manoeuvres.toml; a row with {wheel} stands for one row per wheel."""
        for row in file(self.name)[table]:
            for wheel in self.wheels if "{wheel}" in "".join(row) else [""]:
                yield [text.format(wheel=wheel) for text in row]

    @cached_property
    def record(self) -> list[Signal]:
        """What a run records."""
        return [(part, name) for part, *names in self.rows("record") for name in names]

    @cached_property
    def connections(self) -> list[Connection]:
        """What a body calls NAME_fl is NAME of the wheel fl."""
        rows = [((source, sink), names) for source, sink, *names in self.rows("connect")]
        return [tuple((part, n.removesuffix(f"_{part}")) for part in ends) for ends, names in rows for n in names]

    def drive(
        self, fmus: Fmus, of: Manoeuvre, h: float = 0.0, exchange: str = "", grid: float = 0.0, **how: bool
    ) -> Run:
        """The co-simulation, by the manoeuvre's own step and exchange unless others are given, to its end or to where a
        component ends it; recorded every `grid`, every second step unless given, with the columns that `complete`
        adds."""
        h, exchange = h or of.h, exchange or of.exchange
        every = max(1, round((grid or of.grid or 2 * h) / h))
        components, rows, ending = self.parts(fmus, of), [], None
        with loaded(*components):
            master = Master(components, self.connections)
            try:
                for t in master.steps(of.stop, h, exchange, every, **how):
                    rows.append([t, *master.read(self.record)])
            except Ended as end:
                ending = end
        names = ["time", *(f"{part}.{name}" if part in self.wheels else name for part, name in self.record)]
        table = dict(zip(names, np.reshape(rows, (-1, len(names))).T, strict=True))
        return Run(self.complete(table, of, fmus), ending)

    def package(self, fmus: Fmus, manoeuvre: Manoeuvre, step: float, folder: Path) -> Path:
        """Its SSP package. A master that begins with zero inputs finds the body free until t_couple."""
        waits = {"t_couple": 3 * step} if "waits" in file(self.name) and "t_couple" not in manoeuvre.given else {}
        parts, name = self.parts(fmus, manoeuvre.changed(**waits)), file(self.name).get("package", self.name)
        return ssp.build(folder / f"{name}.ssp", parts, self.connections, step, manoeuvre.stop)

    def apart(self, table: Table, truth: Table) -> dict[str, float]:
        """Largest difference of each compared variable at the instants of `truth`, which are some of the table's;
        relative to the variable's range, or to `least` where that is larger."""
        at = np.searchsorted(table["time"], truth["time"] - 1e-9)
        assert np.allclose(table["time"][at], truth["time"]), "the run has other instants than its truth"
        least, names = file(self.name).get("least", 0), file(self.name)["compared"]
        return {n: float(np.abs(table[n][at] - truth[n]).max() / max(np.ptp(truth[n]), least)) for n in names}

    def distance(self, table: Table, truth: Table) -> float:
        """The largest of them."""
        return max(self.apart(table, truth).values())

    def error(self, fmus: Fmus, of: Manoeuvre, truth: Table, h: float, exchange: str) -> float:
        """Distance of a co-simulation with the step h from the truth; infinite if it ends early."""
        run = self.drive(fmus, of, h, exchange, truth["time"][1])
        return inf if run.ending else self.distance(run.table, truth)

    def describe(self, end: Ended) -> str:
        """Which component ended a run, and when."""
        return f"The {self.who(end)} ended the run at t = {end.time:.3f} s: {end.message}"

    def remark(self, end: Ended | None) -> str:
        """A second line for the title of a picture, where a run ended early."""
        if not end:
            return ""
        what = re.search("lifted off|lies flat", end.message)
        how = what[0] if what else "ended the run"
        return f"\nThe {self.who(end)} {how} at t = {end.time:.2f} s, where the curves end."

    def who(self, end: Ended) -> str:
        return f"{self.wheels[end.component]} wheel" if end.component in self.wheels else end.component


def beyond_dry(mu: float) -> str:
    """A friction coefficient, in words."""
    return f"{mu:.2f}; a dry road has about {DRY_ROAD:g}"


def upright(x: float, y: float, heading: float, speed: float, turn: float, R: float) -> dict[str, float]:
    """Start of an upright wheel that rolls at `speed` [m/s] along its heading [rad] and turns at `turn` [rad/s]."""
    pose = {"psi_start": heading, "theta_start": pi / 2, "X_O_start": x, "Y_O_start": y}
    return {**pose, "phi_dot_start": -speed / R, "psi_dot_start": turn, "theta_dot_start": 0.0}


def road(manoeuvre: Manoeuvre) -> dict[str, float]:
    """The wheels' parameters of the road: slope, friction, and the friction that a wheel checks, if any."""
    return {name: manoeuvre[name] for name in ROAD}
