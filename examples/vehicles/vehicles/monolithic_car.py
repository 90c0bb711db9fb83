"""The same car as one set of equations: chassis, struts, driver and wheels integrated together by SciPy.

The independent check of the coupled car: wheels by axle vectors (monolithic.py), the chassis by its rotation matrix and
its angular velocity in fixed axes, the driver's programmes and paths written again from their equations. Only the
layout car.toml, the start values of the tables and the manoeuvres' parameters are shared with the FMUs.

Its own states: chassis r, v, rotation matrix, w (fixed axes); driver delta, integral, p.

The manoeuvres over their full length are kept as tables, tests/car_NAME.csv:

    PYTHONPATH=tools:examples/vehicles:tests python -m vehicles.monolithic_car [NAME...]

writes them again, which takes some minutes. The tests integrate a part of them once more.
"""

import sys

import numpy as np
from reference.model import Wheel
from reference.tables import read_table, write_table

from . import errors
from .car_judges import rise
from .layout import COMPARED, MANOEUVRES, MASS, TOO_FAST, WHEELBASE, WHEELS, X_REAR, chassis_start, driver_start
from .monolithic import Answer, Joint, Load, cross, dot, lever
from .options import EXAMPLES, Manoeuvre, starts

FOLDER = EXAMPLES / "tests"
GRID = 0.25  # s
FINE = 1e-10  # relative and absolute, of each step
OF_WHEELS = tuple(f"{w}.{n}" for w in WHEELS for n in ("lambda_3", "omega_z"))
COLUMNS = ("time", *COMPARED, "X_R", "Y_R", "delta", "a_y", "beta", *OF_WHEELS)
NAMES = tuple(name for name in MANOEUVRES if name != TOO_FAST.name)
OF = {key: np.array([w[key] for w in WHEELS.values()]) for key in ("x", "y", "k", "c", "steer", "drive", "brake")}
BARS = [(i, list(WHEELS).index(w["bar_to"]), w["k_bar"]) for i, w in enumerate(WHEELS.values()) if "bar_to" in w]


def path(o: dict[str, float], p: complex) -> np.ndarray:
    """Point P(p) of the driver's path."""
    if o["path"] == 1:
        s, c = np.sin(p), np.cos(p)
        return o["size"] / np.sqrt(2) * s / (1 + c**2) * np.array([1 + c, c - 1])
    out, back = (np.tanh((p - o[end]) / o["length"]) for end in ("x_out", "x_back"))
    return np.array([p, o["width"] / 2 * (out - back)])


def tangent(o: dict[str, float], p: float) -> np.ndarray:
    """dP/dp, by a complex step, which has no error."""
    return path(o, p + 1e-30j).imag / 1e-30


def curvature(o: dict[str, float], p: float) -> float:
    """Of the path, positive to the left."""
    h = 1e-5  # of the central difference: errors of some 1e-10
    d, dd = tangent(o, p), (tangent(o, p + h) - tangent(o, p - h)) / (2 * h)
    return float((d[0] * dd[1] - d[1] * dd[0]) / np.hypot(*d) ** 3)


