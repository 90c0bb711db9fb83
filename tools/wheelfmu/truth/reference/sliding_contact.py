"""Newton and Euler for the wheel that slides: friction is a force applied at the contact, nothing is solved in advance.

Vectors in body axes as in newton_euler.py, horizontal directions X and Y fixed. Unknowns: a (acceleration of O), alpha
(angular acceleration), N and tau, for given horizontal forces of the ground on the wheel:

    m a - n N                      = F + f                       Newton
    J alpha + p x n N - tau k      = M - w x J w - p x f         Euler about O
    n . (a + p x alpha)            = n . (w x dp/dt)             the contact keeps to the ground
    tau + sigma s N                = -sigma brake, or alpha_z = 0 where the wheel is held

The slip u = v_O - w x p is the velocity of the wheel's material point at the contact, u' = a + p x alpha - w x dp/dt.
One solution for f = 0 and one for a unit force along X and along Y give u' and N for every f, N = N_0 + lift . f; with
Coulomb's f = -mu N d, d = u / |u|, N = N_0 / (1 + mu lift . d).
"""

from math import cos, sin
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgesv

from .frames import Matrix, cross
from .model import Vector, Wheel
from .newton_euler import Law, arm, arm_rate, gyroscopic


class Push(NamedTuple):
    """Under friction against one direction d of slip: grow = u' . d, turn = u' . t, t a quarter turn ahead of d."""

    N: float
    room: float  # 1 at mu = 0; the friction jams the wheel where it falls to 0
    grow: float  # m/s2
    turn: float
    force: tuple[float, float]  # of the ground along X and Y, N


class Sliding(NamedTuple):
    """a, alpha, N, tau at f = 0 (base), and their change with 1 N along X and along Y; likewise u' along X and Y."""

    base: list[float]
    by_X: list[float]
    by_Y: list[float]
    free: tuple[float, float]
    per_X: tuple[float, float]
    per_Y: tuple[float, float]

    def push(self, mu: float, chi: float) -> Push:
        """Under friction against the slip direction chi, from X about Z."""
        c, s = cos(chi), sin(chi)
        room = 1 + mu * (self.by_X[6] * c + self.by_Y[6] * s)
        N = self.base[6] / room
        f_X, f_Y = -mu * N * c, -mu * N * s
        u_X, u_Y = self.slip_rate(f_X, f_Y)
        return Push(N, room, u_X * c + u_Y * s, u_Y * c - u_X * s, (f_X, f_Y))

    def turning(self, mu: float, chi: float) -> float:
        """d(turn)/d(chi) at fixed motion."""
        c, s = cos(chi), sin(chi)
        N, room, grow, _, _ = self.push(mu, chi)
        N_t = N * mu * (self.by_X[6] * s - self.by_Y[6] * c) / room  # dN/d(chi)
        f_X, f_Y = -mu * (N_t * c - N * s), -mu * (N_t * s + N * c)
        u_X = self.per_X[0] * f_X + self.per_Y[0] * f_Y
        u_Y = self.per_X[1] * f_X + self.per_Y[1] * f_Y
        return u_Y * c - u_X * s - grow

    def slip_rate(self, f_X: float, f_Y: float) -> tuple[float, float]:
        """u' along X and Y under this force of the ground."""
        (a, b), (A, C), (B, D) = self.free, self.per_X, self.per_Y
        return a + A * f_X + B * f_Y, b + C * f_X + D * f_Y

    def at(self, f_X: float, f_Y: float) -> list[float]:
        """a, alpha, N, tau under this force of the ground."""
        return [b + f_X * x + f_Y * y for b, x, y in zip(self.base, self.by_X, self.by_Y, strict=True)]

    def grip(self) -> tuple[float, float]:
        """The force along X and Y under which u' = 0."""
        (a, b), (A, C), (B, D) = self.free, self.per_X, self.per_Y
        det = A * D - B * C
        return (B * b - D * a) / det, (C * a - A * b) / det


def respond(wheel: Wheel, R: Matrix, w: Vector, F: Vector, M: Vector, law: Law) -> Sliding:
    """Solve under force F, weight included, and moment M, both in body axes."""
    X, Y, n = R
    p = arm(wheel, n)
    m, lever, turn = wheel.m, cross(p, n), cross(n, p)
    hold = law.hold
    columns = (
        (m, 0, 0, 0, 0, 0, n[0], 0),
        (0, m, 0, 0, 0, 0, n[1], 0),
        (0, 0, m, 0, 0, 0, n[2], 0),
        (0, 0, 0, wheel.J_x, 0, 0, turn[0], 0),
        (0, 0, 0, 0, wheel.J_y, 0, turn[1], 0),
        (0, 0, 0, 0, 0, wheel.J_z, turn[2], 1.0 if hold else 0.0),
        (-n[0], -n[1], -n[2], *lever, 0, 0.0 if hold else law.sigma * law.s),
        (0, 0, 0, 0, 0, -1.0, 0, 0.0 if hold else 1.0),
    )
    g, drift = gyroscopic(wheel, w), cross(w, arm_rate(wheel, n, w))
    against = 0.0 if hold else -law.sigma * law.brake
    loads = (
        (*F, M[0] - g[0], M[1] - g[1], M[2] - g[2], n[0] * drift[0] + n[1] * drift[1] + n[2] * drift[2], against),
        (*X, *cross(X, p), 0.0, 0.0),
        (*Y, *cross(Y, p), 0.0, 0.0),
    )
    base, by_X, by_Y = dgesv(np.array(columns, dtype=float).T, np.array(loads).T)[2].T.tolist()
    free = _slip_rate(X, Y, p, base)
    off = X[0] * drift[0] + X[1] * drift[1] + X[2] * drift[2], Y[0] * drift[0] + Y[1] * drift[1] + Y[2] * drift[2]
    free = free[0] - off[0], free[1] - off[1]
    return Sliding(base, by_X, by_Y, free, _slip_rate(X, Y, p, by_X), _slip_rate(X, Y, p, by_Y))


def _slip_rate(X: Vector, Y: Vector, p: Vector, x: list[float]) -> tuple[float, float]:
    """a + p x alpha along X and Y."""
    q = cross(p, (x[3], x[4], x[5]))
    b, c, d = x[0] + q[0], x[1] + q[1], x[2] + q[2]
    return X[0] * b + X[1] * c + X[2] * d, Y[0] * b + Y[1] * c + Y[2] * d


def resting_directions(now: Sliding, mu: float) -> list[float]:
    """Every slip direction that does not turn at |u| = 0: the roots chi of turn = 0.

    turn times room is a trigonometric polynomial of degree 2 in chi: roots of a quartic, polished by Newton.
    """
    samples = [now.push(mu, chi) for chi in 2 * np.pi * np.arange(8) / 8]
    harmonics = np.fft.fft([push.turn * push.room for push in samples]) / 8
    found: list[float] = []
    for z in np.roots(harmonics[[2, 1, 0, -1, -2]]):
        if abs(abs(z) - 1) < 1e-6:
            chi = float(np.angle(z))
            for _ in range(4):
                chi -= now.push(mu, chi).turn / now.turning(mu, chi)
            if abs(now.push(mu, chi).turn) < 1e-9 * np.abs(harmonics).max():
                found.append(chi)
    return found
