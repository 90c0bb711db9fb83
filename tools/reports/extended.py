"""Two formulations of the wheel in quadruple precision, for reference values: heyoka's Taylor method, mode after mode.

angles: Euler angles and carrier axes, three accelerations (the equations of docs/equations.md). vectors: the vertical n
and the angular velocity w in body axes, Newton and Euler (tests/reference); the dynamics know no angle. Both leave the
moment tau about the axle open: accelerations and normal force are linear in it, so that any inertia has the exact law.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
FALLING = hy.event_direction.negative
quad = hy.real128


@dataclass(frozen=True)
class Problem:
    """A scene of the benchmark; decimal numbers as text. M_3 = linear t + square t^2."""

    J_x: str = "0.9"
    J_y: str = "0.9"
    s: str = "0"
    linear: str = "0"
    square: str = "0"

    @property
    def torque(self) -> Any:
        return hy.time * (quad(self.linear) + quad(self.square) * hy.time)


CONSTANTS = {"m": "20", "r_0": "0.3", "r": "0.05", "J_z": "1.8", "g": "9.81"}


class Form(NamedTuple):
    """A formulation: symbols, their rates at tau = 0 and per tau, spin-up and N likewise, outputs, start."""

    symbols: list[Any]
    rates: Callable[[Any], list[Any]]
    spin_up: tuple[Any, Any]
    normal: tuple[Any, Any]
    outputs: list[Any]
    start: list[Any]


def solved(a: list[list[Any]], right: Sequence[Any]) -> list[Any]:
    """x of the 3 x 3 system a x = right, by cofactors."""
    (a_, b, c), (d, e, f), (g, h, i) = a
    cofactors = [[e * i - f * h, c * h - b * i, b * f - c * e], [f * g - d * i, a_ * i - c * g, c * d - a_ * f]]
    cofactors.append([d * h - e * g, b * g - a_ * h, a_ * e - b * d])
    determinant = a_ * cofactors[0][0] + b * cofactors[1][0] + c * cofactors[2][0]
    return [sum(x * y for x, y in zip(row, right, strict=True)) / determinant for row in cofactors]


def constants(problem: Problem) -> tuple[Any, ...]:
    """m, r_0, r, J_x, J_y, J_z, g."""
    all_of = {**CONSTANTS, "J_x": problem.J_x, "J_y": problem.J_y}
    return tuple(quad(all_of[name]) for name in ("m", "r_0", "r", "J_x", "J_y", "J_z", "g"))


def start() -> tuple[Any, Any, Any]:
    """psi, theta, X_O of the paper's start."""
    pi = 2 * np.arccos(quad(0))
    theta = 5 * pi / 12
    return pi / 2, theta, -quad("0.3") * np.cos(theta)


