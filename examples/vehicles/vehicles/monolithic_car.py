"""The same car as one set of equations: chassis, struts, driver and wheels integrated together by SciPy.

The independent check of the coupled car: wheels by axle vectors (rolling_wheels.py), the chassis by its rotation matrix
and its angular velocity in fixed axes, the driver's programmes and paths written again from their equations. Only the
layout car.toml, the start values of the tables and the manoeuvres' parameters are shared with the FMUs.

State: chassis r, v, rotation matrix, w (fixed axes); driver delta, integral, p; wheels O, a, w.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from reference.model import Wheel
from scipy.integrate import solve_ivp

from .layout import LAYOUT, MASS, chassis_start, driver_start
from .options import Manoeuvre, starts
from .rolling_wheels import Answer, Law, cross, dot, respond

TOLERANCE = 1e-9
BODY, DRIVER = 18, 3


def rise(t: float, begin: float, duration: float) -> float:
    """From 0 to 1, with continuous second derivatives."""
    z = min(max((t - begin) / duration, 0.0), 1.0)
    return z**3 * (10 - 15 * z + 6 * z**2)


class Path:
    """Point, tangent and curvature of the driver's path as functions of its parameter."""

    def __init__(self, o: dict[str, float]) -> None:
        self.o = o

    def point(self, p: float) -> np.ndarray:
        """X, Y."""
        o = self.o
        if o["path"] == 1:
            x = o["size"] * np.sin(p) / (1 + np.cos(p) ** 2)
            return np.array([x + x * np.cos(p), x * np.cos(p) - x]) / np.sqrt(2)
        out, back = (np.tanh((p - o[end]) / o["length"]) for end in ("x_out", "x_back"))
        return np.array([p, o["width"] / 2 * (out - back)])

    def tangent(self, p: complex) -> np.ndarray:
        """dP/dp."""
        o = self.o
        if o["path"] == 1:
            c = np.cos(p)
            dx, dy = c * (3 - c**2), 3 * c**2 - 1
            return o["size"] * np.array([dx + dy, dy - dx]) / (1 + c**2) ** 2 / np.sqrt(2)
        out, back = (np.cosh((p - o[end]) / o["length"]) ** -2 for end in ("x_out", "x_back"))
        return np.array([1.0, o["width"] / 2 * (out - back) / o["length"]])

    def curvature(self, p: float) -> float:
        """Positive to the left."""
        h = 1e-30  # of the complex step, which has no error
        d, dd = self.tangent(p), self.tangent(p + 1j * h).imag / h
        return float((d[0] * dd[1] - d[1] * dd[0]) / np.hypot(*d) ** 3)