class Car(Joint):
    """One manoeuvre's parameters and right-hand side."""

    n, size = len(WHEELS), 21

    def __init__(self, manoeuvre: Manoeuvre) -> None:
        self.o = starts("driver") | driver_start(manoeuvre)
        self.c = starts("chassis") | chassis_start(manoeuvre)
        self.v = manoeuvre["v"]
        self.kind = Wheel(**{name: self.c[name] for name in ("s", "slope", "slope_direction")})
        self.R = self.kind.r_0 + self.kind.r
        self.hub = np.column_stack([OF["x"], OF["y"], np.full(self.n, self.R - self.c["h_B"])])
        base = np.column_stack([np.ones(self.n), OF["x"], OF["y"]])
        weight = (MASS - self.n * self.kind.m) * self.kind.g * np.cos(self.kind.slope)
        self.share = base @ np.linalg.solve(base.T @ base, [weight, 0, 0])

    def start(self) -> np.ndarray:
        """Level and upright, rolling along X."""
        r = np.array([self.c["X_start"], 0.0, self.c["h_B"]])
        axles, spins = np.tile([0.0, -1.0, 0.0], self.n), np.tile([0.0, self.v / self.R, 0.0], self.n)
        return np.concatenate([r, [self.v, 0, 0], np.eye(3).ravel(), np.zeros(6), (r + self.hub).ravel(), axles, spins])

    def rear(self, y: np.ndarray) -> tuple[np.ndarray, float, float]:
        """Rear point, speed along the heading, heading."""
        turn, w = y[6:15].reshape(3, 3), y[15:18]
        arm = turn @ [X_REAR, 0.0, self.hub[0, 2]]
        velocity = y[3:6] + cross(w, arm)
        heading = np.arctan2(turn[1, 0], turn[0, 0])
        return y[:3] + arm, float(velocity[0] * np.cos(heading) + velocity[1] * np.sin(heading)), heading

    def driver(self, t: float, y: np.ndarray) -> tuple[np.ndarray, float, float]:
        """Rates of the driver's states, drive torque, capacity of the brakes."""
        o = self.o
        delta, integral, p = y[18:21]
        point, v, heading = self.rear(y)
        wanted, p_dot = o["delta_0"] * rise(t, o["t_delta"], o["ramp_delta"]), 0.0
        if o["path"]:
            d = tangent(o, p)
            away, along = point[:2] - path(o, p), d / np.hypot(*d)
            ahead = curvature(o, p + o["T_delta"] * v / np.hypot(*d))
            left = along[0] * away[1] - along[1] * away[0]
            turned = along[0] * np.sin(heading) - along[1] * np.cos(heading)
            wanted += np.arctan(WHEELBASE * (ahead - o["k_y"] * left - o["k_psi"] * turned))
            p_dot = (v * (np.array([np.cos(heading), np.sin(heading)]) @ along) + 4 * away @ along) / np.hypot(*d)
        lost = o["v_0"] + (o["v_1"] - o["v_0"]) * rise(t, o["t_v"], o["ramp_v"]) - v
        drive = o["k_v"] * lost + o["k_i"] * integral
        drive += o["M_0"] * (rise(t, o["t_on"], o["ramp_M"]) - rise(t, o["t_off"], o["ramp_M"]))
        hold = o["B_hold"] * rise(-t, -o["t_release"] - o["ramp_M"], o["ramp_M"])
        rates = np.array([(wanted - delta) / o["T_delta"], lost, p_dot])
        return rates, drive, o["B_0"] * rise(t, o["t_brake"], o["ramp_M"]) + hold

    def steering(self, delta: float, rate: float) -> tuple[np.ndarray, np.ndarray]:
        """Angles of the wheels and their rates: the axles meet on the line of the wheels that are not steered."""
        x, y, on = OF["x"] - X_REAR, OF["y"], OF["steer"]
        c, s = np.cos(delta), np.sin(delta)
        along, across = WHEELBASE * c - y * s, x * s
        change = (x * c * along + x * s * (WHEELBASE * s + y * c)) / (along**2 + across**2)
        return on * np.arctan2(across, along), on * change * rate

    def load(self, t: float, y: np.ndarray) -> Load:
        """By struts, bushings, drive and brakes."""
        c, turn, w = self.c, y[6:15].reshape(3, 3), y[15:18]
        rates, drive, capacity = self.driver(t, y)
        angle, rate = self.steering(y[18], rates[0])
        centres, a, spin = self.wheels(y)
        arm = centres - y[:3]
        way = arm @ turn - self.hub
        way_dot = (cross(spin, lever(self.kind, a, spin)[0]) - y[3:6] - cross(w[None], arm)) @ turn
        f = -c["k_h"] * way - c["c_h"] * way_dot
        beyond = np.sign(way[:, 2]) * np.maximum(np.abs(way[:, 2]) - c["travel"], 0) ** 2
        f[:, 2] = -self.share - OF["k"] * way[:, 2] - OF["c"] * way_dot[:, 2] - c["k_stop"] * beyond
        for i, j, k in BARS:
            bar = k * (way[i, 2] - way[j, 2])
            f[i, 2] -= bar
            f[j, 2] += bar
        axle = np.column_stack([np.sin(angle), -np.cos(angle), np.zeros(self.n)]) @ turn.T
        relative = spin - w - rate[:, None] * turn[:, 2]
        M = c["k_a"] * cross(a, axle) - c["c_a"] * (relative - a * dot(a, relative))
        return Load(F=f @ turn.T, M=M - drive * OF["drive"][:, None] * a, brake=capacity * OF["brake"])

    def own_rates(self, t: float, y: np.ndarray, load: Load, answer: Answer) -> np.ndarray:
        """Of chassis and driver. Of the moment about an axle the chassis carries the brake's part."""
        c, turn, w = self.c, y[6:15].reshape(3, 3), y[15:18]
        centres, a, _ = self.wheels(y)
        total = np.maximum(load.brake + self.kind.s * answer.force[:, 2], 1e-300)
        carried = load.M + (np.where(load.brake > 0, load.brake / total, 0.0) * answer.tau)[:, None] * a
        moment = -(carried + cross(centres - y[:3], load.F)).sum(axis=0)
        J = (turn * [c["J_1"], c["J_2"], c["J_3"]]) @ turn.T
        w_dot = np.linalg.solve(J, moment - cross(w, J @ w))
        v_dot = -load.F.sum(axis=0) / c["m_B"] + self.kind.gravity
        return np.concatenate([y[3:6], v_dot, cross(w[None], turn.T).T.ravel(), w_dot, self.driver(t, y)[0]])

    def columns(self, _t: float, y: np.ndarray, _load: Load, answer: Answer) -> dict[str, float]:
        """What is compared, at one instant."""
        turn = y[6:15].reshape(3, 3)
        point, v, heading = self.rear(y)
        _, a, spin = self.wheels(y)
        back = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])  # along, to the left
        along, left = back @ y[3:5]
        of_wheels = {f"lambda_{k + 1}": answer.force[:, k] for k in range(3)} | {"omega_z": dot(a, spin)[:, 0]}
        return {
            **dict(zip(("X", "Y", "Z"), y[:3], strict=True)),
            "a_y": back[1] @ answer.force[:, :2].sum(axis=0) / MASS,
            "beta": np.arctan(left / along) if abs(along) > 0.01 else 0.0,
            **{"psi": heading, "roll": np.arcsin(turn[2, 1]), "pitch": -np.arcsin(turn[2, 0])},
            **{"v": v, "omega": y[17], "X_R": point[0], "Y_R": point[1], "delta": y[18], "p": y[20]},
            **{f"{wheel}.{n}": x[i] for n, x in of_wheels.items() for i, wheel in enumerate(WHEELS)},
        }


