"""One motion as the pictures show it: a column per variable, dense in time, with a row at the instant of each event.

Names and units are those of the model's variables: SI, fixed axes X, Y, Z, Z up; angles in rad.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ARC = 0.03  # of their range: how far the rates may leave the line between the rows next in the order of the tilt
STILL = 1e-7  # rad/s: less is rounding
APART = 1e-9  # of the run: instants closer than this are one


@dataclass(frozen=True)
class Scene:
    """name: free or friction; settings: parameters and inputs, which keep their values; instants: in s, of the events
    that the wheel logged; transitions: their number; ending: what ended the run before its time, as `lies flat at
    $t$ = 0.5928 s`; trust: how far it can be trusted, of diagrams.races; alone: why no other is drawn beside it."""

    name: str
    columns: Mapping[str, Array]
    settings: Mapping[str, float]
    instants: tuple[float, ...] = ()
    transitions: int = 0
    ending: str = ""
    trust: str = ""
    alone: str = ""

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def value(self, name: str) -> float:
        """A parameter or input of the run."""
        return self.settings[name]

    @property
    def resisted(self) -> bool:
        """Whether friction or a brake acts about the axle."""
        return self.value("s") > 0 or self.value("M_brake") > 0

    @cached_property
    def edges(self) -> Array:
        """Instants in s between which a row's modes hold: those of events, else half-way to the rows beside it."""
        time, instants = self["time"], np.array(self.instants)
        middle = (time[:-1] + time[1:]) / 2
        for beside in (np.searchsorted(time, instants + s * APART * np.ptp(time)) for s in (-1, 1)):
            there = (beside > 0) & (beside < len(time))  # the row of an event has the modes before it or after it
            middle[beside[there] - 1] = instants[there]
        return np.concatenate([time[:1], middle, time[-1:]])

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
    def rest(self) -> float | None:
        """The instant in s from which it stands, after it has moved; None if there is none."""
        moves = self.slides | (np.abs([self["phi_dot"], self["psi_dot"]]).max(axis=0) > STILL)
        moves |= abs(self["theta"] - self["theta"][-1]) > STILL
        last, time = int(np.flatnonzero(moves)[-1]) if moves.any() else len(moves), self["time"]
        if last >= len(moves) - 2:
            return None
        slack = APART * np.ptp(time)
        stops = [t for t in self.instants if time[last] - slack <= t <= time[last + 1] + slack]
        return stops[0] if stops else float(time[last + 1])

    @property
    def moving(self) -> Scene:
        """Its rows until a little after it has come to rest."""
        end = np.inf if self.rest is None else 1.1 * self.rest
        shown, instants = self["time"] <= end, tuple(t for t in self.instants if t <= end)
        return replace(self, columns={name: x[shown] for name, x in self.columns.items()}, instants=instants)

    def peak(self, values: Array) -> tuple[float, float]:
        """Instant in s and value of the largest of a column: by the parabola through the rows about it, but at an end
        or an event the row itself."""
        time, k = self["time"], int(np.nanargmax(values))
        around = slice(max(k - 1, 0), k + 2)
        t, x = time[around] - time[k], values[around]
        kink = any(time[around][0] <= instant <= time[around][-1] for instant in self.instants)
        if kink or len(t) < 3 or not np.isfinite(x).all() or np.ptp(x) == 0:
            return float(time[k]), float(values[k])
        a, b, c = np.polyfit(t / np.ptp(t), x - x[1], 2)
        return float(time[k] - b / (2 * a) * np.ptp(t)), float(x[1] + c - b * b / (4 * a))

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
    def straight(self) -> bool:
        """Whether tilt and heading keep their values."""
        return bool(max(np.ptp(self["theta"]), np.ptp(self["psi"])) <= STILL)

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