class Car:
    """One manoeuvre's parameters and right-hand side."""

    def __init__(self, manoeuvre: Manoeuvre) -> None:
        wheels = list(LAYOUT["wheel"].values())
        self.o = starts("driver") | driver_start(manoeuvre)
        self.c = starts("chassis") | chassis_start(manoeuvre)
        self.path, self.n = Path(self.o), len(wheels)
        self.kind = Wheel(**{name: self.c[name] for name in ("s", "slope", "slope_direction")})
        of = {key: np.array([w[key] for w in wheels]) for key in ("x", "y", "k", "c", "steer", "drive", "brake")}
        self.of, self.v = of, manoeuvre["v"]
        self.R_0 = self.kind.r_0 + self.kind.r
        self.hub = np.column_stack([of["x"], of["y"], np.full(self.n, self.R_0 - self.c["h_B"])])
        steered = of["steer"] > 0
        self.x_R = of["x"][~steered].mean()
        self.L = of["x"][steered].mean() - self.x_R
        base = np.column_stack([np.ones(self.n), of["x"], of["y"]])
        weight = (MASS - self.n * self.kind.m) * self.kind.g * np.cos(self.kind.slope)
        self.share = base @ np.linalg.solve(base.T @ base, [weight, 0, 0])
        names = list(LAYOUT["wheel"])
        self.bars = [(i, names.index(w["bar_to"]), w["k_bar"]) for i, w in enumerate(wheels) if "bar_to" in w]

    def start(self) -> np.ndarray:
        """Level and upright, rolling along X."""
        a = np.tile([0.0, -1.0, 0.0], (self.n, 1))
        spin = np.tile([0.0, self.v / self.R_0, 0.0], (self.n, 1))
        X = self.c.get("X_start", 0.0)
        centres = self.hub + [X, 0.0, self.c["h_B"]]
        body = np.concatenate([[X, 0, self.c["h_B"], self.v, 0, 0], np.eye(3).ravel(), np.zeros(3)])
        return np.concatenate([body, np.zeros(DRIVER), centres.ravel(), a.ravel(), spin.ravel()])

    def wheels(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """O, a, w."""
        return tuple(y[BODY + DRIVER :].reshape(3, self.n, 3))

    def rear(self, y: np.ndarray) -> tuple[np.ndarray, float, float]:
        """Rear point, speed along the heading, heading."""
        turn, w = y[6:15].reshape(3, 3), y[15:18]
        arm = turn @ [self.x_R, 0.0, self.hub[0, 2]]
        velocity = y[3:6] + cross(w, arm)
        heading = np.arctan2(turn[1, 0], turn[0, 0])
        return y[:3] + arm, float(velocity[0] * np.cos(heading) + velocity[1] * np.sin(heading)), heading

    def driver(self, t: float, y: np.ndarray) -> tuple[np.ndarray, float, float]:
        """Rates of the driver's states, drive torque, capacity of the brakes."""
        o = self.o
        delta, integral, p = y[BODY : BODY + DRIVER]
        point, v, heading = self.rear(y)
        wanted, p_dot = o["delta_0"] * rise(t, o["t_delta"], o["ramp_delta"]), 0.0
        if o["path"]:
            d = self.path.tangent(p)
            away = point[:2] - self.path.point(p)
            along = d / np.hypot(*d)
            ahead = self.path.curvature(p + o["T_delta"] * v / np.hypot(*d))
            left = along[0] * away[1] - along[1] * away[0]
            turned = along[0] * np.sin(heading) - along[1] * np.cos(heading)
            wanted += np.arctan(self.L * (ahead - o["k_y"] * left - o["k_psi"] * turned))
            p_dot = (v * (np.array([np.cos(heading), np.sin(heading)]) @ along) + 4 * away @ along) / np.hypot(*d)
        lost = o["v_0"] + (o["v_1"] - o["v_0"]) * rise(t, o["t_v"], o["ramp_v"]) - v
        drive = o["k_v"] * lost + o["k_i"] * integral
        drive += o["M_0"] * (rise(t, o["t_on"], o["ramp_M"]) - rise(t, o["t_off"], o["ramp_M"]))
        rates = np.array([(wanted - delta) / o["T_delta"], lost, p_dot])
        hold = o["B_hold"] * rise(-t, -o["t_release"] - o["ramp_M"], o["ramp_M"])
        return rates, drive, o["B_0"] * rise(t, o["t_brake"], o["ramp_M"]) + hold

    def steering(self, delta: float, rate: float) -> tuple[np.ndarray, np.ndarray]:
        """Angles of the wheels and their rates: the axles meet on the line of the wheels that are not steered."""
        x, y, on = self.of["x"] - self.x_R, self.of["y"], self.of["steer"]
        c, s = np.cos(delta), np.sin(delta)
        along, across = self.L * c - y * s, x * s
        angle = on * np.arctan2(across, along)
        change = (x * c * along + x * s * (self.L * s + y * c)) / (along**2 + across**2)
        return angle, on * change * rate

    def links(self, y: np.ndarray, angle: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forces and moments on the wheels in fixed axes, and the wheels' places from the chassis."""
        c, turn, w = self.c, y[6:15].reshape(3, 3), y[15:18]
        centres, a, spin = self.wheels(y)
        rho = self._levers(a)
        arm = centres - y[:3]
        way = arm @ turn - self.hub
        way_dot = (cross(spin, rho) - y[3:6] - cross(w[None], arm)) @ turn
        f = np.empty_like(way)
        f[:, :2] = -c["k_h"] * way[:, :2] - c["c_h"] * way_dot[:, :2]
        beyond = np.sign(way[:, 2]) * np.maximum(np.abs(way[:, 2]) - c["travel"], 0) ** 2
        f[:, 2] = -self.share - self.of["k"] * way[:, 2] - self.of["c"] * way_dot[:, 2] - c["k_stop"] * beyond
        for i, j, k in self.bars:
            bar = k * (way[i, 2] - way[j, 2])
            f[i, 2] -= bar
            f[j, 2] += bar
        axle = np.column_stack([np.sin(angle), -np.cos(angle), np.zeros(self.n)]) @ turn.T
        relative = spin - w - rate[:, None] * turn[:, 2]
        M = c["k_a"] * cross(a, axle) - c["c_a"] * (relative - a * dot(a, relative))
        return f @ turn.T, M, arm

    def _levers(self, a: np.ndarray) -> np.ndarray:
        up = np.array([0.0, 0.0, 1.0]) - a[:, 2:] * a
        return self.kind.r_0 * up / np.sqrt(dot(up, up)) + [0.0, 0.0, self.kind.r]

    def answer(self, t: float, y: np.ndarray, sigma: np.ndarray) -> tuple[np.ndarray, Answer, np.ndarray, np.ndarray]:
        """Driver's rates, the wheels' answer, and force and moment on the chassis in fixed axes."""
        rates, drive, capacity = self.driver(t, y)
        F, M, arm = self.links(y, *self.steering(y[BODY], rates[0]))
        _, a, spin = self.wheels(y)
        torque = -drive * self.of["drive"][:, None] * a
        brake = capacity * self.of["brake"]
        answer = respond(self.kind, a, spin, (F, M + torque), Law(sigma, brake))
        part = np.where(brake > 0, brake / np.maximum(brake + self.kind.s * answer.force[:, 2], 1e-300), 0.0)
        carried = M + torque + (part * answer.tau)[:, None] * a
        return rates, answer, -F.sum(axis=0), -(carried + cross(arm, F)).sum(axis=0)

    def rate(self, t: float, y: np.ndarray, sigma: np.ndarray) -> np.ndarray:
        """dy/dt on the friction branches sigma."""
        c, turn, w = self.c, y[6:15].reshape(3, 3), y[15:18]
        driver, answer, force, moment = self.answer(t, y, sigma)
        J = (turn * [c["J_1"], c["J_2"], c["J_3"]]) @ turn.T
        w_dot = np.linalg.solve(J, moment - cross(w, J @ w))
        v_dot = force / c["m_B"] + self.kind.gravity
        _, a, spin = self.wheels(y)
        turn_dot = cross(w[None], turn.T).T
        wheels = np.concatenate([answer.v.ravel(), cross(spin, a).ravel(), answer.w_dot.ravel()])
        return np.concatenate([y[3:6], v_dot, turn_dot.ravel(), w_dot, driver, wheels])

    def margins(self, t: float, y: np.ndarray, sigma: np.ndarray) -> np.ndarray:
        """Of each wheel what ends its branch at zero: sigma a w rolling, s N + B - |tau| held; 1 without friction."""
        _, a, spin = self.wheels(y)
        capacity = self.driver(t, y)[2] * self.of["brake"]
        held = np.ones(self.n)
        if (sigma == 0).any():
            answer = self.answer(t, y, sigma)[1]
            held = self.kind.s * answer.force[:, 2] + capacity - np.abs(answer.tau)
        return np.where(sigma == 0, held, sigma * dot(a, spin)[:, 0])

    def columns(self, t: float, y: np.ndarray, sigma: np.ndarray) -> dict[str, float]:
        """What is compared, at one instant."""
        turn = y[6:15].reshape(3, 3)
        point, v, heading = self.rear(y)
        answer = self.answer(t, y, sigma)[1]
        _, a, spin = self.wheels(y)
        slip = np.hypot(answer.force[:, 0], answer.force[:, 1]) / answer.force[:, 2]
        back = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])  # along, to the left
        along, left = back @ y[3:5]
        return {
            **dict(zip(("X", "Y", "Z"), y[:3], strict=True)),
            "a_y": back[1] @ answer.force[:, :2].sum(axis=0) / MASS,
            "beta": np.arctan(left / along) if abs(along) > 0.01 else 0.0,
            **{"psi": heading, "roll": np.arcsin(turn[2, 1]), "pitch": -np.arcsin(turn[2, 0])},
            **{"v": v, "omega": y[17], "X_R": point[0], "Y_R": point[1], "delta": y[BODY], "p": y[BODY + 2]},
            **{f"{n}.lambda_{k}": answer.force[i, k - 1] for i, n in enumerate(LAYOUT["wheel"]) for k in (1, 2, 3)},
            **{f"{n}.mu_required": mu for n, mu in zip(LAYOUT["wheel"], slip, strict=True)},
            **{f"{n}.omega_z": x for n, x in zip(LAYOUT["wheel"], dot(a, spin)[:, 0], strict=True)},
        }


