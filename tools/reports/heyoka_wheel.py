"""The reduced wheel (J_x = J_y) in heyoka's symbols: a Taylor integrator for each friction mode.

Same equations as fmu-src/equations/reduced_system.h for J_x = J_y, carrier frame; state theta, omega_1, omega_2,
omega_3, psi, phi, X_O, Y_O. Rolling friction exactly as there: a rolling mode ends where sigma omega_z falls to zero,
the held mode where the moment tau reaches s N.
"""

from __future__ import annotations

from functools import lru_cache
from time import perf_counter
from typing import Any

import heyoka as hy
import numpy as np

NAMES = ("theta", "omega_1", "omega_2", "omega_3", "psi", "phi", "X_O", "Y_O")
MOST_EVENTS, MOST_STEPS = 1000, 100_000
FALLING = hy.event_direction.negative
Solution = tuple[float, np.ndarray, dict[str, int]]


def start_state(scene: dict[str, float]) -> np.ndarray:
    theta, psi, phi, X_O, Y_O = (scene[f"{name}_start"] for name in ("theta", "psi", "phi", "X_O", "Y_O"))
    theta_dot, psi_dot, phi_dot = (scene[f"{name}_dot_start"] for name in ("theta", "psi", "phi"))
    spin = phi_dot + psi_dot * np.cos(theta)
    return np.array([theta, theta_dot, psi_dot * np.sin(theta), spin, psi, phi, X_O, Y_O])


def equations(scene: dict[str, float], moment: str) -> tuple[list[tuple[Any, Any]], Any, Any]:
    """The system; in the held mode also (s N)^2 - tau^2 and tau, the moment of the ground that holds omega_z at zero.

    moment of the ground about the axle: "none"; "rolling", -s N par[0] with par[0] = sigma; "regularized"; "held".
    """
    m, r_0, r, J_x, J_z, g = (scene[name] for name in ("m", "r_0", "r", "J_x", "J_z", "g"))
    theta, w_1, w_2, w_3, psi, phi, X, Y = symbols = hy.make_vars(*NAMES)
    sin, cos = hy.sin(theta), hy.cos(theta)
    rho, eta = r_0 + r * sin, r * cos
    psi_dot = w_2 / sin
    Omega_3 = psi_dot * cos
    v_1, v_2, v_3 = eta * w_2 - rho * w_3, -eta * w_1, rho * w_1
    k_1 = m * (w_1 * (r_0 * w_2 + eta * (Omega_3 - w_3)))
    k_2 = m * (r * sin * w_1 * w_1 + Omega_3 * v_1 - w_1 * v_3 + g * sin)
    k_3 = m * (eta * w_1 * w_1 + w_1 * v_2 - w_2 * v_1 + g * cos)
    tilting = -J_z * w_2 * w_3 + J_x * Omega_3 * w_2 - rho * k_3 + eta * k_2
    w_1_dot = tilting / (J_x + m * (rho * rho + eta * eta))
    N = sin * (k_2 - m * eta * w_1_dot) + cos * (k_3 + m * rho * w_1_dot)
    a_11, a_12, a_22 = J_x + m * eta * eta, -m * eta * rho, J_z + m * rho * rho
    h_2, h_3 = w_1 * (J_z * w_3 - J_x * Omega_3) - eta * k_1, rho * k_1
    margin = tau = None
    if moment == "held":
        w_2_dot, w_3_dot = h_2 / a_11, hy.expression(0.0)
        tau = a_12 * w_2_dot - h_3
        margin = (scene["s"] * N) ** 2 - tau**2
    else:
        if moment == "rolling":
            h_3 = h_3 - scene["s"] * N * hy.par[0]
        if moment == "regularized":
            h_3 = h_3 - scene["s"] * N * hy.tanh(w_3 / scene["omega_s"])
        inverse = 1 / (a_11 * J_z + J_x * m * rho * rho)
        w_2_dot, w_3_dot = (a_22 * h_2 - a_12 * h_3) * inverse, (a_11 * h_3 - a_12 * h_2) * inverse
    across = (r_0 * sin + r) * w_1
    X_dot = v_1 * hy.cos(psi) + across * hy.sin(psi)
    Y_dot = v_1 * hy.sin(psi) - across * hy.cos(psi)
    rates = [w_1, w_1_dot, w_2_dot, w_3_dot, psi_dot, w_3 - Omega_3, X_dot, Y_dot]
    return list(zip(symbols, rates, strict=True)), margin, tau


