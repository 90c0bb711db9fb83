"""Wheels that roll without slip, in fixed axes and without angles: one half of the independent check of the vehicles.

Each wheel is its centre O, the unit vector a along its axle and its angular velocity w; all arrays are (wheels, 3), SI,
Z up. With u = (Z - (Z a) a) / |...| the contact point is O - rho, rho = r_0 u + r Z, and no slip means v_O = w x rho.
Newton gives the ground's force lambda, Euler about O, with J = J_x 1 + (J_z - J_x) a a^T,

    (J + m (rho^2 1 - rho rho^T)) w' = M + tau a - (J_z - J_x)(a w) (w x a) - rho x (m w x rho' - F - m g)

Here g is the vector of gravity. tau, the moment of rolling friction and brake about the axle, follows from the law:
rolling with sign sigma of a w it is -sigma (s N + B), held it is what keeps a w at zero. None of this shares code or
formulation with the FMUs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from reference.model import Wheel

Z = np.array([0.0, 0.0, 1.0])


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Row by row; much quicker than numpy's for few rows."""
    return a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]]


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Row by row, as a column."""
    return (a * b).sum(axis=-1, keepdims=True)


@dataclass(frozen=True)
class Answer:
    """What a load does: w', lambda, tau and the velocity of O; (wheels, 3), tau (wheels,)."""

    w_dot: np.ndarray
    force: np.ndarray
    tau: np.ndarray
    v: np.ndarray


def lever(kind: Wheel, a: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """rho and its rate."""
    a_dot = cross(w, a)
    across = Z - a[:, 2:] * a
    length = np.sqrt(dot(across, across))
    u = across / length
    rate = -a_dot[:, 2:] * a - a[:, 2:] * a_dot
    return kind.r_0 * u + kind.r * Z, kind.r_0 * (rate - u * dot(u, rate)) / length


def respond(kind: Wheel, a: np.ndarray, w: np.ndarray, load: tuple[np.ndarray, np.ndarray], law: Law) -> Answer:
    """Accelerations and reactions under the forces and moments `load` = (F, M)."""
    F, M = load
    rho, rho_dot = lever(kind, a, w)
    spin = dot(a, w)
    matrix = (kind.J_x + kind.m * dot(rho, rho))[:, :, None] * np.eye(3)
    matrix += (kind.J_z - kind.J_x) * a[:, :, None] * a[:, None, :] - kind.m * rho[:, :, None] * rho[:, None, :]
    at_rest = kind.m * cross(w, rho_dot) - F - np.multiply(kind.m, kind.gravity)
    right = M - (kind.J_z - kind.J_x) * spin * cross(w, a) - cross(rho, at_rest)
    solved = np.linalg.solve(matrix, np.stack([right, a], axis=2))
    free, per_tau = solved[:, :, 0], solved[:, :, 1]
    N = kind.m * cross(free, rho)[:, 2] + at_rest[:, 2]
    N_per_tau = kind.m * cross(per_tau, rho)[:, 2]
    holding = -dot(free, a)[:, 0] / dot(per_tau, a)[:, 0]
    rolling = -law.sigma * (kind.s * N + law.brake) / (1 + law.sigma * kind.s * N_per_tau)
    tau = np.where(law.sigma == 0, holding, rolling)
    w_dot = free + tau[:, None] * per_tau
    return Answer(w_dot, kind.m * cross(w_dot, rho) + at_rest, tau, cross(w, rho))


@dataclass(frozen=True)
class Law:
    """The branch of each wheel: sigma = -1, 1 the sign of a w while it rolls, 0 held; brake: capacity, N m."""

    sigma: np.ndarray
    brake: np.ndarray
