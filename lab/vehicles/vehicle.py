"""The vehicles of examples/vehicles: their FMUs built, wired and run through a manoeuvre, and the table of the run."""

import sys
from dataclasses import dataclass
from math import inf
from pathlib import Path

import numpy as np

from wheelfmu.fmu import building
from wheelfmu.fmu.paths import ROOT, build_folder

from .master import Component, Ended, Master, loaded
from .options import EXAMPLES, VEHICLES, Manoeuvre, system

Fmus = dict[str, Path]
Table = dict[str, np.ndarray]
STEPS = (0.01, 0.005, 0.0025)  # s, of which errors show orders


def build_all(folder: Path = ROOT / "build" / "examples") -> Fmus:
    """Every FMU of the examples by name, and the wheel; their packages are beside them (examples/vehicles)."""
    wheel = build_folder() / "wheel.fmu"
    building.build("the examples", folder, EXAMPLES, [f"-DPython3_EXECUTABLE={sys.executable}", f"-DWHEEL={wheel}"])
    return {fmu.stem: fmu for fmu in folder.glob("*.fmu")} | {"wheel": wheel}


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


def wheels(vehicle: str) -> list[str]:
    """The names of its wheels."""
    return [name for name, model in system(vehicle)["fmus"].items() if model == "wheel"]


def columns(vehicle: str) -> dict[str, tuple[str, str]]:
    """Columns of the table and what they record: component, variable. Those of several wheels are named wheel.NAME."""
    found, names = {}, wheels(vehicle)
    for component, *variables in VEHICLES[vehicle]["record"]:
        for variable in variables:
            for wheel in names if "{wheel}" in component + variable else [""]:
                of, name = component.format(wheel=wheel), variable.format(wheel=wheel)
                found[f"{of}.{name}" if of in names and len(names) > 1 else name] = of, name
    return found


def drive(
    fmus: Fmus, run: Manoeuvre, h: float = 0.0, exchange: str = "", grid: float = 0.0, *, progress: bool = False
) -> Run:
    """The co-simulation, by the manoeuvre's own step and exchange unless others are given, to its end or to where a
    component ends it; recorded every `grid`, every second step unless given."""
    h, exchange, record = h or run.h, exchange or run.exchange, columns(run.vehicle)
    start, of = run.start(), system(run.vehicle)
    components = [Component(name, fmus[model], start[name]) for name, model in of["fmus"].items()]
    rows, ending, every = [], None, max(1, round((grid or 2 * h) / h))
    with loaded(*components):
        master = Master(components, of["connections"])
        try:
            for t in master.steps(run.stop, h, exchange, every, progress):
                rows.append([t, *master.read(record.values())])
        except Ended as end:
            ending = end
    return Run(dict(zip(("time", *record), np.reshape(rows, (-1, len(record) + 1)).T, strict=True)), ending)


def apart(vehicle: str, table: Table, truth: Table) -> dict[str, float]:
    """Largest difference of each compared variable at the instants of `truth`, which are some of the table's; relative
    to the variable's range, or to `least` where that is larger."""
    at = np.searchsorted(table["time"], truth["time"] - 1e-9)
    assert np.allclose(table["time"][at], truth["time"]), "the run has other instants than its truth"
    least, names = VEHICLES[vehicle]["least"], VEHICLES[vehicle]["compared"]
    return {n: float(np.abs(table[n][at] - truth[n]).max() / max(np.ptp(truth[n]), least)) for n in names}


def error(fmus: Fmus, run: Manoeuvre, truth: Table, h: float, exchange: str) -> float:
    """The largest of them for a co-simulation with the step h; infinite if it ends early."""
    found = drive(fmus, run, h, exchange, truth["time"][1])
    return inf if found.ending else max(apart(run.vehicle, found.table, truth).values())
