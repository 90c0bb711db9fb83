"""The motion that a picture shows, from wheel.fmu: dense enough for its fastest rotation, events at their instants."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np

from wheelfmu.diagrams.scene import APART, Array, Scene
from wheelfmu.fmu.presets import POINTS, nutation
from wheelfmu.fmu.values import variables
from wheelfmu.truth.motion import Library, Run

READ = ["X_O", "Y_O", "X_C", "Y_C", "psi", "theta", "psi_dot", "phi_dot", "omega_z"]
READ += ["lambda_x", "lambda_y", "lambda_3", "mu_required", "slip_x", "slip_y", "contact_mode", "friction_mode", "E"]
LEAST, MOST = 2000, 60_000  # rows of a run
TRANSITION = re.compile(r"t = (\S+) s: (?:stick|release|reversal|the wheel (?:starts|stops|slides))")
ENDING = re.compile(r"The wheel (.+?) at t = (\S+) s")


def read(library: Library, name: str, start: Mapping[str, float], stop: float) -> Scene:
    """The motion with these parameters and inputs until `stop` in s."""
    known = variables("parameter", "input")
    settings = {n: start.get(n, v.preset) for n, v in known.items()}
    start = {n: x if known[n].type == "Real" else int(x) for n, x in start.items()}
    coarse = library.simulate(np.linspace(0.0, stop, LEAST), **start)
    instants = [float(found[1]) for found in map(TRANSITION.match, coarse.messages) if found]
    run = library.simulate(times_of(stop, fastest(coarse, settings), instants), **start)
    columns = {n: run[n] for n in READ} | {"time": run.t}
    ended = ENDING.search(run.ended or "")
    ending = f"{ended[1]} at $t$ = {float(ended[2]):.4g} s" if ended else ""
    events = tuple(t for t in instants if t <= run.t[-1])
    return Scene(name, columns, settings, events, run.counters["n_events"], ending)


def fastest(run: Run, settings: Mapping[str, float]) -> float:
    """The highest rate in rad/s of a motion: of a rotation or of the nutation that goes with it."""
    rates = np.abs([run["phi_dot"], run["psi_dot"], run["omega_z"]]).max(axis=1)
    return max(rates[0], nutation(settings, max(rates[1:])))


def times_of(stop: float, rate: float, instants: Sequence[float]) -> Array:
    """Rows for this rate, with one at each instant and one between each two."""
    rows = int(np.clip(POINTS * rate * stop / (2 * np.pi), LEAST, MOST))
    even, events = np.linspace(0.0, stop, rows + 1), np.array([0.0, *instants, stop])
    own = np.unique(np.concatenate([events, (events[:-1] + events[1:]) / 2]))
    own = own[np.diff(own, prepend=-stop) > APART * stop]
    beside = np.abs(own[np.clip(np.searchsorted(own, even), 1, len(own) - 1) - [[1], [0]]] - even).min(axis=0)
    return np.sort(np.concatenate([own, even[beside > APART * stop]]))