class Taylor:
    """One scene at one tolerance, compiled once and solved as often as asked.

    solve() gives the seconds spent inside heyoka (what Python does between two modes is not heyoka's cost), the states
    on the grid, and counts.
    """

    def __init__(self, scene: dict[str, float], grid: np.ndarray, tolerance: float) -> None:
        self.scene, self.grid = scene, grid
        self.y_0 = start_state(scene)
        exact = scene["s"] > 0 and not scene["regularized"]
        if exact:
            self.rolling = self._integrator("rolling", tolerance)
            self.held = self._integrator("held", tolerance)
            _, *grip = equations(scene, "held")
            self.grip = hy.cfunc(grip, hy.make_vars(*NAMES))
        else:
            self.smooth = self._integrator("none" if scene["s"] == 0 else "regularized", tolerance)
        self.solve = self._solve_modes if exact else self._solve_smooth

    def _integrator(self, moment: str, tolerance: float) -> Any:
        system, margin, _ = equations(self.scene, moment)
        # At a release omega_z and its rate are zero but for rounding: watched a hair beyond zero, that is no event.
        # No cool-down: the default one swallows slips shorter than itself, silently.
        watched = {"rolling": hy.par[0] * hy.make_vars("omega_3") + tolerance**2, "held": margin}.get(moment)
        falls = [] if watched is None else [hy.t_event(watched, direction=FALLING, cooldown=0.0)]
        return hy.taylor_adaptive(system, self.y_0, tol=tolerance, t_events=falls, pars=[0.0] * (moment == "rolling"))

    def _propagate(self, solver: Any, t: float, y: np.ndarray, grid: np.ndarray) -> tuple[Any, float]:
        solver.time = t
        solver.state[:] = y
        start = perf_counter()
        result = solver.propagate_grid(grid, max_steps=MOST_STEPS)
        return result, perf_counter() - start

    def _solve_smooth(self) -> Solution:
        result, seconds = self._propagate(self.smooth, 0.0, self.y_0, self.grid)
        if result[0] != hy.taylor_outcome.time_limit:
            raise RuntimeError(f"{MOST_STEPS} steps, only t = {self.smooth.time:.4g} s reached")
        return seconds, result[-1], {"steps": result[3], "events": 0}

    def _mode(self, y: np.ndarray) -> int:
        """Sign of omega_z, 0: held there; Filippov's choice at omega_z = 0."""
        if y[3] != 0:
            return int(np.sign(y[3]))
        margin, tau = self.grip(y)
        return 0 if margin >= 0 else -int(np.sign(tau))

    def _solve_modes(self) -> Solution:
        """Mode after mode; each restarts at the instant where the last one ended."""
        rows, t, y, mode = [], 0.0, self.y_0.copy(), self._mode(self.y_0)
        steps = events = done = 0
        seconds = 0.0
        while done < len(self.grid):
            solver = self.rolling if mode else self.held
            if mode:
                solver.pars[0] = mode
            skip = int(self.grid[done] > t)
            result, spent = self._propagate(solver, t, y, np.concatenate([[t] * skip, self.grid[done:]]))
            seconds += spent
            rows.append(result[-1][skip:])
            done += len(rows[-1])
            steps += result[3]
            if result[0] == hy.taylor_outcome.time_limit:
                break
            events += 1
            if events > MOST_EVENTS:
                raise RuntimeError(f"{MOST_EVENTS} events, only t = {t:.4g} s reached")
            t, y = solver.time, solver.state.copy()
            if mode:
                y[3] = 0.0
            mode = self._mode(y) if mode else -int(np.sign(self.grip(y)[1]))
        return seconds, np.concatenate(rows), {"steps": steps, "events": events}


@lru_cache(maxsize=64)
def compiled(scene: tuple[tuple[str, float], ...], stop: float, points: int, tolerance: float) -> Taylor:
    """A scene by names and values, as `reports.peers.constants` gives it."""
    return Taylor(dict(scene), np.linspace(0, stop, points), tolerance)
