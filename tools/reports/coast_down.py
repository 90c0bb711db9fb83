"""Rolling resistance out of coast-down runs on a drum: raw files of github.com/hpvdt/rolling_resistance_rig, no part of
this repository, become one row per tyre, pressure, direction of the drum and speed.

A wheel is pressed on a drum and both coast down ("Contact"); in another run ("Separate") the wheel is lifted off and
each coasts alone. Everything is reduced to the common speed v of the rims: a body of moment of inertia I and radius R
counts as a mass M = I/R^2. With the decelerations a at v, the load N and the coefficient of rolling resistance C,

    C N = M_drum (a_contact - a_drum alone) + M_wheel (a_contact - a_wheel alone).
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Array = NDArray[np.float64]
Key = tuple[str, int, str]
Name = tuple[str, int, str, str]  # a key and the kind, Contact or Separate
Run = tuple[Array, Array]  # instants at which a revolution of the drum and of the wheel ended
LOAD = 557.4  # N, the rig's own value
DRUM_LENGTH = 4.709  # m, circumference, likewise
DRUM_MASS = 10.0 * (2 * np.pi / DRUM_LENGTH) ** 2  # kg, of 10 kg m^2, likewise
# kg, the rig's list of wheels; its pendulum records are complete for two wheels: M_wheel is 0.61 and 0.76 of the mass.
WHEELS = {
    "Grandprix": 1.1,
    "Grandprix406": 0.8,
    "Greenspeed Scorcher": 0.8,
    "Michelin 44-406": 0.58,
    "Michelin 4575r16": 1.1,
    "Vittoria Corsa Open": 1.275,
}
SHARE, SHARE_ERROR = 0.7, 0.15  # of M_wheel in the wheel's mass
SPEEDS = tuple(np.arange(3.0, 22.0, 3.0))  # m/s
HALF, FEWEST = 1.5, 6  # m/s about a speed; revolutions that a fit needs there
POUND = 0.45359237 * 9.80665  # N
LOADED = re.compile(r"60psi *- *(?P<pounds>\d+)lbm[ -]*(?P<direction>Left|Right)")
OF_LOADED = "Michelin 4575r16", 60  # the rig names no tyre; two of the files stand under this one's name, too
NAME = re.compile(r"(?P<tyre>.+) - (?P<kind>Contact|Separate) - (?P<direction>Left|Right) - (?P<psi>\d+) psi")
KEYS = ["tyre", "psi", "direction"]


def triggers(path: Path) -> Run:
    """Instants in s at which a revolution of the drum and of the wheel ended: the row before its count rises."""
    rows = np.genfromtxt(path, delimiter=",", usecols=range(5), invalid_raise=False)
    rows = rows[np.isfinite(rows).all(axis=1)]
    drum, wheel = (1e-6 * rows[np.flatnonzero(np.diff(rows[:, column])), 0] for column in (2, 4))
    return drum, wheel


def same_run(one: Run, other: Run) -> bool:
    """Whether two files hold one coast-down under two names: the drum shares most instants."""
    times = [speed(run[0], DRUM_LENGTH)[0] for run in (one, other)]
    return len(np.intersect1d(*times)) > 0.5 * min(map(len, times))


def speed(instants: Array, length: float) -> tuple[Array, Array]:
    """Time and speed of each revolution from the fastest down to 1.4 m/s, without false triggers.

    A revolution 2 % off the median of eleven neighbours has a trigger too many or too few.
    """
    period = np.diff(instants)
    t, v = (instants[1:] + instants[:-1])[period > 0] / 2, length / period[period > 0]
    median = pd.Series(v).rolling(11, center=True, min_periods=1).median().to_numpy()
    kept = np.abs(v / median - 1) < 0.02
    t, v, median = t[kept], v[kept], median[kept]
    first = int(np.argmax(median))
    slow = np.flatnonzero(median[first:] < SPEEDS[0] - HALF - 0.1)
    last = first + slow[0] if len(slow) else len(v)
    return t[first:last], v[first:last]


def deceleration(t: Array, v: Array, at: float) -> tuple[float, float]:
    """Instant and deceleration at one speed: t is a quadratic function of v nearby; NaN where too little is left."""
    near = np.abs(v - at) < HALF
    if near.sum() < FEWEST or v[near].max() < at or v[near].min() > at:
        return np.nan, np.nan
    quadratic = np.polynomial.Polynomial.fit(v[near], t[near], 2)
    return float(quadratic(at)), float(-1 / quadratic.deriv()(at))


def rolling_length(drum: Array, wheel: Array) -> float:
    """The wheel's circumference in contact: both rims have one speed."""
    t, v = speed(drum, DRUM_LENGTH)
    inside = wheel[(wheel > t[0]) & (wheel < t[-1])]
    middle = (inside[1:] + inside[:-1]) / 2
    return float(np.median(np.interp(middle, t, v) * np.diff(inside)))


