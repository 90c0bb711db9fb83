"""Modelica's wheel sets (RollingWheelSetDriving and RollingWheelSetPulling of the Modelica Standard Library 4.0).

Two knife-edged wheels upright on one rigid axle, a small body 0.2 m ahead of its middle; either torques drive the
wheels, or a force in fixed axes pulls the body. Wheel 1 is the left one. With rigid links only the forces along the
heading and the moments about the vertical count: a force (l, t) at the body is the pair of drive torques
R (l -+ a t / b) / 2. So both scenes become drive torques, which depend on time and heading alone.
"""

from collections.abc import Callable
from functools import cache
from math import cos, pi, sin
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from wheelfmu.truth.others.wheels import read
from wheelfmu.vehicles.axle import AXLE, WHEELS
from wheelfmu.vehicles.master import Component, Master, loaded
from wheelfmu.vehicles.vehicle import upright

Array = NDArray[np.float64]
Torques = Callable[[float, float], tuple[float, float]]  # of time and heading: left and right, positive forwards
R, B, A = 0.1, 0.25, 0.2  # m: wheels' radius, half the track, body ahead of the middle
WHEEL = {"m": 0.5, "r_0": R, "r": 0.0, "J_x": 0.02, "J_y": 0.02, "J_z": 0.01, "keep_contact": True}
BODY = {"m_B": 0.01, "J_1": 0.001, "J_2": 0.001, "J_3": 0.001, "a": A, "b": B, "R": R}
START = 0.1  # m, X and Y of the middle
SOFT = 300.0  # N/m, the unit of stiffness
COMPARED = ("x", "y", "phi")


def driving(t: float, _psi: float) -> tuple[float, float]:
    return -2 * sin(2 * pi * t), -2 * cos(2 * pi * t)


def pulling(t: float, psi: float) -> tuple[float, float]:
    """1 N along X until 1 s, 2 N along Y from 2 s on, on straight lines between."""
    share = min(max(t - 1, 0.0), 1.0)
    X, Y = 1 - share, 2 * share
    along, across = X * cos(psi) + Y * sin(psi), Y * cos(psi) - X * sin(psi)
    return R * (along - A * across / B) / 2, R * (along + A * across / B) / 2


SCENES: dict[str, Torques] = {"driving": driving, "pulling": pulling}


def table(scene: str) -> dict[str, Array]:
    """Their result, thinned."""
    return read(f"modelica_{scene}")


@cache
def rigid(scene: str) -> dict[str, Array]:
    """The rigid wheel set at the table's instants."""
    return rigid_at(scene, table(scene)["time"])


def rigid_at(scene: str, times: Array) -> dict[str, Array]:
    """x, y, heading, speed and yaw rate of the rigid wheel set at `times`, rising from 0.

    m_t v' = S w^2 + (M_l + M_r) / R and I_t w' = -S v w + b (M_r - M_l) / R, as in examples/vehicles/axle.
    """
    torques = SCENES[scene]
    m, J_x, J_z = WHEEL["m"], WHEEL["J_x"], WHEEL["J_z"]
    m_t, S = 2 * m + BODY["m_B"] + 2 * J_z / R**2, BODY["m_B"] * A
    I_t = 2 * (J_x + m * B**2 + J_z * (B / R) ** 2) + BODY["J_3"] + BODY["m_B"] * A**2

    def rate(t: float, y: Array) -> list[float]:
        _, _, psi, v, w = y
        left, right = torques(t, psi)
        forces = (S * w * w + (left + right) / R) / m_t, (-S * v * w + B * (right - left) / R) / I_t
        return [v * cos(psi), v * sin(psi), w, *forces]

    y, columns = np.array([START, START, 0.0, 0.0, 0.0]), []
    for begin, end in ((0.0, 1.0), (1.0, 2.0), (2.0, 3.0)):  # the pull has kinks there
        at = times[(times >= begin) & ((times < end) | (end == 3))]
        done = solve_ivp(rate, (begin, end), y, "DOP853", np.union1d(at, [end]), rtol=1e-13, atol=1e-14)
        y = done.y[:, -1]
        columns.append(done.y[:, : len(at)])
    return dict(zip(("x", "y", "phi", "v", "w"), np.hstack(columns), strict=True))


def driver(master: Master, torques: Torques) -> Callable[[float], None]:
    """Sets the drive torques at a communication point, with their first derivatives."""
    axle, wheels = master.components["axle"], [master.components[wheel] for wheel in WHEELS]
    heading, (torque,) = axle.references(["psi", "omega"]), wheels[0].references(["M_3"])
    h = 1e-6  # s, of the central difference that gives the rate

    def act(t: float) -> None:
        psi, omega = axle.fmu.getReal(heading)
        now, before, after = (torques(t + d, psi + omega * d) for d in (0.0, -h, h))
        for k, wheel in enumerate(wheels):
            wheel.fmu.setReal([torque], [-now[k]])
            wheel.fmu.setRealInputDerivatives([torque], [1], [-(after[k] - before[k]) / (2 * h)])

    return act


def coupled(fmus: dict[str, Path], scene: str, factor: float, step: float, stop: float = 3.0) -> dict[str, Array]:
    """Two wheel.fmu on axle.fmu with links `factor` times as stiff as SOFT, at the table's instants up to `stop`."""
    k = SOFT * factor
    links = {"k": k, "c": k / 100, "k_a": k / 10, "c_a": k / 1000, "k_p": k / 10, "c_p": k / 1000}
    place = {"X_start": START, "Y_start": START, "inner_step": step / 4, **links}
    wheels = [
        Component(wheel, fmus["wheel"], {**WHEEL, **upright(START, START + y, 0.0, 0.0, 0.0, R)})
        for wheel, y in zip(WHEELS, (B, -B), strict=True)
    ]
    free = [(source, sink) for source, sink in AXLE.connections if sink[1] != "M_3"]
    parts = [*wheels, Component("axle", fmus["axle"], {**BODY, **place})]
    with loaded(*parts):
        master, rows, every = Master(parts, free), [], round(0.3 / step)
        drive, record = driver(master, SCENES[scene]), [("axle", name) for name in ("X", "Y", "psi")]
        for k, t in enumerate(master.steps(stop, step, "derivatives")):
            if k % every == 0:
                rows.append(master.read(record))
            drive(t)
    return dict(zip(COMPARED, np.transpose(rows), strict=True))


def distance(found: dict[str, Array], truth: dict[str, Array]) -> float:
    """Largest difference of x, y (m) and heading (rad)."""
    return max(float(np.abs(found[name] - truth[name][: len(found[name])]).max()) for name in COMPARED)


def limit(runs: list[dict[str, Array]]) -> dict[str, Array]:
    """For rigid links, out of three runs, each twice as stiff as the one before: errors 1/k and 1/k^2 vanish."""
    return {name: (8 * runs[2][name] - 6 * runs[1][name] + runs[0][name]) / 3 for name in COMPARED}
