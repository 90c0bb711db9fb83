"""The wheel by heyoka's Taylor method, mode after mode: in double precision for `speed`, in quadruple for `benchmark`.

angles: Euler angles and carrier axes, three accelerations (the equations of docs/equations.md). vectors: the vertical n
and the angular velocity w in body axes, Newton and Euler (tests/reference); the dynamics know no angle. Both leave the
moment tau about the axle open: accelerations and normal force are linear in it, so that any inertia has the exact law.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from time import perf_counter
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
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
    """A formulation: symbols and start; rates of the symbols before the angular velocities, of these at tau = 0 and per
    tau, of those behind them; N at tau = 0 and per tau; outputs."""

    symbols: list[Any]
    before: list[Any]
    spin_up: tuple[np.ndarray, np.ndarray]
    behind: list[Any]
    normal: tuple[Any, Any]
    outputs: list[Any]
    start: list[Any]

    @property
    def spin(self) -> int:
        """The number of the angular velocity about the axle."""
        return len(self.before) + 2

    def rates(self, tau: Any) -> list[Any]:
        base, unit = self.spin_up
        return [*self.before, *(base + tau * unit), *self.behind]


def solved(matrix: np.ndarray, right: np.ndarray, alone: bool = False) -> np.ndarray:
    """x of the 3 x 3 system matrix x = right, by cofactors; alone: the first row and column are zero beside a_11."""
    if alone:
        (e, f), (h, i) = matrix[1:, 1:]
        determinant, (_, y, z) = e * i - f * h, right
        return np.array([right[0] / matrix[0, 0], (y * i - z * f) / determinant, (z * e - y * h) / determinant])
    a, b, c = matrix.T
    cofactors = np.array([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    return cofactors @ right / (cofactors[0] @ a)


def constants(values: Values) -> list[Any]:
    return [hy.expression(values[name]) for name in ("m", "r_0", "r", "J_x", "J_y", "J_z", "g")]


def angles(values: Values) -> Form:
    m, r_0, r, J_x, J_y, J_z, g = constants(values)
    symbols = hy.make_vars("theta", "omega_1", "omega_2", "omega_3", "psi", "phi", "X_O", "Y_O")
    theta, w_1, w_2, w_3, psi, phi, *place = symbols
    sin, cos, zero, one = hy.sin(theta), hy.cos(theta), 0 * m, 0 * m + 1
    rho, eta, psi_dot = r_0 + r * sin, r * cos, w_2 / sin
    Omega_3 = psi_dot * cos
    phi_dot = w_3 - Omega_3
    v_1, v_2, v_3 = eta * w_2 - rho * w_3, -eta * w_1, rho * w_1
    k_1 = m * w_1 * (r_0 * w_2 + eta * (Omega_3 - w_3))
    k_2 = m * (r * sin * w_1 * w_1 + Omega_3 * v_1 - w_1 * v_3 + g * sin)
    k_3 = m * (eta * w_1 * w_1 + w_1 * v_2 - w_2 * v_1 + g * cos)
    symmetric, mean, half = values["J_x"] == values["J_y"], (J_x + J_y) / 2, (J_x - J_y) / 2
    q, p = (zero, zero) if symmetric else (half * hy.cos(2 * phi), half * hy.sin(2 * phi))
    I_11, I_22 = mean + q, mean - q
    H_1, H_2, H_3 = I_11 * w_1 + p * w_2, p * w_1 + I_22 * w_2, J_z * w_3
    g_1 = 2 * phi_dot * (q * w_2 - p * w_1) + w_2 * H_3 - Omega_3 * H_2
    g_2 = 2 * phi_dot * (q * w_1 + p * w_2) + Omega_3 * H_1 - w_1 * H_3
    g_3 = p * (w_1 * w_1 - w_2 * w_2) - 2 * q * w_1 * w_2
    M_11, M_22 = I_11 + m * (rho * rho + eta * eta), I_22 + m * eta * eta
    M_23, M_33 = -m * eta * rho, J_z + m * rho * rho
    matrix = np.array([[M_11, p, zero], [p, M_22, M_23], [zero, M_23, M_33]])
    right = np.array([eta * k_2 - g_1 - rho * k_3, -g_2 - eta * k_1, torque(values) - g_3 + rho * k_1])
    base, unit = solved(matrix, right, symmetric), solved(matrix, np.array([zero, zero, one]), symmetric)
    lever = m * r_0 * cos
    normal = k_2 * sin + k_3 * cos + lever * base[0], lever * unit[0]
    across = (r_0 * sin + r) * w_1
    path = [v_1 * hy.cos(psi) + across * hy.sin(psi), v_1 * hy.sin(psi) - across * hy.cos(psi)]
    theta_0, turn = values["theta"], values["psi_dot"]
    spins = [values["theta_dot"], turn * np.sin(theta_0), values["phi_dot"] + turn * np.cos(theta_0)]
    start = [theta_0, *spins, *(values[name] for name in ("psi", "phi", "X_O", "Y_O"))]
    outputs = [*place, psi, theta, phi, psi_dot, w_1, phi_dot]
    return Form(symbols, [w_1], (base, unit), [psi_dot, phi_dot, *path], normal, outputs, start)


def vectors(values: Values) -> Form:
    """Of a wheel that starts with phi = 0 and turns about its axle alone."""
    m, r_0, r, *principal, g = constants(values)
    symbols = hy.make_vars("n_x", "n_y", "n_z", "w_x", "w_y", "w_z", "psi", "phi", "X_O", "Y_O")
    n, w, (psi, phi, *place) = np.array(symbols[:3]), np.array(symbols[3:6]), symbols[6:]
    zero, one, inertia = 0 * m, 0 * m + 1, np.array(principal)
    steep = hy.sqrt(n[0] * n[0] + n[1] * n[1])
    up = np.array([n[0] / steep, n[1] / steep, zero])  # e2, up the slope of the wheel's plane
    n_dot = np.cross(n, w)
    up_dot = (n_dot - (up @ n_dot) * up) / steep * np.array([one, one, zero])
    p, p_dot = r_0 * up + r * n, r_0 * (up_dot + np.cross(w, up))  # n is fixed in space
    pull = m * (np.cross(w, p_dot) + g * n)  # minus the ground's force, but for the angular acceleration
    push = np.array([zero, zero, zero + torque(values)])
    right = push - np.cross(w, inertia * w) - np.cross(p, pull)
    matrix = np.diag(inertia + m * (p @ p)) - m * np.outer(p, p)
    base, unit = solved(matrix, right), solved(matrix, np.array([zero, zero, one]))
    normal = n @ pull + m * (n @ np.cross(base, p)), m * (n @ np.cross(unit, p))
    v, line = np.cross(w, p), np.array([up[1], -up[0], zero])
    forward, left = v @ line, v @ np.cross(n, line)
    psi_dot = (w[0] * up[0] + w[1] * up[1]) / steep
    theta_dot, phi_dot = w[0] * up[1] - w[1] * up[0], w[2] - psi_dot * n[2]
    path = [forward * hy.cos(psi) - left * hy.sin(psi), forward * hy.sin(psi) + left * hy.cos(psi)]
    none, leaning = 0 * values["m"], [np.sin(values["theta"]), np.cos(values["theta"])]
    start = [none, *leaning, none, none, values["phi_dot"], values["psi"], none, values["X_O"], none]
    outputs = [*place, psi, hy.atan2(steep, n[2]), phi, psi_dot, theta_dot, phi_dot]
    return Form(symbols, list(n_dot), (base, unit), [psi_dot, phi_dot, *path], normal, outputs, start)


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
        (*_, up), (*_, up_per_tau) = self.form.spin_up
        N, N_per_tau = self.form.normal
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
        event = {"direction": FALLING, "cooldown": self.real(0), "fp_type": self.real}
        falls = [] if watched is None else [hy.t_event(watched, **event)]
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