def solve(manoeuvre: Manoeuvre, times: np.ndarray, tolerance: float = TOLERANCE) -> dict[str, np.ndarray]:
    """The manoeuvre at `times` (rising from 0), from one change of a wheel's friction branch to the next."""
    car = Car(manoeuvre)
    t, y, rows = 0.0, car.start(), []
    rubs = car.kind.s > 0 or car.o["B_0"] > 0 or car.o["B_hold"] > 0
    sigma = np.full(car.n, 0.0 if rubs and car.v == 0 else -1.0)
    while len(rows) < len(times):
        events = [_event(car, sigma, i) for i in range(car.n)] if rubs else None
        inside = times[len(rows) :]
        found = solve_ivp(
            car.rate, (t, times[-1]), y, "DOP853", np.union1d(inside, [times[-1]]), events=events, args=(sigma,),
            rtol=tolerance, atol=tolerance, max_step=0.05,
        )  # fmt: skip
        if not found.success:
            raise RuntimeError(f"{manoeuvre.name}: {found.message}")
        rows += [car.columns(u, x, sigma) for u, x in zip(found.t, np.transpose(found.y), strict=True)]
        if found.status == 0:
            break
        t, y, sigma = _change(car, found, sigma)
    table = {"time": times, **{name: np.array([row[name] for row in rows]) for name in rows[0]}}
    table["psi"] = np.unwrap(table["psi"])
    return table


