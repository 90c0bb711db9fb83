"""Newton and Euler for a body on one rolling contact; the counterpart of the paper's (24).

All vectors are in body axes. The attitude enters only through n, the vertical seen from the
body; no Euler angle appears. With k = (0, 0, 1) the axle and s = |n x k| the arm from the contact
to O is p = r_0 e2 + r n, where e2 = (n - k (n.k)) / s points up the slope in the wheel plane.
Unknowns: a (acceleration of O), alpha (angular acceleration), lambda (ground on wheel).

    m a - lambda                     = F                     Newton; F: the weight and the inputs
    J alpha + p x lambda             = M - w x J w + tau k   Euler about O; lambda acts at -p
    a + p x alpha                    = w x dp/dt             v_O = w x p, differentiated

The axle moment tau of rolling resistance is left open: the system is solved for tau = 0 and for
the response to a unit tau, and a friction law then fixes tau by a scalar linear equation.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgesv

from .frames import cross, slope
from .model import Vector, Wheel


class Law(NamedTuple):
    """One branch of the friction law: tau = -(s N + brake) sigma, or the tau that holds w_z."""

    s: float  # m; the wheel's s, or its negative or 0 while the ground pulls
    sigma: float = 0.0
    hold: bool = False
    brake: float = 0.0  # N m, capacity of the dry brake


class Response(NamedTuple):
    """Solution for tau = 0, and its change with tau (index 1); N = n.lambda."""

    base: list[float]
    unit: list[float]
    N_0: float
    N_1: float


def arm(wheel: Wheel, n: Vector) -> Vector:
    """p = r_0 e2 + r n, from the contact to O."""
    ux, uy, _ = slope(n)
    return (wheel.r_0 * ux + wheel.r * n[0], wheel.r_0 * uy + wheel.r * n[1], wheel.r * n[2])


def arm_rate(wheel: Wheel, n: Vector, w: Vector) -> Vector:
    """dp/dt in fixed space = r_0 de2/dt, since n is fixed there; seen along the body axes.

    In the body n turns with dn/dt = n x w; e2 = n' / |n'| with n' the part of n in the wheel plane.
    """
    ux, uy, s = slope(n)
    nx, ny, _ = cross(n, w)
    along = ux * nx + uy * ny
    ex, ey = (nx - along * ux) / s, (ny - along * uy) / s
    wx, wy, wz = w
    r_0 = wheel.r_0
    return (r_0 * (ex - wz * uy), r_0 * (ey + wz * ux), r_0 * (wx * uy - wy * ux))


def gyroscopic(wheel: Wheel, w: Vector) -> Vector:
    """w x J w."""
    return cross(w, (wheel.J_x * w[0], wheel.J_y * w[1], wheel.J_z * w[2]))


def carrier_moment(n: Vector, M: Vector) -> Vector:
    """M_1 e1 + M_2 e2 + M_3 e3 in body axes; e1 = e2 x k."""
    ux, uy, _ = slope(n)
    return (M[0] * uy + M[1] * ux, M[1] * uy - M[0] * ux, M[2])


# (row, column) of the entries p_z, -p_y, -p_z, p_x, p_y, -p_x of [p x] in a 3 x 3 block, and of the
# two blocks: the moment of lambda (rows 3-5, columns 6-8), the constraint (rows 6-8, columns 3-5).
CROSS = ((1, 0), (2, 0), (0, 1), (2, 1), (0, 2), (1, 2))
BLOCKS = ((3, 6), (6, 3))


class Contact:
    """The 9 x 9 system of one wheel. Holds a work matrix: one Contact to a thread."""

    def __init__(self, wheel: Wheel) -> None:
        self.wheel = wheel
        one, none = np.eye(3), np.zeros((3, 3))
        inertia = np.diag([wheel.J_x, wheel.J_y, wheel.J_z])
        system = np.block([[wheel.m * one, none, -one], [none, inertia, none], [one, none, none]])
        self._flat = system.ravel(order="F")
        self._skew = np.array([i + u + 9 * (j + v) for i, j in BLOCKS for u, v in CROSS])

    def respond(self, n: Vector, w: Vector, F: Vector, M: Vector) -> Response:
        """Solve for (a, alpha, lambda) under force F, weight included, and moment M, both in body axes."""
        wheel = self.wheel
        px, py, pz = arm(wheel, n)
        flat = self._flat
        flat[self._skew] = (pz, -py, -pz, px, py, -px) * 2
        gx, gy, gz = gyroscopic(wheel, w)
        bx, by, bz = cross(w, arm_rate(wheel, n, w))
        loads = np.array(
            F + (M[0] - gx, M[1] - gy, M[2] - gz, bx, by, bz) + (0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
        )
        system = flat.reshape((9, 9), order="F")
        x = dgesv(system, loads.reshape((9, 2), order="F"), 0, 1)[2]
        base, unit = x.T.tolist()
        N_0 = n[0] * base[6] + n[1] * base[7] + n[2] * base[8]
        N_1 = n[0] * unit[6] + n[1] * unit[7] + n[2] * unit[8]
        return Response(base, unit, N_0, N_1)


def axle_moment(law: Law, answer: Response) -> float:
    """tau of the law's branch, N depending on tau (general J) included."""
    if law.hold:
        return -answer.base[5] / answer.unit[5]
    return -law.sigma * (law.s * answer.N_0 + law.brake) / (1 + law.s * law.sigma * answer.N_1)
