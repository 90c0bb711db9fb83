"""The product's multibody state and derivative in numpy, on top of the transcription of (24).

The product's y has omega_z, (21), in the place of phi_dot, and its derivative draws a state back to the constraints
(Baumgarte). Nothing here calls the product; complex states are allowed. Fixed axes for O, body axes for rotation.
"""

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from equations.paper_transcription import Paper
from support import equations as eq

PSI_DOT, SPIN, THETA = 9, 11, 4


def papers_state(y: np.ndarray) -> np.ndarray:
    """(q, q_dot) of (25) from the product's y: phi_dot = omega_z - psi_dot cos(theta)."""
    out = np.array(y)
    out[..., SPIN] -= y[..., PSI_DOT] * np.cos(y[..., THETA])
    return out


def products_state(q: np.ndarray) -> np.ndarray:
    """The product's y from (q, q_dot): omega_z = phi_dot + psi_dot cos(theta)."""
    out = np.array(q)
    out[..., SPIN] += q[..., PSI_DOT] * np.cos(q[..., THETA])
    return out


class Stabilised(Paper):
    """(24) with -[B_dot]{q_dot} - a [B]{q_dot} in its last rows."""

    @cached_property
    def decay_rate(self) -> np.ndarray:
        """a = 5 sqrt(|g| / (r_0 + r) + |omega|^2), 1/s; |g|: of the whole of gravity."""
        w = self.wheel
        gravity = np.sqrt(w["g"] ** 2 + w["g_X"] ** 2 + w["g_Y"] ** 2)
        return 5 * np.sqrt(gravity / (w["r_0"] + w["r"]) + (self.omega**2).sum(axis=-1))

    @cached_property
    def height_error(self) -> np.ndarray:
        """Z_O less the height of (32), m."""
        return self.height - self.wheel["r_0"] * self.sin_theta - self.wheel["r"]

    def system(self, kappa: np.ndarray | float, load: np.ndarray | None = None) -> tuple:
        K, right = super().system(kappa, load)
        right[..., 6:] -= self.decay_rate[..., None] * self.slip
        return K, right


def solved(paper: Paper, scenes: np.ndarray, load: Mapping | None = None) -> np.ndarray:
    """q_ddot, lambda and tau row by row, with each scene's law and load, or another load (complex too)."""
    load = scenes["load"] if load is None else load
    brake = load["brake"]
    friction, kind = scenes["friction"], scenes["friction"]["kind"]
    soft = np.tanh(paper.omega_z / friction["omega_s"])
    kappa = np.select([kind == eq.ROLLING, kind == eq.REGULARIZED], [friction["sigma"], soft], 0)
    braked = {"F": load["F"], "M": load["M"] - (brake * kappa)[..., None] * np.array([0, 0, 1])}
    grip = np.where(paper.solve(kappa, braked)[:, 8].real > 0, kappa, 0)  # no pressure, no friction but the brake's
    x = paper.solve(grip, braked)
    x = np.column_stack([x, -scenes["wheel"]["s"] * grip * x[:, 8] - brake * kappa])
    return np.where((kind == eq.HELD)[:, None], paper.solve_held(load), x)


def omega_z_dot(paper: Paper, x: np.ndarray, scenes: np.ndarray) -> np.ndarray:
    """Derivative of (21); zero by definition while the spin is held."""
    rate = (paper.Q[:, 2, :] * x[:, 3:6] + paper.Q_dot[:, 2, :] * paper.beta_dot).sum(axis=1)
    return np.where(scenes["friction"]["kind"] == eq.HELD, 0, rate)


def stabilised_rate(scenes: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The product's y_dot: the stabilised (24), and the height drawn to that of (32)."""
    paper = Stabilised(scenes["wheel"], papers_state(y))
    x = solved(paper, scenes)
    sinking = paper.decay_rate * paper.height_error
    height_rate = paper.q_dot[:, 2] - sinking
    positions = np.column_stack([paper.q_dot[:, :2], height_rate, paper.q_dot[:, 3:]])
    return np.column_stack([positions, x[:, :5], omega_z_dot(paper, x, scenes)])
