"""One simulated scene as `fmpy simulate` writes it: a CSV file with a named column per variable.

Names and units are those of the model's variables: SI, fixed axes X, Y, Z, Z up; angles in rad.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
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
    columns: Mapping[str, Array]

    def __getitem__(self, name: str) -> Array:
        if name not in self.columns:
            raise SceneError(f"{self.path} lacks the column {name}.")
        return self.columns[name]

    @cached_property
    def ending(self) -> str:
        """What ended the run before its time, such as `lies flat at t = 0.593 s`: from the log beside the table."""
        log = self.path.with_suffix(".log")
        said = re.search(r"The wheel (.+?) at t = (\S+) s", log.read_text(encoding="utf-8")) if log.exists() else None
        return f"{said[1]} at $t$ = {float(said[2]):.3g} s" if said else ""

    @property
    def trust(self) -> str:
        """How far it can be trusted, of diagrams.races: from the file beside the table."""
        file = self.path.with_suffix(".error")
        return file.read_text(encoding="utf-8").splitlines()[1] if file.exists() else ""

    def value(self, name: str) -> float:
        """A parameter of the run, which the file holds as a column of equal numbers."""
        return float(self[name][0])

    @property
    def resisted(self) -> bool:
        """Whether friction or a brake acts about the axle."""
        return self.value("s") > 0 or self.value("M_brake") > 0

    @property
    def edges(self) -> Array:
        """Instants in s between which a row's friction mode is drawn: half-way to the rows beside it."""
        return np.concatenate([self["time"][:1], (self["time"][:-1] + self["time"][1:]) / 2, self["time"][-1:]])

    @property
    def mode(self) -> Array:
        """The sign of omega_z while the wheel rolls, 0 while omega_z is held at zero (stick); 1 without resistance."""
        return np.sign(self["friction_mode"]) if self.resisted else np.ones(len(self["time"]))

    @property
    def reversals(self) -> Array:
        """Instants in s at which omega_z changes sign without a stick phase."""
        return self.edges[1:-1][self.mode[:-1] * self.mode[1:] < 0]

    @property
    def slides(self) -> Array:
        """Whether the wheel slides, by row."""
        return self["contact_mode"] == 1

    @property
    def turns(self) -> Array:
        """Instants in s at which the wheel starts or stops sliding."""
        return self.edges[1:-1][self.slides[:-1] != self.slides[1:]]

    @property
    def transitions(self) -> int:
        """How often friction or brake hold, release or reverse the spin, or the wheel starts or stops sliding."""
        return int(self["n_events"][-1])

    @property
    def rest(self) -> float | None:
        """The instant in s from which it stands, after it has moved; None if there is none."""
        moves = self.slides | (np.abs([self["phi_dot"], self["psi_dot"]]).max(axis=0) > STILL)
        moves |= abs(self["theta"] - self["theta"][-1]) > STILL
        last = int(np.flatnonzero(moves)[-1]) if moves.any() else len(moves)
        return float(self["time"][last + 1]) if last < len(moves) - 2 else None

    @property
    def moving(self) -> Scene:
        """Its rows until a little after it has come to rest."""
        shown = self["time"] <= (np.inf if self.rest is None else 1.1 * self.rest)
        return Scene(self.path, {name: column[shown] for name, column in self.columns.items()})

    @property
    def by_rounding(self) -> bool:
        """Whether rounding alone tips the wheel: exactly upright, its lean grows from 1e-16 rad to a thousandth."""
        lean = abs(self["theta"] - np.pi / 2)
        return bool(lean[0] < 1e-12 and lean[1] < 1e-9 and lean.max() > 1e-3)

    @property
    def slip(self) -> Array:
        """Speed of the slip in m/s."""
        return np.hypot(self["slip_x"], self["slip_y"])

    @property
    def guided(self) -> bool:
        """Whether a wheel carrier keeps the direction of its axle."""
        return self.value("guided") > 0

    @property
    def speed(self) -> Array:
        """v of O along e1 in m/s."""
        psi = self["psi"]
        return self["X_O_dot"] * np.cos(psi) + self["Y_O_dot"] * np.sin(psi)

    @property
    def rolling_speed(self) -> Array:
        """The speed in m/s at which the wheel would not slip along e1: of a guided wheel R |omega_z|."""
        return self.speed - self["slip_x"]

    @property
    def slip_ratio(self) -> Array:
        """kappa = -slip_x / v, braking negative; nan where the wheel stands."""
        still = abs(self.speed) < 1e-6 * abs(self.speed).max(initial=1e-300)
        return np.divide(-self["slip_x"], self.speed, out=np.full(len(still), np.nan), where=~still)

    def rows_at(self, time: Array) -> NDArray[np.int64]:
        """The row next to each instant."""
        return np.searchsorted(self.edges[1:-1], time)

    @property
    def one_arc(self) -> bool:
        """Whether the data show it run to and fro on one arc: the tilt turns, and both rates are functions of it."""
        rows, turns = np.argsort(self["theta"]), np.diff(np.sign(np.diff(self["theta"])))
        rates = np.column_stack([self["psi_dot"], self["phi_dot"]])[rows]
        beside = np.abs(rates[1:-1] - (rates[:-2] + rates[2:]) / 2).max(axis=0, initial=0.0)
        return bool(turns.any() and (beside < ARC * np.ptp(rates, axis=0)).all())

    @property
    def still(self) -> bool:
        """Whether the rates keep their values."""
        return bool(max(np.ptp(self["psi_dot"]), np.ptp(self["phi_dot"])) <= STILL)

    def smooth(self, subdivision: int, *names: str) -> tuple[Array, ...]:
        """Columns with points between the rows, for curves that turn sharply.

        Akima's cubic is local: a kink at a transition rings nowhere else.
        """
        rows = np.arange(len(self["time"]))
        fine = np.linspace(0, rows[-1], rows[-1] * subdivision + 1)
        return tuple(Akima1DInterpolator(rows, self[name])(fine) for name in names)


def read_scene(path: Path) -> Scene:
    """Read a CSV file."""
    try:
        table = np.genfromtxt(path, delimiter=",", names=True, dtype=None, ndmin=1, encoding="utf-8")
    except (OSError, ValueError) as fault:
        raise SceneError(f"{path} cannot be read as a table ({fault}): simulate first.") from fault
    scene = Scene(path, {name: table[name].astype(float) for name in table.dtype.names})
    if np.ptp(scene["time"]) <= 0:
        why = (scene.ending or "stands at one instant").replace("$", "")
        raise SceneError(f'The scene "{path.stem}" has no motion to draw: the wheel {why}.')
    return scene
