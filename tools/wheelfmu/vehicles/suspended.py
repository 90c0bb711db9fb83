"""Suspended wheel: a quarter car, launched from rest by a step of the drive torque, or stopped on a wet road.

Coupled through F_X, F_Y, F_Z, M_3 and position and velocity of O, by values held over the communication step or by
straight lines (derivatives of first order); the guided wheel has its own wheel carrier. In the end both move on
together: with m all masses, R the wheel's rolling radius,

    (m + J_z / R^2) a = (M_drive - s m g) / R
"""

from collections.abc import Sequence
from dataclasses import replace
from math import exp, pi
from pathlib import Path

import numpy as np

from . import ssp
from .options import Manoeuvre, manoeuvres
from .vehicle import DRY_ROAD, Errors, Fmus, Run, Table, Vehicle, beyond_dry, road, upright

LAUNCH = manoeuvres("suspended")["launch"]
GRID = 0.05  # s, where runs are compared; every step below divides it
STEPS = (0.005, 0.0025, 0.00125, 0.000625, 0.0003125)  # s
START = {"guided": True, "psi_start": 0.0, "theta_start": pi / 2, "phi_dot_start": 0.0, "X_O_start": 0.0}
M_WHEEL, J_Z, RADIUS, GRAVITY = 20.0, 1.8, 0.3 + 0.05, 9.81  # of the wheel; SI
CONTROLS = ("locked", "ideal")  # brakes beside the anti-lock controller, by their numbers in brakes.csv
CENTRE = (("X", "X_O", "X_B"), ("v", "X_O_dot", "X_B_dot"))
BRAKES = {"abs": "the anti-lock controller", "ideal": "the ideal brake", "locked": "a brake that locks it"}
OF_BRAKE = ("X", "v", "X_O_dot", "X_B_dot", "omega_z", "M_brake", "slip_x")
CLOSE = 0.002  # a distance this near to its closed form, relative, agrees with it: a row of the table is 0.05 %


def mass(run: Manoeuvre = LAUNCH) -> float:
    """Of all, kg."""
    return run["m_B"] + M_WHEEL


def start(run: Manoeuvre) -> dict[str, dict[str, float]]:
    """Of the wheel; of the brake what follows from the wheel."""
    upright_at_v = upright(0.0, 0.0, 0.0, run["v"], 0.0, RADIUS) if run["v"] else {}
    per_N = run["share"] * run["mu_max"] * (RADIUS + J_Z / (mass(run) * RADIUS)) - run["s"]
    control = {"control": float(CONTROLS.index(run.name)) if run.name in CONTROLS else 2.0, "R": RADIUS}
    return {"wheel": START | road(run) | upright_at_v, "brakes": control | {"M_per_N": max(per_N, 0.0)}}


def beside_others(run: Run, asked: Manoeuvre, fmus: Fmus) -> Run:
    """Of the anti-lock controller's run: with those of the other brakes, in columns locked.NAME and ideal.NAME; X and v
    of all masses' centre. A wheel that rolls counts with J_z / R^2 more: the links' swing is not in them."""
    rows = len(run.table["time"])
    if asked.name != "abs" or rows < 2:
        return run
    runs = {"abs": run}
    for name in CONTROLS:
        brake = replace(asked, name=name)
        runs[name] = SUSPENDED.drive(fmus, brake, asked.h, asked.exchange, run.table["time"][1])
    table = dict(run.table)
    for name, of in runs.items():
        wheel = M_WHEEL + (J_Z / RADIUS**2 if name == "ideal" else 0.0)
        whole = wheel + asked["m_B"]
        centre = {n: (wheel * of.table[o] + asked["m_B"] * of.table[body]) / whole for n, o, body in CENTRE}
        table |= {f"{name}.{n}": filled(x, rows) for n, x in (of.table | centre).items() if n in OF_BRAKE}
    ends = {n: of.ending and replace(of.ending, component=f"wheel with {BRAKES[n]}") for n, of in runs.items()}
    return Run(table, ends.pop("abs"), tuple(filter(None, ends.values())))


