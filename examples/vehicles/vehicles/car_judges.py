"""The car's manoeuvres in closed form: a car whose wheels never slip, on stiff bushings.

With m all masses, R the wheels' radius, m_t = m + 4 J_z / R^2 (four wheels), L the wheelbase and T the track:

    launch and braking   m_t a = (M_drive - s m g - brakes) / R; the rear axle gains (a I + m_B g (h_B - R) pitch) / L
    any bend             rear point on R = L / tan delta, so yaw rate = v tan(delta) / L at any speed: no understeer
    Ackermann            cot delta_outer - cot delta_inner = T / L
    steady circle        the outer wheels gain (a I + g roll (m_B (h_B - r) + 4 m_w r_0)) / T together

I = m_B h_B + 4 (m_w R + J_z / R): masses at their heights, and the wheels' spin that is sped up or turned. As the car
leans by the roll angle the masses move outwards from the wheels' centres, and the contact points inwards, by r_0 roll.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .car import J_Z, LAYOUT, M_WHEEL, MASS, R_0, TRACK, WHEELBASE, WHEELS, X_REAR, G, R
from .monolithic_car import rise
from .options import Manoeuvre

Table = dict[str, np.ndarray]
N_WHEELS = len(WHEELS)
M_T = MASS + N_WHEELS * J_Z / R**2
H_B, M_B = LAYOUT["chassis"]["h_B"], LAYOUT["chassis"]["m_B"]
HEIGHTS = M_B * H_B + N_WHEELS * M_WHEEL * R  # kg m
INERTIA = M_B * H_B + N_WHEELS * (M_WHEEL * R + J_Z / R)  # kg m
LEANING = M_B * (H_B - (R - R_0)) + N_WHEELS * M_WHEEL * R_0  # kg m, about the contact points, per roll angle
LEFT = [name for name, wheel in WHEELS.items() if wheel["y"] > 0]
RIGHT = [name for name, wheel in WHEELS.items() if wheel["y"] < 0]
REAR = [name for name, wheel in WHEELS.items() if wheel["x"] < 0]
FRONT = [name for name, wheel in WHEELS.items() if wheel["x"] > 0]


@dataclass(frozen=True)
class Finding:
    """One quantity as measured in a run, and of rigid links and wheels that never slip, where that is known."""

    what: str
    unit: str
    measured: float
    exact: float | None = None

    @property
    def error(self) -> float:
        """Relative."""
        return abs(self.measured - self.exact) / abs(self.exact)


def load(table: Table, wheels: list[str], at: np.ndarray | int) -> float:
    """Mean normal force of some wheels together over some instants."""
    return float(np.mean(sum(table[f"{w}.lambda_3"] for w in wheels)[at]))


def dive(table: Table, at: np.ndarray) -> float:
    """Moment of the chassis' weight as it pitches about its hubs, N m; positive towards the rear axle."""
    return -M_B * G * (H_B - R) * float(np.mean(table["pitch"][at]))


def mean_rate(table: Table, name: str, window: np.ndarray) -> float:
    """Slope of a straight line through a window."""
    return float(np.polyfit(table["time"][window], table[name][window], 1)[0])


def resistance(manoeuvre: Manoeuvre) -> tuple[float, float]:
    """Moment of rolling friction about all axles, N m, and gravity down the slope, m/s2."""
    return manoeuvre["s"] * MASS * G * np.cos(manoeuvre["slope"]), G * np.sin(manoeuvre["slope"])


def launch(table: Table, manoeuvre: Manoeuvre) -> list[Finding]:
    """Acceleration and load transfer in the last second of full torque."""
    t, off = table["time"], manoeuvre["t_off"]
    window = (t > off - 1) & (t < off)
    drag, grade = resistance(manoeuvre)
    a = (manoeuvre["M_0"] - drag - R * MASS * grade) / (R * M_T)
    gained = load(table, REAR, window) - load(table, REAR, 0)
    expected = (a * INERTIA + drag + grade * HEIGHTS + dive(table, window)) / WHEELBASE
    return [
        Finding("acceleration of the launch", "m/s2", mean_rate(table, "v", window), a),
        Finding("load moved to the rear axle by the launch", "N", gained, expected),
    ]


def standing(table: Table, manoeuvre: Manoeuvre) -> list[Finding]:
    """A car that its brakes hold on a slope, just before the drive torque comes, and at the end of the run."""
    t, (_, grade) = table["time"], resistance(manoeuvre)
    window = (t > manoeuvre["t_on"] - 0.1) & (t < manoeuvre["t_on"])
    found = []
    for at, when in ((window, "by the brakes"), (t > t[-1] - 0.1, "parked")):
        push = float(np.mean(sum(table[f"{w}.lambda_1"] for w in WHEELS)[at]))
        moved = load(table, REAR, at) - load(table, REAR, 0)
        expected = (grade * HEIGHTS + dive(table, at)) / WHEELBASE
        found.append(Finding(f"force of the road that holds the car, {when}", "N", push, MASS * grade))
        found.append(Finding(f"load moved to the rear axle by the slope, {when}", "N", moved, expected))
    return found