def lift_off(manoeuvre: Manoeuvre) -> tuple[str, float]:
    """Which wheel lifts off first, and when [s], in a manoeuvre that is too fast for the car."""
    wheel, time = Car(manoeuvre).solve(np.array([0.0, manoeuvre.stop]), 1e-8)[1]
    return list(WHEELS)[wheel], time


def solve(manoeuvre: Manoeuvre, grid: float, tolerance: float, stop: float | None = None) -> dict[str, np.ndarray]:
    """The manoeuvre, or its begin up to `stop` [s], on a grid [s]."""
    times = np.arange(round((stop or manoeuvre.stop) / grid) + 1) * grid
    return Car(manoeuvre).solve(times, tolerance)[0]


def read(name: str) -> dict[str, np.ndarray]:
    """A manoeuvre from its table; columns as those of a run of the car."""
    return dict(zip(COLUMNS, read_table(str(FOLDER / f"car_{name}")).values(), strict=True))


def apart(table: dict[str, np.ndarray], truth: dict[str, np.ndarray]) -> dict[str, float]:
    """Error of each compared variable."""
    every, count = round(GRID / (table["time"][1] - table["time"][0])), len(truth["time"])
    assert np.allclose(table["time"][::every][:count], truth["time"]), "the run has other instants than the table"
    on_grid = {name: table[name][::every][:count] for name in COMPARED}
    return errors.apart(on_grid, truth, COMPARED)


def main() -> None:
    """The tables named, or all."""
    for name in sys.argv[1:] or NAMES:
        found = solve(MANOEUVRES[name], GRID, FINE)
        write_table(FOLDER / f"car_{name}.csv", {column: found[column] for column in COLUMNS})
        print(f"car_{name}.csv")


if __name__ == "__main__":
    main()