def _event(car: Car, sigma: np.ndarray, i: int) -> Callable[..., float]:
    def margin(t: float, y: np.ndarray, _sigma: np.ndarray) -> float:
        return float(car.margins(t, y, sigma)[i])

    margin.terminal, margin.direction = True, -1
    return margin


def _change(car: Car, found: object, sigma: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """The branches after an event: stopped wheels are held if the friction can, held ones set off where it cannot.

    Wheels that change together, as those of one axle do, differ by rounding: all within it change at once.
    """
    first = next(i for i, at in enumerate(found.t_events) if len(at))
    t, y, after = float(found.t_events[first][0]), found.y_events[first][0].copy(), sigma.copy()
    margins, answer = car.margins(t, y, sigma), car.answer(t, y, sigma)[1]
    _, a, spin = car.wheels(y)
    slowing = sigma * dot(answer.w_dot, a)[:, 0] < 0
    stopped = (sigma != 0) & (margins < 1e-9) & slowing
    released = (sigma == 0) & (margins < 1e-6)
    stopped[first], released[first] = sigma[first] != 0, sigma[first] == 0
    after[released] = -np.sign(answer.tau[released])
    after[stopped] = 0.0
    spin[stopped] -= a[stopped] * dot(a, spin)[stopped]
    through = stopped & (car.margins(t, y, after) < 0)
    after[through] = -sigma[through]
    return t, y, after
