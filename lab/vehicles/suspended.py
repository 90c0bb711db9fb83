"""Suspended wheel: a quarter car, launched from rest by a step of the drive torque, or stopped on a wet road.

Coupled through F_X, F_Y, F_Z, M_3, M_brake and position, velocity and spin of the wheel, by values held over the
communication step or by straight lines (derivatives of first order); the guided wheel has its own wheel carrier. In the
end both move on together: with m all masses, R the wheel's rolling radius,

    (m + J_z / R^2) a = (M_drive - s m g) / R
"""

from collections.abc import Sequence
from math import exp, pi
from pathlib import Path

import numpy as np

from . import ssp
from .options import Manoeuvre, manoeuvres
from .vehicle import DRY_ROAD, Errors, Fmus, Table, Vehicle, beyond_dry, road, row_of_brake, upright

LAUNCH, ABS, IDEAL, LOCKED = manoeuvres("suspended").values()
GRID = 0.05  # s, where runs are compared; every step below divides it
STEPS = (0.005, 0.0025, 0.00125, 0.000625, 0.0003125)  # s
START = {"guided": True, "psi_start": 0.0, "theta_start": pi / 2, "phi_dot_start": 0.0, "X_O_start": 0.0}
M_WHEEL, J_Z, RADIUS, GRAVITY = 20.0, 1.8, 0.3 + 0.05, 9.81  # of the wheel; SI
CLOSE = 0.002  # a distance this near to its closed form, relative, agrees with it: a row of the table is 0.05 %


def mass(run: Manoeuvre = LAUNCH) -> float:
    """Of all, kg."""
    return run["m_B"] + M_WHEEL


def start(run: Manoeuvre) -> dict[str, dict[str, float]]:
    """Of the wheel; of the brake what follows from the wheel."""
    upright_at_v = upright(0.0, 0.0, 0.0, run["v"], 0.0, RADIUS) if run["v"] else {}
    per_N = run["share"] * run["mu_max"] * (RADIUS + J_Z / (mass(run) * RADIUS)) - run["s"]
    return {"wheel": START | road(run) | upright_at_v, "quarter_car": {"M_per_N": max(per_N, 0.0)}}


def with_centre(table: Table, run: Manoeuvre, _fmus: Fmus) -> Table:
    """With X and v of all masses' centre: the links' swing is not in them. A wheel that rolls counts with J_z / R^2
    more."""
    wheel = M_WHEEL + (0.0 if run.name in ("abs", "locked") else J_Z / RADIUS**2)
    at, speed = (
        (wheel * table[f"X_O{n}"] + run["m_B"] * table[f"X_B{n}"]) / (wheel + run["m_B"]) for n in ("", "_dot")
    )
    return table | {"X": at, "v": speed}


def verdict(table: Table, run: Manoeuvre) -> tuple[bool, list[str]]:
    """Its state at the end; no road gives more friction than a dry one."""
    least, most = table["lambda_3"].min(), SUSPENDED.grip(table)
    if most > DRY_ROAD:
        return False, [f"Failed: the wheel requires a friction coefficient of {beyond_dry(most)}."]
    if run.name != "launch":
        return stops(table, run)
    speed = f"Final speed: {table['X_O_dot'][-1]:.4f} m/s; smallest wheel load: {least:.1f} N"
    return True, [f"{speed}; friction required: {most:.2f}."]


def stops(table: Table, run: Manoeuvre) -> tuple[bool, list[str]]:
    """A stop beside its closed form; the anti-lock controller's between those of a sliding wheel and of full grip."""
    found, slides, broken = way(table, run), bool(table["slip_x"].any()), run.beyond
    if not np.isfinite(found):
        return False, [f"Failed: not at rest by {run.stop:g} s."]
    line, faults = f"Stopping distance from {run['v']:g} m/s: {found:.2f} m", []
    if slides == (run.name == "ideal"):
        faults = ["under the ideal brake the wheel slides" if slides else "the pedal does not lock the wheel"]
    elif run.name == "abs":
        locked, best = sliding_way(table, run), shortest(table, run)
        less = 100 * (1 - found / locked)
        line += (
            f", {abs(less):.1f} % {'less' if less >= 0 else 'more'} than locked ({locked:.2f} m); at best {best:.2f} m"
        )
        gains = run["mu_slide"] < run["mu_max"]  # else a locked wheel brakes as hard as any
        faults += ["the anti-lock controller stops no shorter than a locked wheel"] * (gains and less <= 0)
        faults += ["the anti-lock controller stops shorter than friction allows"] * (found < best)
    else:
        exact = (gripping_way if run.name == "ideal" else sliding_way)(table, run)
        line += f" (closed form: {exact:.2f} m)" if not broken else ""
        off = abs(found / exact - 1)
        faults += [f"{100 * off:.1f} % off the closed form"] * (not broken and off > CLOSE)
    lines = [f"{line}.", *[f"No closed form: {broken}."] * bool(broken), *(f"Failed: {fault}." for fault in faults)]
    return not faults, lines


def way(table: Table, run: Manoeuvre) -> float:
    """Of all masses' centre from t_brake to where the wheel first stands, m; nan where it does not."""
    begin, stands = row_of_brake(table, run), np.flatnonzero(table["X_O_dot"] <= 1e-3 * run["v"])
    if begin >= len(table["time"]) or not len(stands):
        return np.nan
    return float(table["X"][stands[0]] - table["X"][begin])


def gripping_way(table: Table, run: Manoeuvre) -> float:
    """Under the ideal brake: the deceleration goes from that of rolling resistance, a_0, to a = share mu_max g by
    a - (a - a_0) exp(-t / T_brake)."""
    a, before, lag = run["share"] * run["mu_max"] * GRAVITY, -acceleration(0.0, run["s"]), run["T_brake"]
    late = (a - before) * lag
    return (float(table["v"][row_of_brake(table, run)]) + late) ** 2 / (2 * a) - late * lag


def sliding_way(table: Table, run: Manoeuvre) -> float:
    """Of a wheel that locks: as measured until it first slides, then at mu_slide g."""
    lost, begin = int(np.argmax((table["time"] >= run["t_brake"]) & (table["slip_x"] > 0))), row_of_brake(table, run)
    before = float(table["X"][lost] - table["X"][begin])
    return before + float(table["v"][lost]) ** 2 / (2 * run["mu_slide"] * GRAVITY)


def shortest(table: Table, run: Manoeuvre) -> float:
    """No brake on this road stops in less."""
    return float(table["v"][row_of_brake(table, run)]) ** 2 / (2 * run["mu_max"] * GRAVITY)


SUSPENDED = Vehicle("suspended", start, verdict, complete=with_centre)


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