def angles(problem: Problem) -> Form:
    m, r_0, r, J_x, J_y, J_z, g = constants(problem)
    symbols = theta, w_1, w_2, w_3, psi, phi, _X, _Y = hy.make_vars(
        "theta", "omega_1", "omega_2", "omega_3", "psi", "phi", "X_O", "Y_O"
    )
    sin, cos = hy.sin(theta), hy.cos(theta)
    rho, eta, psi_dot = r_0 + r * sin, r * cos, w_2 / sin
    Omega_3 = psi_dot * cos
    phi_dot = w_3 - Omega_3
    mean, half = (J_x + J_y) / 2, (J_x - J_y) / 2
    q, p = half * hy.cos(2 * phi), half * hy.sin(2 * phi)
    I_11, I_22 = mean + q, mean - q
    H_1, H_2, H_3 = I_11 * w_1 + p * w_2, p * w_1 + I_22 * w_2, J_z * w_3
    g_1 = 2 * phi_dot * (q * w_2 - p * w_1) + w_2 * H_3 - Omega_3 * H_2
    g_2 = 2 * phi_dot * (q * w_1 + p * w_2) + Omega_3 * H_1 - w_1 * H_3
    g_3 = w_1 * H_2 - w_2 * H_1
    v_1, v_2, v_3 = eta * w_2 - rho * w_3, -eta * w_1, rho * w_1
    k_1 = m * w_1 * (r_0 * w_2 + eta * (Omega_3 - w_3))
    k_2 = m * (r * sin * w_1 * w_1 + Omega_3 * v_1 - w_1 * v_3 + g * sin)
    k_3 = m * (eta * w_1 * w_1 + w_1 * v_2 - w_2 * v_1 + g * cos)
    zero = hy.expression(quad(0))
    matrix = [
        [I_11 + m * (rho * rho + eta * eta), p, zero],
        [p, I_22 + m * eta * eta, -m * eta * rho],
        [zero, -m * eta * rho, J_z + m * rho * rho],
    ]
    base = solved(matrix, [eta * k_2 - g_1 - rho * k_3, -g_2 - eta * k_1, problem.torque - g_3 + rho * k_1])
    unit = solved(matrix, [zero, zero, hy.expression(quad(1))])
    lever = m * r_0 * cos
    normal = k_2 * sin + k_3 * cos + lever * base[0], lever * unit[0]
    across = (r_0 * sin + r) * w_1
    path = [v_1 * hy.cos(psi) + across * hy.sin(psi), v_1 * hy.sin(psi) - across * hy.cos(psi)]

    def rates(tau: Any) -> list[Any]:
        return [w_1, *(b + tau * u for b, u in zip(base, unit, strict=True)), psi_dot, phi_dot, *path]

    psi_0, theta_0, X_0 = start()
    begin = [theta_0, quad(0), quad(0), quad(-2), psi_0, quad(0), X_0, quad(0)]
    outputs = [_X, _Y, psi, theta, phi, psi_dot, w_1, phi_dot]
    return Form(symbols, rates, (base[2], unit[2]), normal, outputs, begin)


def cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def vectors(problem: Problem) -> Form:
    m, r_0, r, *inertia, g = constants(problem)
    symbols = hy.make_vars("n_x", "n_y", "n_z", "w_x", "w_y", "w_z", "psi", "phi", "X_O", "Y_O")
    n, w, (psi, phi, _X, _Y) = symbols[:3], symbols[3:6], symbols[6:]
    zero, one = hy.expression(quad(0)), hy.expression(quad(1))
    steep = hy.sqrt(n[0] * n[0] + n[1] * n[1])
    up = [n[0] / steep, n[1] / steep, zero]  # e2, up the slope of the wheel's plane
    n_dot = cross(n, w)
    along = up[0] * n_dot[0] + up[1] * n_dot[1]
    up_dot = [(n_dot[i] - along * up[i]) / steep for i in (0, 1)] + [zero]
    turned = cross(w, up)
    p = [r_0 * up[i] + r * n[i] for i in range(3)]
    p_dot = [r_0 * (up_dot[i] + turned[i]) for i in range(3)]  # n is fixed in space
    drift = cross(w, p_dot)
    gyroscopic = cross(w, [J * c for J, c in zip(inertia, w, strict=True)])
    pull = [m * (drift[i] + g * n[i]) for i in range(3)]  # minus the ground's force, but for the angular acceleration
    arm, size = cross(p, pull), dot(p, p)
    matrix = [[(inertia[i] + m * size if i == j else zero) - m * p[i] * p[j] for j in range(3)] for i in range(3)]
    base = solved(matrix, [-gyroscopic[i] - arm[i] + (problem.torque if i == 2 else 0) for i in range(3)])
    unit = solved(matrix, [zero, zero, one])
    normal = dot(n, pull) + m * dot(n, cross(base, p)), m * dot(n, cross(unit, p))
    v, line = cross(w, p), [up[1], -up[0], zero]
    forward, left = dot(v, line), dot(v, cross(n, line))
    psi_dot = (w[0] * up[0] + w[1] * up[1]) / steep
    theta_dot, phi_dot = w[0] * up[1] - w[1] * up[0], w[2] - psi_dot * n[2]
    path = [forward * hy.cos(psi) - left * hy.sin(psi), forward * hy.sin(psi) + left * hy.cos(psi)]

    def rates(tau: Any) -> list[Any]:
        return [*n_dot, *(b + tau * u for b, u in zip(base, unit, strict=True)), psi_dot, phi_dot, *path]

    psi_0, theta_0, X_0 = start()
    begin = [quad(0), np.sin(theta_0), np.cos(theta_0), quad(0), quad(0), quad(-2), psi_0, quad(0), X_0, quad(0)]
    outputs = [_X, _Y, psi, hy.atan2(steep, n[2]), phi, psi_dot, theta_dot, phi_dot]
    return Form(symbols, rates, (base[2], unit[2]), normal, outputs, begin)


