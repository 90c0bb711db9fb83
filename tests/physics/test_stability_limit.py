"""The critical speed of upright straight rolling, found from both sides. s = 0, J_x = J_y.

A lean e = theta - pi/2 follows e'' = -kappa^2 e with kappa^2 linear in omega_z^2 (derived in closed_forms.py):
omega_z^2 > m g r_0 J_x / (J_z (J_z + m (r_0 + r)^2)) is stable; the paper's wheel needs 2.63 rad/s and has 2.
"""

import numpy as np
from reference import Wheel
from support.bounds import beyond, within
from support.closed_forms import critical_spin, upright_stiffness
from support.motion import Library

from .exact_motions import TORUS, lean_of, measured_critical_spin


def test_a_lean_swings_or_grows_by_the_linearised_equation(library: Library) -> None:
    times = np.linspace(0, 1.5, 31)

    def gap(judged: Wheel, factor: float) -> float:
        omega_z = factor * critical_spin(TORUS)
        kappa = np.sqrt(complex(upright_stiffness(judged, omega_z)))
        return float(np.abs(lean_of(library, omega_z, times) - np.cos(kappa * times).real).max())

    for factor in (0.5, 0.9, 1.1, 2.0):
        within(gap(TORUS, factor), 2e-6, "gap")
        beyond(gap(Wheel(r=0.0), factor), 1e-2, "gap")


def test_the_critical_speed_is_the_zero_of_the_measured_stiffness(library: Library) -> None:
    found = measured_critical_spin(library)
    within(abs(found / critical_spin(TORUS) - 1), 3e-9, "critical spin")
    beyond(abs(found / critical_spin(Wheel(r=0.0)) - 1), 0.05, "critical spin")  # the thin disc's formula
    lever = ((TORUS.r_0 + TORUS.r) / TORUS.r_0) ** 0.5  # the weight's lever taken as r_0 + r
    beyond(abs(found / (lever * critical_spin(TORUS)) - 1), 0.05, "critical spin, 2")