def filled(x: np.ndarray, rows: int) -> np.ndarray:
    """A column of a run that ended early, as long as the others."""
    return np.pad(x[:rows], (0, max(rows - len(x), 0)), constant_values=np.nan)


def verdict(table: Table, run: Manoeuvre) -> tuple[bool, list[str]]:
    """Its state at the end; no road gives more friction than a dry one."""
    least, most = table["lambda_3"].min(), SUSPENDED.grip(table)
    if most > DRY_ROAD:
        return False, [f"Failed: the wheel requires a friction coefficient of {beyond_dry(most)}."]
    if run.name == "abs":
        return stops(table, run)
    speed = f"Final speed: {table['X_O_dot'][-1]:.4f} m/s; smallest normal force: {least:.1f} N"
    return True, [f"{speed}; friction required: {most:.2f}."]


def rest(run: Manoeuvre) -> float:
    """Height at which the spring bears the sprung mass over an upright wheel, m."""
    return RADIUS + run["l_0"] - run["m_B"] * GRAVITY / run["k_v"] if run["k_v"] else np.inf


ASSUMED = {  # by the closed forms of a stop: by its words where it does not hold
    "the road is not level": lambda run: not run["slope"],
    "the sprung mass starts off its rest": lambda run: abs(run["Z_B_start"] - rest(run)) < 1e-3,
    "the links carry from too late on": lambda run: run["t_couple"] + 0.3 <= run["t_brake"],
    "a link is softer than half the standard one": lambda run: run["k_h"] >= 30e3 and run["k_v"] >= 10e3,
    "a damper is weaker than half the standard one": lambda run: run["c_h"] >= 1e3 and run["c_v"] >= 750,
}


def stops(table: Table, run: Manoeuvre) -> tuple[bool, list[str]]:
    """Three stops beside their closed forms, and whether the controller does its task."""
    ways = {name: way(table, run, name) for name in ("locked", "ideal", "abs")}
    if late := [name for name, found in ways.items() if not np.isfinite(found)]:
        return False, [f"Failed: not at rest by {run.stop:g} s: {', '.join(late)}."]
    broken = next((words for words, holds in ASSUMED.items() if not holds(run)), "")
    exact = {} if broken else {"locked": sliding_way(table, run), "ideal": gripping_way(table, run)}
    slid = {name: bool(np.any(table[f"{name}.slip_x"])) for name in CONTROLS}
    forms = {name: f" (closed form: {found:.2f} m)" for name, found in exact.items()}
    lines = [f"Stopping distance from {run['v']:g} m/s:"]
    lines += [f"  {name}: {ways[name]:.2f} m{forms.get(name, '')}" for name in CONTROLS]
    less = 100 * (1 - ways["abs"] / ways["locked"])
    lines.append(f"  anti-lock: {ways['abs']:.2f} m, {abs(less):.1f} % {'less' if less >= 0 else 'more'} than locked")
    lines += [f"No closed form: {broken}."] * bool(broken)
    off = {name: abs(ways[name] / found - 1) for name, found in exact.items()}
    faults = ["under the ideal brake the wheel slides"] * slid["ideal"]
    faults += [f"{name}: {100 * off[name]:.1f} % off the closed form" for name in off if off[name] > CLOSE]
    faults += ["the pedal does not lock the wheel"] * (not slid["locked"])
    gains = run["mu_slide"] < run["mu_max"]  # else a locked wheel brakes as hard as any
    faults += ["the anti-lock controller stops no shorter than a locked wheel"] * (gains and less <= 0)
    best = not broken and ways["abs"] < shortest(table, run)
    faults += ["the anti-lock controller stops shorter than friction allows"] * best
    return not faults, [*lines, *(f"Failed: {fault}." for fault in faults[:1])]