FORMS = {"angles": angles, "vectors": vectors}


class Motion(NamedTuple):
    """Outputs (a row for each instant) and transitions (instant, sign of omega_z after it), in quadruple precision."""

    rows: np.ndarray
    transitions: list[tuple[Any, int]]


class Wheel:
    """One scene in one formulation at one tolerance: an integrator for each sign of omega_z, and one that holds it."""

    def __init__(self, problem: Problem, form: str, tolerance: str) -> None:
        self.form, self.s, self.rubs = FORMS[form](problem), quad(problem.s), problem.s != "0"
        self.spin = {"angles": 3, "vectors": 5}[form]
        self.tolerance = quad(tolerance)
        (self.up, self.up_per_tau), (self.N, self.N_per_tau) = self.form.spin_up, self.form.normal
        self.modes = {mode: self.integrator(mode) for mode in ((-1, 0, 1) if self.rubs else (-1,))}
        held = self.tau(0)
        room = (self.s * (self.N + held * self.N_per_tau)) ** 2 - held**2
        self.grip = hy.cfunc([room, held], self.form.symbols, fp_type=quad)
        self.room = room

    def tau(self, mode: int) -> Any:
        """The moment about the axle: -sigma s N while rolling, else what keeps omega_z."""
        if mode == 0:
            return -self.up / self.up_per_tau
        return -mode * self.s * self.N / (quad(1) + mode * self.s * self.N_per_tau)

    def integrator(self, mode: int) -> Any:
        tau = self.tau(mode)
        rates = self.form.rates(tau)
        spin = self.form.symbols[self.spin]
        watched = mode * spin + self.tolerance
        if mode == 0:
            rates[self.spin] = hy.expression(quad(0))
            watched = (self.s * (self.N + tau * self.N_per_tau)) ** 2 - tau**2
        events = [hy.t_event(watched, direction=FALLING, cooldown=quad(0), fp_type=quad)] if self.rubs else []
        system = list(zip(self.form.symbols, rates, strict=True))
        how = {"tol": self.tolerance, "t_events": events, "fp_type": quad, "compact_mode": True}
        solver = hy.taylor_adaptive(system, self.form.start, **how)
        outputs = [*self.form.outputs, self.N + tau * self.N_per_tau]
        read = hy.cfunc(outputs, self.form.symbols, fp_type=quad)
        return solver, read

    def next_mode(self, mode: int, y: np.ndarray) -> int:
        """Filippov's rule at the end of a mode."""
        room, tau = self.grip(y)
        if mode and room >= 0:
            return 0
        return -int(np.sign(float(tau)))

    def solve(self, times: Sequence[float]) -> Motion:
        rows, transitions, mode = [], [], -1
        t, y = quad(0), np.array(self.form.start)
        for stop in times:
            while t < stop:
                solver, _ = self.modes[mode]
                solver.time, solver.state[:] = t, y
                outcome = solver.propagate_until(quad(stop))[0]
                t, y = solver.time, solver.state.copy()
                if outcome == hy.taylor_outcome.time_limit:
                    break
                if mode:
                    y[self.spin] = quad(0)
                mode = self.next_mode(mode, y)
                transitions.append((t, mode))
            rows.append(self.modes[mode][1](y, time=t))
        return Motion(np.array(rows), transitions)
