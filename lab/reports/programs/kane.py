"""The torus wheel by Kane's method, derived by symbrim (TU Delft's package of bicycle models, with SymPy).

symbrim's fixed axes are x = X, y = -Y, z = -Z (down), its angles yaw = -psi, roll = theta - pi/2, pitch = phi about
the axle. Its wheel has one moment of inertia across the axle; here its body is given two. Kane's equations leave the
ground's force out; its normal part is asked for through an auxiliary speed. Rolling resistance and brake are one open
moment tau about the axle, in which everything is linear.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
import sympy as sp
from symbrim.bicycle import FlatGround, InContactTire, ToroidalWheel
from symbrim.other import RollingDisc
from sympy.physics.mechanics import Force, Torque, inertia

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.pointwise import answers, draw
from wheelfmu.truth.reference import Wheel
from wheelfmu.truth.reference.model import Vector

LOADS = sp.symbols("F_X F_Y F_Z M_1 M_2 M_3 tau")
INERTIAS = sp.symbols("J_x J_y J_z")


class Motion(NamedTuple):
    """Second derivatives of the angles, rad/s2, and the normal force, N."""

    psi_ddot: float
    theta_ddot: float
    phi_ddot: float
    lambda_3: float


def model() -> RollingDisc:
    """The wheel on its contact, with every load that wheel.fmu knows."""
    disc = RollingDisc("disc")
    disc.ground, disc.wheel, disc.tire = FlatGround("ground"), ToroidalWheel("wheel"), InContactTire("tire")
    disc.tire.no_lateral_slip = disc.tire.no_longitudinal_slip = True
    disc.define_connections()
    disc.define_objects()
    body, (J_x, J_y, J_z) = disc.wheel.body, INERTIAS
    body.central_inertia = inertia(body.frame, J_x, J_z, J_y)  # symbrim's y is the axle
    disc.define_kinematics()
    disc.define_loads()
    fixed, (F_X, F_Y, F_Z, M_1, M_2, M_3, tau) = disc.ground.frame, LOADS
    weight = body.mass * sp.Symbol("g")
    force = F_X * fixed.x - F_Y * fixed.y + (weight - F_Z) * fixed.z
    moment = M_1 * disc.tire.longitudinal_axis + M_2 * disc.tire.upward_radial_axis
    moment += (M_3 + tau) * disc.wheel.rotation_axis
    disc.system.add_loads(Force(disc.wheel.center, force), Torque(disc.wheel.frame, moment))
    disc.define_constraints()
    return disc


@cache
def numeric() -> Callable[..., tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """(angles, rates, parameters, loads) -> matrix, right side, its rate with tau; unknowns u_dot, lambda_3."""
    disc = model()
    system = disc.to_system()
    system.q_ind, system.q_dep = disc.q, []
    system.u_ind, system.u_dep = disc.u[2:], disc.u[:2]
    system.form_eoms(constraint_solver="CRAMER")
    kane, normal, rate = system.eom_method, disc.tire.symbols["Fz"], sp.Matrix(disc.u).diff()
    found = sp.Matrix(kane.u.diff().tolist())
    (auxiliary,) = kane.auxiliary_eqs
    unknowns = sp.Matrix([*found, normal])
    tau = LOADS[-1]
    balance = sp.Matrix([*(kane.mass_matrix * found - kane.forcing), auxiliary])
    assert set(found) == set(rate)
    matrix, right = sp.linear_eq_to_matrix(balance, *unknowns)
    per_tau = right.diff(tau)
    wheel = disc.wheel
    parameters = (wheel.body.mass, wheel.radius, wheel.transverse_radius, *INERTIAS, sp.Symbol("g"))
    given = disc.q[2:], disc.u, parameters, LOADS[:-1]
    return sp.lambdify(given, (matrix, right.subs(tau, 0), per_tau), "numpy", cse=True)


def accelerations(wheel: Wheel, angles: Vector, rates: Vector, F: Vector, M: Vector, sigma=0.0, brake=0.0) -> Motion:
    """At (psi, theta, phi) and their rates; tau = -(s lambda_3 + brake) sigma, sigma None: the tau that holds."""
    (psi, theta, phi), (psi_dot, theta_dot, phi_dot) = angles, rates
    yaw, roll, pitch = -psi, theta - np.pi / 2, phi
    parameters = (wheel.m, wheel.r_0, wheel.r, wheel.J_x, wheel.J_y, wheel.J_z, wheel.g)
    speeds = (0.0, 0.0, -psi_dot, theta_dot, phi_dot)  # those of the contact point, which do not enter

    matrix, *columns = numeric()((yaw, roll, pitch), speeds, parameters, (*F, *M))
    yaw_ddot, roll_ddot, pitch_ddot, *_, normal = np.linalg.solve(matrix, np.hstack(columns))
    free, per_tau = np.array([-yaw_ddot, roll_ddot, pitch_ddot, normal]).T

    def spin_up(x: np.ndarray) -> float:
        return x[2] + x[0] * np.cos(theta)

    if sigma is None:
        coriolis = psi_dot * theta_dot * np.sin(theta)
        tau = (coriolis - spin_up(free)) / spin_up(per_tau)
    else:
        tau = -sigma * (wheel.s * free[3] + brake) / (1 + sigma * wheel.s * per_tau[3])
    return Motion(*(free + tau * per_tau))


NAMES = ("psi_ddot", "theta_ddot", "phi_ddot")


def distance(rows: int = 200, symmetric: bool = False, stretched: float = 1.0) -> float:
    """Of wheel_equations.h at random states: accelerations relative to the largest of a state, N to the ground's force.

    stretched: factor on the tube radius that Kane's method is given.
    """
    scenes, motions = draw(24, None, symmetric, rows)
    found = eq.dynamics_each(eq.REDUCED, scenes, eq.start_each(eq.REDUCED, scenes, motions))
    scenes["wheel"]["r"] *= stretched
    other = np.array([*answers(accelerations, scenes, motions)])
    ours = eq.columns(found, *NAMES)
    angles = np.abs(ours - other[:, :3]).max(axis=1) / np.abs(ours).max(axis=1)
    forces = np.abs(found["lambda_"][:, 2] - other[:, 3]) / np.abs(found["lambda_"]).max(axis=1)
    return float(max(angles.max(), forces.max()))