def one(key: Key, contact: Run, separate: Run) -> pd.DataFrame:
    """One tyre, pressure and direction: instants, drag of drum and wheel alone, and C over the speed."""
    length, mass = rolling_length(*contact), WHEELS[key[0]]
    runs = (contact[0], DRUM_LENGTH), (separate[0], DRUM_LENGTH), (separate[1], length)
    found = [np.array([deceleration(*speed(instants, c), at) for at in SPEEDS]).T for instants, c in runs]
    (t, both), (_, drum), (_, wheel) = found
    drag, M = DRUM_MASS * drum + SHARE * mass * wheel, DRUM_MASS + SHARE * mass
    columns = {"speed": SPEEDS, "t": t - t[-1], "drag": drag, "C": (M * both - drag) / LOAD}
    columns["C_inertia"] = SHARE_ERROR * mass * (both - wheel) / LOAD  # of a heavier rim
    return pd.DataFrame(dict(zip(KEYS, key, strict=True)) | columns | {"R": length / (2 * np.pi), "M": M})


def named(path: Path) -> Name | None:
    name = NAME.fullmatch(path.stem)
    known = name and name["tyre"] in WHEELS
    return (name["tyre"], int(name["psi"]), name["direction"], name["kind"]) if known else None


def read(folder: Path) -> tuple[dict[Name, Run], dict[Name, Name]]:
    """The runs of a folder, and the names that hold a run once more; the first in the alphabet keeps it."""
    found, copies = {}, {}
    for path in filter(named, sorted(folder.glob("*.csv"))):
        run = triggers(path)
        twin = next((other for other in found if same_run(run, found[other])), None)
        (copies if twin else found)[named(path)] = twin or run
    return found, copies


def in_contact(name: Name) -> bool:
    return name[-1] == "Contact"


def plausible(rows: pd.DataFrame) -> bool:
    """No gap, and no jump of C by a third from one speed to the next: lost triggers show so, no tyre does."""
    jumps = np.abs(np.diff(rows["C"])) / rows["C"].median()
    return bool(rows[["t", "drag", "C"]].notna().all(axis=None) and jumps.max() < 1 / 3)


def evaluate(runs: dict[Name, Run], copies: dict[Name, Name]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """All usable pairs of runs, and the pairs that are left out with the reason."""
    used, unused = [], []
    for *key, _ in filter(in_contact, copies):
        tyre, psi, direction, _ = copies[*key, "Contact"]
        unused.append((*key, f"a copy of {tyre}, {psi} psi, {direction.lower()}"))
    for *key, _ in filter(in_contact, runs):
        alone = runs.get((*key, "Separate"))
        rows = one(key, runs[*key, "Contact"], alone) if alone else None
        if rows is not None and plausible(rows):
            used.append(rows)
        else:
            unused.append((*key, "lost or false triggers" if alone else "no separate run"))
    return pd.concat(used, ignore_index=True), pd.DataFrame(unused, columns=[*KEYS, "reason"]).sort_values(KEYS)


def repeatability(rows: pd.DataFrame) -> pd.Series:
    """Standard deviation of one C per speed, out of the two directions of each tyre and pressure."""
    both = rows.pivot_table(index=["tyre", "psi", "speed"], columns="direction", values="C").dropna()
    apart = (both["Left"] - both["Right"]) ** 2 / 2
    return np.sqrt(apart.groupby("speed").mean())


def beside(runs: dict[Name, Run], key: Key, run: Run) -> pd.DataFrame:
    """A further run, with the one without contact at the nearest pressure, which changes a free wheel's drag little."""
    tyre, psi, direction = key
    near = [name for name in runs if (name[0], *name[2:]) == (tyre, direction, "Separate")]
    return one(key, run, runs[min(near, key=lambda name: abs(name[1] - psi))])


def again(runs: dict[Name, Run], copies: dict[Name, Name], folder: Path) -> pd.DataFrame:
    """C of the runs that the rig repeated, first and second time, with the same run without contact."""
    rows = []
    for path in sorted(folder.glob("*Contact*.csv")):
        *key, _ = name = named(path)
        first, second = (beside(runs, key, run) for run in (runs[copies.get(name, name)], triggers(path)))
        rows.append(first.assign(**{"C again": second["C"]}))
    return pd.concat(rows, ignore_index=True)[["speed", "C", "C again", *KEYS]]


def loaded(runs: dict[Name, Run], folder: Path) -> pd.DataFrame:
    """The force of rolling resistance under two other loads."""
    rows = []
    for path in sorted(folder.glob("*.csv")):
        name = LOADED.fullmatch(path.stem)
        found = beside(runs, (*OF_LOADED, name["direction"]), triggers(path))
        rows.append(found.assign(force=LOAD * found["C"], load=POUND * float(name["pounds"])))
    return pd.concat(rows, ignore_index=True)[["speed", "force", "direction", "load"]]


def tables(folder: Path) -> dict[str, pd.DataFrame]:
    """Of the rig's raw files: all usable runs, what was left out, the repetitions, and the runs under other loads."""
    runs, copies = read(folder / "aero")
    rows, left_out = evaluate(runs, copies)
    repeated = again(runs, copies, folder / "aero" / "Repeats")
    return {"rig": rows, "runs_left_out": left_out, "trials_again": repeated, "loads": loaded(runs, folder / "force")}