def way(table: Table, run: Manoeuvre, name: str) -> float:
    """Of all masses' centre from t_brake to where the wheel first stands, m; nan where it does not."""
    begin = begins(table, run)
    stands = np.flatnonzero(table[f"{name}.X_O_dot"] <= 1e-3 * run["v"])
    if begin >= len(table["time"]) or not len(stands):
        return np.nan
    return float(table[f"{name}.X"][stands[0]] - table[f"{name}.X"][begin])


def stopping(v: float, before: float, a: float, lag: float) -> float:
    """Stopping distance from v under a deceleration that goes from `before` to a: a - (a - before) exp(-t / lag)."""
    late = (a - before) * lag
    return (v + late) ** 2 / (2 * a) - late * lag


def gripping_way(table: Table, run: Manoeuvre) -> float:
    """Under the ideal brake: from the deceleration s m g / (R (m + J_z / R^2)) to share mu_max g."""
    before, v = -acceleration(0.0, run["s"]), float(table["ideal.v"][begins(table, run)])
    return stopping(v, before, run["share"] * run["mu_max"] * GRAVITY, run["T_brake"])


def sliding_way(table: Table, run: Manoeuvre) -> float:
    """Of the wheel that locks: as measured until it slides, then at mu_slide g."""
    time, slip, v = (table[n] for n in ("time", "locked.slip_x", "locked.v"))
    lost = int(np.argmax((time >= run["t_brake"]) & (slip > 0)))
    begin = begins(table, run)
    before = float(table["locked.X"][lost] - table["locked.X"][begin])
    return before + float(v[lost]) ** 2 / (2 * run["mu_slide"] * GRAVITY)


def shortest(table: Table, run: Manoeuvre) -> float:
    """No brake on this road stops in less."""
    return float(table["abs.v"][begins(table, run)]) ** 2 / (2 * run["mu_max"] * GRAVITY)


def begins(table: Table, run: Manoeuvre) -> int:
    """The row of t_brake, or the end of a shorter table."""
    return int(np.searchsorted(table["time"], run["t_brake"] - 1e-9))


SUSPENDED = Vehicle("suspended", start, verdict, complete=beside_others)


def package_distance(package: Path, step: float, truth: Table, stop: float = LAUNCH.stop) -> float:
    """Largest difference over time of X_O and phi_dot in fmpy's run of the package, relative to their ranges."""
    run, names = ssp.run(package, step, stop, GRID), ("X_O", "phi_dot")
    driven = slice(1, 1 + len(run["time"]))
    return max(float(np.abs(run[f"wheel.{n}"] - truth[n][driven]).max() / np.ptp(truth[n])) for n in names)


def acceleration(torque: float, s: float = LAUNCH["s"]) -> float:
    """Of wheel and sprung mass together, m/s2."""
    return (torque - s * mass() * GRAVITY) / RADIUS / (mass() + J_Z / RADIUS**2)


def fine(fmus: Fmus, step: float) -> Table:
    """The reference of the coupled runs: the launch on straight lines at a small step. (With rollback the cubics would
    smear the step of the torque over the communication step before it.)"""
    return SUSPENDED.drive(fmus, LAUNCH, step, "derivatives", GRID).whole


def convergence(fmus: Fmus, truth: Table, steps: Sequence[float] = STEPS) -> Errors:
    """With all inputs held, with positions that follow the velocities beside them, and on straight lines."""
    kinds = {"positions held": ("held", {"follow": 0.0}), "held": ("held", {}), "derivatives": ("derivatives", {})}
    return {
        name: {h: SUSPENDED.error(fmus, LAUNCH.changed(**more), truth, h, exchange) for h in steps}
        for name, (exchange, more) in kinds.items()
    }


def drag_share(h: float, k: float = 60e3, mass: float = 334.7, duration: float = 2.5) -> float:
    """Share of the final speed lost to the drag k v h / 2 of a position held over the step.

    mass (kg): sprung mass, wheel and J_z / R^2.  duration (s): of the drive.
    """
    x = k * h / 2 * duration / mass
    return 1 - (1 - exp(-x)) / x
