"""One simulated scene as `fmpy simulate` writes it: a CSV file with a named column per variable.

Names and units are those of the model's variables: SI, fixed axes X, Y, Z, Z up; angles in rad.
"""

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator

Array = NDArray[np.float64]
ARC = 0.03  # of their range: how far the rates may leave the line between the rows next in the order of the tilt
STILL = 1e-7  # rad/s: less is rounding


class SceneError(Exception):
    """A file cannot be drawn; the message is one sentence for the user."""


@dataclass(frozen=True)
class Scene:
    """The columns of one simulation, one row per communication point."""

    path: Path
    columns: dict[str, Array]

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    @property
    def time(self) -> Array:
        return self.columns["time"]

    @cached_property
    def ending(self) -> str:
        """What ended the run before its time, such as `fell flat at t = 0.593 s`: from the log beside the table."""
        log = self.path.with_suffix(".log")
        said = re.search(r"The wheel (.+?) at t = (\S+) s", log.read_text(encoding="utf-8")) if log.exists() else None
        return f"{said[1]} at $t$ = {float(said[2]):.3g} s" if said else ""

    def value(self, name: str) -> float:
        """A parameter of the run, which the file holds as a column of equal numbers."""
        return float(self[name][0])

    def setting(self, name: str) -> float:
        """The same, 0 where there is no such column."""
        return self.value(name) if name in self.columns else 0.0

    @cached_property
    def transitions(self) -> tuple[NDArray[np.int_], Array]:
        """Rows whose friction mode differs from the next row's, and the instants half-way: the mode is the sign of
        omega_z while it rolls, 0 while it is held at zero (it sticks); without friction and brake there are none."""
        rows = np.flatnonzero(np.diff(self["friction_mode"])) if self.resisted else np.array([], dtype=int)
        return rows, (self.time[rows] + self.time[rows + 1]) / 2

    @property
    def one_arc(self) -> bool:
        """Whether the data show it run to and fro on one arc: the tilt turns, and both rates are functions of it."""
        rows, turns = np.argsort(self["theta"]), np.diff(np.sign(np.diff(self["theta"])))
        rates = np.column_stack([self["psi_dot"], self["phi_dot"]])[rows]
        beside = np.abs(rates[1:-1] - (rates[:-2] + rates[2:]) / 2).max(axis=0, initial=0.0)
        return bool(turns.any() and (beside < ARC * np.ptp(rates, axis=0)).all())

    @property
    def resisted(self) -> bool:
        """Whether friction or a brake acts about the axle."""
        return self.setting("s") > 0 or self.setting("M_brake") > 0

    @property
    def still(self) -> bool:
        """Whether the rates keep their values."""
        return max(np.ptp(self["psi_dot"]), np.ptp(self["phi_dot"])) <= STILL

    def stick_phases(self) -> list[tuple[float, float]]:
        """Begin and end in s of every phase with omega_z held at zero."""
        rows, instants = self.transitions
        modes, edges = self["friction_mode"][[*rows, -1]], [self.time[0], *instants, self.time[-1]]
        return [edges[k : k + 2] for k in np.flatnonzero(modes == 0)] if self.resisted else []

    def reversals(self) -> Array:
        """Instants in s at which omega_z changes sign without a stick phase."""
        rows, instants = self.transitions
        return instants[self["friction_mode"][rows] * self["friction_mode"][rows + 1] < 0]

    def smooth(self, subdivision: int, *names: str) -> tuple[Array, ...]:
        """Columns with points between the rows, for curves that turn sharply.

        Akima's cubic is local: a kink at a transition rings nowhere else.
        """
        rows = np.arange(len(self.time))
        fine = np.linspace(0, rows[-1], rows[-1] * subdivision + 1)
        return tuple(Akima1DInterpolator(rows, self[name])(fine) for name in names)


def read_scene(path: Path, needed: tuple[str, ...]) -> Scene:
    """Read a CSV file; every column of `needed` must be there."""
    try:
        with path.open(encoding="utf-8") as file:
            table = np.genfromtxt(file, delimiter=",", names=True, ndmin=1, dtype=None, encoding="utf-8")
    except (OSError, ValueError) as fault:
        raise SceneError(f"{path} cannot be read as a table ({fault}): simulate first.") from fault
    if missing := [name for name in needed if name not in (table.dtype.names or ())]:
        raise SceneError(f"{path} lacks the column {', '.join(missing)}.")
    scene = Scene(path, {name: np.asarray(table[name], dtype=float) for name in needed})
    if len(table) < 2 or scene.time[-1] <= scene.time[0]:
        why = (scene.ending or "stands at one instant").replace("$", "")
        raise SceneError(f"{path} has no motion to draw: the wheel {why}.")
    return scene
