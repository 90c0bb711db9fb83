"""The wheel by heyoka's Taylor method, mode after mode: in double precision for `speed`, in quadruple for `benchmark`.

angles: Euler angles and carrier axes, three accelerations (the equations of docs/equations.md). vectors: the vertical n
and the angular velocity w in body axes, Newton and Euler (tests/reference); the dynamics know no angle. Both leave the
moment tau about the axle open: accelerations and normal force are linear in it, so that any inertia has the exact law.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from time import perf_counter
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
CONSTANTS = ("m", "r_0", "r", "J_x", "J_y", "J_z", "g")
MOST_EVENTS, MOST_STEPS = 1000, 100_000
FALLING = hy.event_direction.negative
quad = hy.real128
Values = Mapping[str, Any]  # constants, s, and the start: psi, theta, phi, X_O, Y_O, and the rates psi_dot and so on


def paper(real: type, **decimals: str) -> Values:
    """The paper's wheel and start, with decimal numbers as text in the place of some; M_3 = linear t + square t^2."""
    values = {"m": "20", "r_0": "0.3", "r": "0.05", "J_x": "0.9", "J_y": "0.9", "J_z": "1.8", "g": "9.81", "s": "0"}
    values |= {"linear": "0", "square": "0", "phi": "0", "Y_O": "0", "psi_dot": "0", "theta_dot": "0", "phi_dot": "-2"}
    exact = {name: real(text) for name, text in (values | decimals).items()}
    pi = 2 * np.arccos(real("0"))
    theta = 5 * pi / 12
    return exact | {"psi": pi / 2, "theta": theta, "X_O": -exact["r_0"] * np.cos(theta)}


def torque(values: Values) -> Any:
    if not values.get("linear") and not values.get("square"):
        return 0
    return hy.time * (values["linear"] + values["square"] * hy.time)


class Form(NamedTuple):
    """A formulation: symbols, their rates for a tau, spin, spin-up and N at tau = 0 and per tau, outputs, start."""

    symbols: list[Any]
    rates: Callable[[Any], list[Any]]
    spin: int
    spin_up: tuple[Any, Any]
    normal: tuple[Any, Any]
    outputs: list[Any]
    start: list[Any]


def solved(a: list[list[Any]], right: Sequence[Any]) -> list[Any]:
    """x of the 3 x 3 system a x = right, by cofactors; with J_x = J_y its first row stands alone."""
    (a_, b, c), (d, e, f), (g, h, i) = a
    if b is None:
        determinant = e * i - f * h
        pair = [(right[1] * i - right[2] * f) / determinant, (right[2] * e - right[1] * h) / determinant]
        return [right[0] / a_, *pair]
    cofactors = [[e * i - f * h, c * h - b * i, b * f - c * e], [f * g - d * i, a_ * i - c * g, c * d - a_ * f]]
    cofactors.append([d * h - e * g, b * g - a_ * h, a_ * e - b * d])
    determinant = a_ * cofactors[0][0] + b * cofactors[1][0] + c * cofactors[2][0]
    return [sum(x * y for x, y in zip(row, right, strict=True)) / determinant for row in cofactors]


