"""The car of examples/vehicles: its FMUs, built; a manoeuvre, driven by the master; the table of the run. SI units."""

import sys
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from wheelfmu.fmu import building
from wheelfmu.fmu.paths import ROOT, build_folder

from .manoeuvres import EXAMPLES, WHEELS, Manoeuvre, system
from .master import Component, Master, loaded

Fmus = dict[str, Path]
Table = dict[str, np.ndarray]
BUILT = ROOT / "build" / "examples"
OF_A_WHEEL = ("X_O", "Y_O", "psi", "theta", "phi", "omega_z", "lambda_1", "lambda_2", "lambda_3", "lambda_y")
COMPARED = ("X", "Y", "psi", "roll", "pitch", "v", "omega")
RECORD = {"chassis": COMPARED, "driver": ("delta", "M_drive", "M_brake"), **dict.fromkeys(WHEELS, OF_A_WHEEL)}
LEAST = 0.01  # of a range, where errors are relative to it


def build_all() -> Fmus:
    """Every FMU of the examples by name, and the wheel; their packages are beside them (examples/vehicles)."""
    wheel = build_folder() / "wheel.fmu"
    building.build("the examples", BUILT, EXAMPLES, [f"-DPython3_EXECUTABLE={sys.executable}", f"-DWHEEL={wheel}"])
    return fmus_in(BUILT)


def fmus_in(folder: Path) -> Fmus:
    """Those that were built there, and the wheel."""
    return {fmu.stem: fmu for fmu in folder.glob("*.fmu")} | {"wheel": build_folder() / "wheel.fmu"}


def drive(
    fmus: Fmus,
    run: Manoeuvre,
    h: float = 0.0,
    exchange: str = "derivatives",
    grid: float = 0.0,
    *,
    progress: bool = False,
) -> Table:
    """A manoeuvre by the package's own step, unless h is given; recorded every `grid`, or every second step."""
    of = system() | {"start": run.start(), "stop": run.stop}
    return recorded(fmus, of | ({"step": h} if h else {}), RECORD, exchange, grid, progress=progress)


def recorded(
    fmus: Fmus, of: dict[str, Any], record: dict[str, tuple], exchange: str, grid: float, *, progress: bool
) -> Table:
    """A system's run: time, and the variables of each component; those of a wheel of the car with its name before."""
    components = [Component(name, fmus[model], of["start"][name]) for name, model in of["fmus"].items()]
    with loaded(*components):
        master, h = Master(components, of["connections"]), of["step"]
        times = master.steps(of["stop"], h, exchange, max(1, round((grid or 2 * h) / h)), progress)
        rows = [[t, *chain.from_iterable(master.read(*one) for one in record.items())] for t in times]
    columns = [f"{name}.{one}" if name in WHEELS else one for name, ones in record.items() for one in ones]
    return dict(zip(("time", *columns), np.transpose(rows), strict=True))


def error(table: Table, truth: Table) -> float:
    """The largest difference of a compared variable at the instants of `truth`, which are some of the table's, over the
    variable's range, or over `LEAST` if that is larger."""
    at = np.searchsorted(table["time"], truth["time"] - 1e-9)
    assert np.allclose(table["time"][at], truth["time"]), "the run has other instants than its truth"
    return max(float(np.abs(table[n][at] - truth[n]).max() / max(np.ptp(truth[n]), LEAST)) for n in COMPARED)
