"""The wheel by heyoka's Taylor method (PyPI), mode after mode: what a reader would use in the FMU's place.

The reduced equations (docs/equations.md) as symbols. The moment tau about the axle is left open: accelerations and
normal force are linear in it, so that rolling and holding are two integrators of the same equations, and any inertia
has the exact law.
"""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any

import heyoka as hy
import numpy as np

from wheelfmu.truth.reference import Start
from wheelfmu.truth.scenes import Scene

Array = np.ndarray
SYMBOLS = hy.make_vars("theta", "omega_1", "omega_2", "omega_3", "psi", "phi", "X_O", "Y_O")
SPIN, MOST_EVENTS, MOST_STEPS = 3, 1000, 100_000


def solved(matrix: Array, right: Array, alone: bool) -> Array:
    """x of the 3 x 3 system matrix x = right, by cofactors; alone: the first row and column are zero beside a_11."""
    if alone:
        (e, f), (h, i) = matrix[1:, 1:]
        determinant, (_, y, z) = e * i - f * h, right
        return np.array([right[0] / matrix[0, 0], (y * i - z * f) / determinant, (z * e - y * h) / determinant])
    a, b, c = matrix.T
    cofactors = np.array([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    return cofactors @ right / (cofactors[0] @ a)


def equations(wheel: Any) -> tuple[Callable[[Any], list[Any]], Callable[[Any], Any], Any, list[Any]]:
    """Rates and normal force at a moment tau, the tau that holds omega_z, and the headline outputs."""
    m, r_0, r, J_z, g = (hy.expression(value) for value in (wheel.m, wheel.r_0, wheel.r, wheel.J_z, wheel.g))
    theta, w_1, w_2, w_3, psi, phi, X_O, _ = SYMBOLS
    sin, cos, zero = hy.sin(theta), hy.cos(theta), 0 * m
    rho, eta, psi_dot = r_0 + r * sin, r * cos, w_2 / sin
    Omega_3 = psi_dot * cos
    phi_dot = w_3 - Omega_3
    v_1, v_2, v_3 = eta * w_2 - rho * w_3, -eta * w_1, rho * w_1
    k_1 = m * w_1 * (r_0 * w_2 - eta * phi_dot)
    k_2 = m * (r * sin * w_1 * w_1 + Omega_3 * v_1 - w_1 * v_3 + g * sin)
    k_3 = m * (eta * w_1 * w_1 + w_1 * v_2 - w_2 * v_1 + g * cos)
    mean, half = (wheel.J_x + wheel.J_y) / 2, (wheel.J_x - wheel.J_y) / 2
    q, p = (half * hy.cos(2 * phi), half * hy.sin(2 * phi)) if half else (zero, zero)
    I_11, I_22 = mean + q, mean - q
    H_1, H_2, H_3 = I_11 * w_1 + p * w_2, p * w_1 + I_22 * w_2, J_z * w_3
    g_1 = 2 * phi_dot * (q * w_2 - p * w_1) + w_2 * H_3 - Omega_3 * H_2
    g_2 = 2 * phi_dot * (q * w_1 + p * w_2) + Omega_3 * H_1 - w_1 * H_3
    a_11, a_22, a_33 = I_11 + m * (rho * rho + eta * eta), I_22 + m * eta * eta, J_z + m * rho * rho
    a_23 = -m * eta * rho
    matrix = np.array([[a_11, p, zero], [p, a_22, a_23], [zero, a_23, a_33]])
    right = np.array([eta * k_2 - g_1 - rho * k_3, -g_2 - eta * k_1, w_2 * H_1 - w_1 * H_2 + rho * k_1])
    free, unit = (solved(matrix, side, not half) for side in (right, np.array([zero, zero, zero + 1])))
    across = (r_0 * sin + r) * w_1
    path = [v_1 * hy.cos(psi) + across * hy.sin(psi), v_1 * hy.sin(psi) - across * hy.cos(psi)]

    def rates(tau: Any) -> list[Any]:
        return [w_1, *(free + tau * unit), psi_dot, phi_dot, *path]

    def normal(tau: Any) -> Any:
        return k_2 * sin + k_3 * cos + m * r_0 * cos * (free[0] + tau * unit[0])

    return rates, normal, -free[2] / unit[2], [X_O, theta, phi_dot, psi_dot]


def start_of(motion: Start) -> list[float]:
    turn = motion.psi_dot
    spins = [motion.theta_dot, turn * np.sin(motion.theta), motion.phi_dot + turn * np.cos(motion.theta)]
    return [motion.theta, *spins, motion.psi, motion.phi, motion.X_O, motion.Y_O]


class Wheel:
    """One scene at one tolerance, compiled once: integrators for rolling (par[0]: the sign of omega_z) and held."""

    def __init__(self, scene: Scene, tolerance: float) -> None:
        self.start, self.rubs = start_of(scene.motion), scene.wheel.s > 0
        rates, normal, held, outputs = equations(scene.wheel)
        s, sigma = scene.wheel.s, hy.par[0]
        base = normal(0 * held)
        rolling = -sigma * s * base / (1 + sigma * s * (normal(1 + 0 * held) - base))
        room = (s * normal(held)) ** 2 - held**2
        # At a release omega_z and its rate are zero but for rounding: watched a hair beyond zero, that is no event.
        watched = {"rolling": sigma * SYMBOLS[SPIN] + tolerance**2, "held": room}
        moments = {"rolling": rolling, "held": held} if self.rubs else {"rolling": 0 * held}
        self.modes = {}
        for mode, tau in moments.items():
            system = rates(tau)
            if mode == "held":
                system[SPIN] = 0 * held
            falls = [hy.t_event(watched[mode], direction=hy.event_direction.negative, cooldown=0.0)] * self.rubs
            pars = {"pars": [0.0]} if mode == "rolling" and self.rubs else {}
            equal = list(zip(SYMBOLS, system, strict=True))
            self.modes[mode] = hy.taylor_adaptive(equal, self.start, tol=tolerance, t_events=falls, **pars)
        self.grip, self.outputs = hy.cfunc([room, held], SYMBOLS), hy.cfunc(outputs, SYMBOLS)

    def next_mode(self, y: Array, held: bool) -> float:
        """Sign of omega_z, 0: held there; Filippov's rule at omega_z = 0, where it cannot go on as it was."""
        if y[SPIN] != 0:
            return np.sign(y[SPIN])
        room, tau = self.grip(y)
        return 0.0 if room >= 0 and not held else -np.sign(tau)

    def solve(self, grid: Array) -> tuple[float, Array, dict[str, int]]:
        """Seconds inside heyoka (what Python does between two modes is not heyoka's cost), headline outputs, counts."""
        rows: list[Array] = []
        t, y, steps, events, seconds = 0.0, np.array(self.start), 0, 0, 0.0
        mode = self.next_mode(y, held=False) if self.rubs else 1.0
        while len(rows) < len(grid):
            solver = self.modes["rolling" if mode else "held"]
            if mode and self.rubs:
                solver.pars[0] = mode
            skip = int(grid[len(rows)] > t)
            solver.time, solver.state[:] = t, y
            before = perf_counter()
            outcome, _, _, taken, *_, states = solver.propagate_grid(
                np.concatenate([[t] * skip, grid[len(rows) :]]), max_steps=MOST_STEPS
            )
            seconds += perf_counter() - before
            steps += taken
            rows += [self.outputs(state) for state in states[skip:]]
            if outcome == hy.taylor_outcome.time_limit:
                break
            if not self.rubs or events > MOST_EVENTS:
                raise RuntimeError(f"{steps} steps, only t = {solver.time:.4g} s reached")
            t, y, held = solver.time, solver.state.copy(), not mode
            y[SPIN] = 0 if mode else y[SPIN]
            mode = self.next_mode(y, held)
            events += 1
        return seconds, np.array(rows), {"steps": steps, "events": events}