def angles(values: Values) -> Form:
    m, r_0, r, J_x, J_y, J_z, g = (values[name] for name in CONSTANTS)
    symbols = theta, w_1, w_2, w_3, psi, phi, _X, _Y = hy.make_vars(
        "theta", "omega_1", "omega_2", "omega_3", "psi", "phi", "X_O", "Y_O"
    )
    sin, cos = hy.sin(theta), hy.cos(theta)
    rho, eta, psi_dot = r_0 + r * sin, r * cos, w_2 / sin
    Omega_3 = psi_dot * cos
    phi_dot = w_3 - Omega_3
    v_1, v_2, v_3 = eta * w_2 - rho * w_3, -eta * w_1, rho * w_1
    k_1 = m * w_1 * (r_0 * w_2 + eta * (Omega_3 - w_3))
    k_2 = m * (r * sin * w_1 * w_1 + Omega_3 * v_1 - w_1 * v_3 + g * sin)
    k_3 = m * (eta * w_1 * w_1 + w_1 * v_2 - w_2 * v_1 + g * cos)
    I_11 = I_22 = J_x
    p, zero = None, hy.expression(0 * m)
    g_1, g_2, g_3 = J_z * w_2 * w_3 - J_x * Omega_3 * w_2, w_1 * (J_x * Omega_3 - J_z * w_3), 0
    if J_x != J_y:
        mean, half = (J_x + J_y) / 2, (J_x - J_y) / 2
        q, p = half * hy.cos(2 * phi), half * hy.sin(2 * phi)
        I_11, I_22 = mean + q, mean - q
        H_1, H_2, H_3 = I_11 * w_1 + p * w_2, p * w_1 + I_22 * w_2, J_z * w_3
        g_1 = 2 * phi_dot * (q * w_2 - p * w_1) + w_2 * H_3 - Omega_3 * H_2
        g_2 = 2 * phi_dot * (q * w_1 + p * w_2) + Omega_3 * H_1 - w_1 * H_3
        g_3 = w_1 * H_2 - w_2 * H_1
    matrix = [
        [I_11 + m * (rho * rho + eta * eta), p, zero],
        [p, I_22 + m * eta * eta, -m * eta * rho],
        [zero, -m * eta * rho, J_z + m * rho * rho],
    ]
    base = solved(matrix, [eta * k_2 - g_1 - rho * k_3, -g_2 - eta * k_1, torque(values) - g_3 + rho * k_1])
    unit = solved(matrix, [zero, zero, hy.expression(0 * m + 1)])
    lever = m * r_0 * cos
    normal = k_2 * sin + k_3 * cos + lever * base[0], lever * unit[0]
    across = (r_0 * sin + r) * w_1
    path = [v_1 * hy.cos(psi) + across * hy.sin(psi), v_1 * hy.sin(psi) - across * hy.cos(psi)]

    def rates(tau: Any) -> list[Any]:
        return [w_1, *(b + tau * u for b, u in zip(base, unit, strict=True)), psi_dot, phi_dot, *path]

    theta_0, turn = values["theta"], values["psi_dot"]
    spins = [values["theta_dot"], turn * np.sin(theta_0), values["phi_dot"] + turn * np.cos(theta_0)]
    start = [theta_0, *spins, *(values[name] for name in ("psi", "phi", "X_O", "Y_O"))]
    outputs = [_X, _Y, psi, theta, phi, psi_dot, w_1, phi_dot]
    return Form(symbols, rates, 3, (base[2], unit[2]), normal, outputs, start)


def cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def vectors(values: Values) -> Form:
    """Of a wheel that starts with phi = 0 and turns about its axle alone."""
    m, r_0, r, *inertia, g = (values[name] for name in CONSTANTS)
    symbols = hy.make_vars("n_x", "n_y", "n_z", "w_x", "w_y", "w_z", "psi", "phi", "X_O", "Y_O")
    n, w, (psi, phi, _X, _Y) = symbols[:3], symbols[3:6], symbols[6:]
    zero, one = hy.expression(0 * m), hy.expression(0 * m + 1)
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
    base = solved(matrix, [-gyroscopic[i] - arm[i] + (torque(values) if i == 2 else 0) for i in range(3)])
    unit = solved(matrix, [zero, zero, one])
    normal = dot(n, pull) + m * dot(n, cross(base, p)), m * dot(n, cross(unit, p))
    v, line = cross(w, p), [up[1], -up[0], zero]
    forward, left = dot(v, line), dot(v, cross(n, line))
    psi_dot = (w[0] * up[0] + w[1] * up[1]) / steep
    theta_dot, phi_dot = w[0] * up[1] - w[1] * up[0], w[2] - psi_dot * n[2]
    path = [forward * hy.cos(psi) - left * hy.sin(psi), forward * hy.sin(psi) + left * hy.cos(psi)]

    def rates(tau: Any) -> list[Any]:
        return [*n_dot, *(b + tau * u for b, u in zip(base, unit, strict=True)), psi_dot, phi_dot, *path]

    none, leaning = 0 * m, [np.sin(values["theta"]), np.cos(values["theta"])]
    start = [none, *leaning, none, none, values["phi_dot"], values["psi"], none, values["X_O"], none]
    outputs = [_X, _Y, psi, hy.atan2(steep, n[2]), phi, psi_dot, theta_dot, phi_dot]
    return Form(symbols, rates, 5, (base[2], unit[2]), normal, outputs, start)


FORMS = {"angles": angles, "vectors": vectors}


class Motion(NamedTuple):
    """Outputs (a row for each instant), transitions (instant, sign of omega_z after it), steps, and the seconds inside
    heyoka: what Python does between two modes is not heyoka's cost."""

    rows: np.ndarray
    transitions: list[tuple[Any, int]]
    steps: int
    seconds: float