def braking(table: Table, manoeuvre: Manoeuvre) -> list[Finding]:
    """Instant and distance of the stop from the state at t_brake, and the load moved forwards."""
    t, begin, ramp = table["time"], manoeuvre["t_brake"], manoeuvre["ramp_M"]
    i = int(np.searchsorted(t, begin - 1e-9))
    fine = begin + np.arange(200001) * 1e-5 * (t[-1] - begin) / 2
    capacity = np.array([rise(x, begin, ramp) for x in fine]) * manoeuvre["B_0"]
    drag, grade = resistance(manoeuvre)
    a = (capacity + drag + R * MASS * grade) / (R * M_T)
    v = table["v"][i] - np.concatenate([[0.0], np.cumsum((a[1:] + a[:-1]) / 2 * np.diff(fine))])
    end = int(np.argmax(v <= 0))
    way = float(np.sum((v[1 : end + 1] + v[:end]) / 2 * np.diff(fine[: end + 1])))
    full = (t > begin + ramp + 0.5 * (fine[end] - begin - ramp)) & (t < fine[end] - 0.05)
    spins = np.max([np.abs(table[f"{w}.omega_z"]) for w in WHEELS], axis=0)
    stopped = int(np.argmax((t > begin) & (spins == 0)))
    found = [
        Finding("instant of the stop after the brakes come", "s", float(t[stopped] - begin), float(fine[end] - begin)),
        Finding("stopping distance", "m", float(table["X"][-1] - table["X"][i]), way),
    ]
    if full.any():
        moved = load(table, FRONT, full) - load(table, FRONT, 0)
        expected = (a[-1] * INERTIA - drag - grade * HEIGHTS - dive(table, full)) / WHEELBASE
        found.append(Finding("load moved to the front axle by the brakes", "N", moved, expected))
    return found


def bend(table: Table, _manoeuvre: Manoeuvre) -> list[Finding]:
    """Steady state at the end of a run with a constant steer angle."""
    last = table["time"] > table["time"][-1] - 0.5
    delta, v = float(np.mean(table["delta"][last])), float(np.mean(table["v"][last]))
    omega, roll = float(np.mean(table["omega"][last])), float(np.mean(table["roll"][last]))
    moved = (load(table, RIGHT, last) - load(table, LEFT, last)) / 2
    exact = (v * omega * INERTIA + G * LEANING * roll) / TRACK
    return [
        Finding("radius of the rear point's circle", "m", v / omega, WHEELBASE / np.tan(delta)),
        Finding("Ackermann, from the wheels' headings", "1", *_ackermann(table, last)),
        Finding("load moved outwards", "N", moved, exact),
    ]


def _ackermann(table: Table, at: np.ndarray) -> tuple[float, float]:
    """cot delta_outer - cot delta_inner of the foremost steered wheels, and T / L."""
    x = max(w["x"] for w in WHEELS.values() if w["steer"])
    inner, outer = sorted((n for n in WHEELS if WHEELS[n]["x"] == x), key=lambda n: -WHEELS[n]["y"])
    turned = [float(np.mean((table[f"{n}.psi"] - table["psi"])[at])) for n in (inner, outer)]
    apart = WHEELS[inner]["y"] - WHEELS[outer]["y"]
    return 1 / np.tan(turned[1]) - 1 / np.tan(turned[0]), apart / (x - X_REAR)


def understeer(table: Table) -> float:
    """Understeer gradient d(delta - atan(L kappa)) / d a_y in rad s2/m, over the run's part with a constant angle."""
    steady = table["time"] > 4.0
    kappa = table["omega"][steady] / table["v"][steady]
    a = table["omega"][steady] * table["v"][steady]
    return float(np.polyfit(a, table["delta"][steady] - np.arctan(WHEELBASE * kappa), 1)[0])


def closure(table: Table, _manoeuvre: Manoeuvre) -> list[Finding]:
    """The figure of eight after one lap: distance of the rear point from its start beside the way driven."""
    p = table["p"]
    x, y = (np.interp(2 * np.pi, p, table[name]) for name in ("X_R", "Y_R"))
    way = float(np.hypot(np.diff(table["X_R"]), np.diff(table["Y_R"]))[p[1:] <= 2 * np.pi].sum())
    gap = float(np.hypot(x - table["X_R"][0], y))
    return [Finding("figure of eight: gap after one lap, and its length", "m", gap, way)]


JUDGES = {f.__name__: f for f in (launch, standing, braking, bend, closure)}


def judge(table: Table, manoeuvre: Manoeuvre) -> list[Finding]:
    """All findings of a manoeuvre."""
    return [finding for name in manoeuvre.judges for finding in JUDGES[name](table, manoeuvre)]
