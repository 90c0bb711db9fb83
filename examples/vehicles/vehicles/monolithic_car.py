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

from .car_judges import rise
from .layout import MANOEUVRES, MASS, TOO_FAST, WHEELBASE, WHEELS, X_REAR
from .monolithic import Answer, Joint, Load, cross, dot, lever
from .options import EXAMPLES, Manoeuvre, file, starts

FOLDER = EXAMPLES / "tests"
GRID = 0.25  # s
OF_WHEELS = tuple(f"{w}.{n}" for w in WHEELS for n in ("lambda_3", "omega_z"))
COLUMNS = ("time", *file("car")["compared"], "X_R", "Y_R", "delta", "a_y", "beta", *OF_WHEELS)
NAMES = tuple(name for name in MANOEUVRES if name != TOO_FAST.name)
OF = {key: np.array([w[key] for w in WHEELS.values()]) for key in ("x", "y", "k", "c", "steer", "drive", "brake")}
BARS = [(i, list(WHEELS).index(w["bar_to"]), w["k_bar"]) for i, w in enumerate(WHEELS.values()) if "bar_to" in w]


def path(o: dict[str, float], p: complex) -> tuple[complex, complex]:
    """Point P(p) of the driver's path: X, Y."""
    if o["path"] == 1:
        s, c = np.sin(p), np.cos(p)
        reach = o["size"] / np.sqrt(2) * s / (1 + c**2)
        return reach * (1 + c), reach * (c - 1)
    out, back = (np.tanh((p - o[end]) / o["length"]) for end in ("x_out", "x_back"))
    return p, o["width"] / 2 * (out - back)


def tangent(o: dict[str, float], p: float) -> complex:
    """dP/dp as X + i Y, by a complex step, which has no error."""
    return complex(*(of.imag / 1e-30 for of in path(o, p + 1e-30j)))


def curvature(o: dict[str, float], p: float) -> float:
    """Of the path, positive to the left."""
    h = 1e-5  # of the central difference: errors of some 1e-10
    d, dd = tangent(o, p), (tangent(o, p + h) - tangent(o, p - h)) / (2 * h)
    return (d.conjugate() * dd).imag / abs(d) ** 3


class Car(Joint):
    """One manoeuvre's parameters and right-hand side."""

    n, size = len(WHEELS), 21

    def __init__(self, manoeuvre: Manoeuvre) -> None:
        self.o, self.c = (starts(model) | manoeuvre.of(model) for model in ("driver", "chassis"))
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
            back = d.conjugate() / abs(d)  # from X + i Y to along + i left of the path
            away, turned = back * (complex(*point[:2]) - complex(*path(o, p))), back * np.exp(1j * heading)
            ahead = curvature(o, p + o["T_delta"] * v / abs(d))
            wanted += np.arctan(WHEELBASE * (ahead - o["k_y"] * away.imag - o["k_psi"] * turned.imag))
            p_dot = (v * turned.real + 4 * away.real) / abs(d)
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
        driver, drive, capacity = self.driver(t, y)
        angle, rate = self.steering(y[18], driver[0])
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
        M -= drive * OF["drive"][:, None] * a
        return Load(F=f @ turn.T, M=M, brake=capacity * OF["brake"], driver=driver)

    def own_rates(self, _t: float, y: np.ndarray, load: Load, answer: Answer) -> np.ndarray:
        """Of chassis and driver. Of the moment about an axle the chassis carries the brake's part."""
        c, turn, w = self.c, y[6:15].reshape(3, 3), y[15:18]
        centres, a, _ = self.wheels(y)
        total = np.maximum(load.brake + self.kind.s * answer.force[:, 2], 1e-300)
        carried = load.M + (np.where(load.brake > 0, load.brake / total, 0.0) * answer.tau)[:, None] * a
        moment = -(carried + cross(centres - y[:3], load.F)).sum(axis=0)
        J = (turn * [c["J_1"], c["J_2"], c["J_3"]]) @ turn.T
        w_dot = np.linalg.solve(J, moment - cross(w, J @ w))
        v_dot = -load.F.sum(axis=0) / c["m_B"] + self.kind.gravity
        return np.concatenate([y[3:6], v_dot, cross(w[None], turn.T).T.ravel(), w_dot, load.driver])

    def columns(self, _t: float, y: np.ndarray, _load: Load, answer: Answer) -> dict[str, float]:
        """What is compared, at one instant."""
        turn, (point, v, heading), (_, a, spin) = y[6:15].reshape(3, 3), self.rear(y), self.wheels(y)
        back = np.exp(-1j * heading)  # from X + i Y to along + i left
        moved, pushed = (back * complex(*x) for x in (y[3:5], answer.force[:, :2].sum(axis=0)))
        beta = np.arctan(moved.imag / moved.real) if abs(moved.real) > 0.01 else 0.0
        angles = {"psi": heading, "roll": np.arcsin(turn[2, 1]), "pitch": -np.arcsin(turn[2, 0]), "beta": beta}
        of_car = {"a_y": pushed.imag / MASS, "v": v, "omega": y[17], "delta": y[18], "p": y[20]}
        places = dict(zip(("X", "Y", "Z", "X_R", "Y_R"), (*y[:3], *point[:2]), strict=True))
        of_wheels = {f"lambda_{k + 1}": answer.force[:, k] for k in range(3)} | {"omega_z": dot(a, spin)[:, 0]}
        wheels = {f"{wheel}.{n}": x[i] for n, x in of_wheels.items() for i, wheel in enumerate(WHEELS)}
        return places | angles | of_car | wheels


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


if __name__ == "__main__":
    for name in sys.argv[1:] or NAMES:
        found = solve(MANOEUVRES[name], GRID, 1e-10)
        write_table(FOLDER / f"car_{name}.csv", {column: found[column] for column in COLUMNS})
        print(f"car_{name}.csv")
