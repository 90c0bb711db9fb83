"""A thin disc in closed form by Legendre functions (Chaplygin, Appell, Korteweg, 1897-1900)."""

import mpmath
import numpy as np

from wheelfmu.truth.motion import Library
from wheelfmu.truth.reference import Start, Wheel

from .wheels import MODELICA, SYMPY_DISC, motion

DISCS = (Wheel(r=0.0), MODELICA, SYMPY_DISC, Wheel(m=1.0, r_0=1.0, r=0.0, J_x=0.5, J_y=0.5, J_z=1.0))
DISC_START = Start(theta=1.2, theta_dot=0.3, psi_dot=1.0, phi_dot=-4.0)


def degree(wheel: Wheel) -> complex:
    """nu of the Legendre functions, nu (nu + 1) = -J_z m r_0^2 / (J_x (J_z + m r_0^2))."""
    rolled = mpmath.mpf(wheel.m) * mpmath.mpf(wheel.r_0) ** 2
    product = -mpmath.mpf(wheel.J_z) * rolled / (mpmath.mpf(wheel.J_x) * (wheel.J_z + rolled))
    return mpmath.sqrt(mpmath.mpf(1) / 4 + product) - mpmath.mpf(1) / 2


def solutions(wheel: Wheel, theta: float) -> mpmath.matrix:
    """The two solutions P_nu(cos theta), P_nu(-cos theta) for omega_3 (row 0), and for omega_2 (row 1).

    With r = 0 and theta as the variable, d omega_3 = share omega_2 and J_x d omega_2 = J_z omega_3 - J_x cot omega_2,
    share = m r_0^2 / (J_z + m r_0^2): Legendre's equation for omega_3 (Chaplygin, Appell, Korteweg).
    """
    nu, angle = degree(wheel), mpmath.mpf(theta)
    x, slope = mpmath.cos(angle), mpmath.sin(angle)
    rolled = mpmath.mpf(wheel.m) * mpmath.mpf(wheel.r_0) ** 2
    share = rolled / (wheel.J_z + rolled)

    def legendre(y: mpmath.mpf) -> mpmath.mpf:
        return mpmath.legenp(nu, 0, y).real

    rates = [-sign * slope * mpmath.diff(legendre, sign * x) / share for sign in (1, -1)]
    return mpmath.matrix([[legendre(x), legendre(-x)], rates])


def legendre_error(library: Library, wheel: Wheel, judged: Wheel | None = None) -> float:
    """omega_2 and omega_3 of 10 s of the free disc against the closed form in theta, relative to their largest value.

    judged: the wheel with whose constants the closed form is written.
    """
    run = motion(library, wheel, DISC_START, np.linspace(0, 10, 21), 1e-14)
    theta, spins = run["theta"], np.array([run["omega_z"], run["psi_dot"] * np.sin(run["theta"])])
    with mpmath.workdps(30):
        weights = mpmath.lu_solve(solutions(judged or wheel, theta[0]), mpmath.matrix(spins[:, 0].tolist()))
        closed = [solutions(judged or wheel, angle) * weights for angle in theta]
        found = np.array([[float(c) for c in column] for column in closed]).T
    return float(np.abs(found - spins).max() / np.abs(spins).max())