class Wheel:
    """One scene in one formulation at one tolerance, compiled once: integrators for rolling (par[0]: sign of omega_z),
    for omega_z held at zero, and one without events."""

    def __init__(self, values: Values, form: str, tolerance: Any, real: type = float, omega_s: float = 0.0) -> None:
        self.form, self.s, self.real = FORMS[form](values), values["s"], real
        self.tolerance = real(tolerance)
        (up, up_per_tau), (N, N_per_tau) = self.form.spin_up, self.form.normal
        sigma, spin = hy.par[0], self.form.symbols[self.form.spin]
        held = -up / up_per_tau
        room = (self.s * (N + held * N_per_tau)) ** 2 - held**2
        self.exact = bool(self.s > 0 and not omega_s)
        # At a release omega_z and its rate are zero but for rounding: watched a hair beyond zero, that is no event.
        hair = self.tolerance ** (2 if real is float else 1)
        rolling = -sigma * self.s * N / (1 + sigma * self.s * N_per_tau)
        smooth = -self.s * N * hy.tanh(spin / omega_s) if omega_s else hy.expression(0 * self.s)
        of_mode = {"rolling": (rolling, sigma * spin + hair), "held": (held, room)}
        modes = of_mode if self.exact else {"smooth": (smooth, None)}
        self.modes = {name: self.integrator(name, *mode) for name, mode in modes.items()}
        self.grip = hy.cfunc([room, held], self.form.symbols, fp_type=real)

    def integrator(self, mode: str, tau: Any, watched: Any) -> tuple[Any, Any, bool]:
        """The solver of a mode; its outputs, and whether par is in them. A cool-down would swallow short slips."""
        rates = self.form.rates(tau)
        if mode == "held":
            rates[self.form.spin] = hy.expression(0 * self.s)
        falls = (
            []
            if watched is None
            else [hy.t_event(watched, direction=FALLING, cooldown=self.real(0), fp_type=self.real)]
        )
        how = {"tol": self.tolerance, "t_events": falls, "fp_type": self.real, "compact_mode": self.real is not float}
        signs = {"pars": [self.real(0)]} if mode == "rolling" else {}
        solver = hy.taylor_adaptive(list(zip(self.form.symbols, rates, strict=True)), self.form.start, **how, **signs)
        (N, N_per_tau) = self.form.normal
        outputs = [*self.form.outputs, N + tau * N_per_tau]
        return solver, hy.cfunc(outputs, self.form.symbols, fp_type=self.real), bool(hy.get_params(outputs))

    def next_mode(self, y: np.ndarray, held: bool) -> int:
        """Sign of omega_z, 0: held there; Filippov's rule at omega_z = 0, where it cannot go on as it was."""
        if y[self.form.spin] != 0:
            return int(np.sign(float(y[self.form.spin])))
        room, tau = self.grip(y)
        return 0 if room >= 0 and not held else -int(np.sign(float(tau)))

    def solve(self, times: Sequence[float]) -> Motion:
        grid = np.array([self.real(t) for t in times])
        rows, transitions, steps, seconds = [], [], 0, 0.0
        t, y = self.real(0), np.array(self.form.start)
        mode = self.next_mode(y, held=False) if self.exact else None
        while len(rows) < len(grid):
            solver, read, signed = self.modes["smooth" if mode is None else "rolling" if mode else "held"]
            if mode:
                solver.pars[0] = self.real(mode)
            skip = int(grid[len(rows)] > t)
            ahead = np.concatenate([np.array([t] * skip, dtype=grid.dtype), grid[len(rows) :]])
            solver.time, solver.state[:] = t, y
            before = perf_counter()
            outcome, _, _, taken, *_, states = solver.propagate_grid(ahead, max_steps=MOST_STEPS)
            seconds += perf_counter() - before
            steps += taken
            signs = {"pars": solver.pars} if signed else {}
            rows += [read(state, time=at, **signs) for at, state in zip(ahead[skip:], states[skip:], strict=False)]
            if outcome == hy.taylor_outcome.time_limit:
                break
            if mode is None or len(transitions) > MOST_EVENTS:
                raise RuntimeError(f"{steps} steps, only t = {float(solver.time):.4g} s reached")
            t, y, held = solver.time, solver.state.copy(), mode == 0
            if mode:
                y[self.form.spin] = self.real(0)
            mode = self.next_mode(y, held)
            transitions.append((t, mode))
        return Motion(np.array(rows), transitions, steps, seconds)
