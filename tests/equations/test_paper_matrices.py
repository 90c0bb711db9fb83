"""The paper's matrices (1)-(23) state what they should: the numpy transcription against geometry.

Derivatives are taken by a complex step, which is exact to rounding. Body axes for rotation, fixed axes for O.
test_equations.py then holds the product against this transcription; test_errata.py runs it with each misprint.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.paper_transcription import (
    PHI,
    PSI,
    THETA,
    Paper,
    paper_table,
    states,
    times,
    transposed,
)

WHEEL = paper_table(J_x=0.8, J_y=1.1, s=0.03)


def slope(name: str, direction: np.ndarray) -> np.ndarray:
    """Of a matrix of the paper when the state moves along `direction`."""
    return getattr(Paper(WHEEL, states() + 1e-40j * direction), name).imag / 1e-40


def along(index: int) -> np.ndarray:
    return np.eye(12)[index]


def along_the_motion() -> np.ndarray:
    y = states()
    return np.hstack([y[:, 6:], np.zeros((len(y), 6))])


def cross_matrix(v: np.ndarray) -> np.ndarray:
    """Its columns are the products of v and the axes."""
    return transposed(np.cross(v[..., None, :], np.eye(3)))


PARTIALS = [("A", PSI, "A_psi"), ("A", THETA, "A_theta"), ("A", PHI, "A_phi")]
PARTIALS += [("Q", THETA, "Q_theta"), ("Q", PHI, "Q_phi"), ("r", THETA, "r_theta"), ("r", PHI, "r_phi")]


@pytest.mark.parametrize(("of", "angle", "name"), PARTIALS)
def test_partial_derivatives_6_9_12_are_those_of_their_matrices(of: str, angle: int, name: str) -> None:
    stated = getattr(Paper(WHEEL, states()), name)
    within(absolute_error(stated, slope(of, along(angle))), 64 * EPSILON, "partial derivative off the slope")
    other_angle = along(PSI if angle == PHI else PHI)
    beyond(absolute_error(stated, slope(of, other_angle)), 0.02, "partial derivative by another angle")


@pytest.mark.parametrize("name", ["A", "Q", "r", "B"])
def test_time_derivatives_7_10_13_20_are_those_along_the_motion(name: str) -> None:
    stated = getattr(Paper(WHEEL, states()), f"{name}_dot")
    within(absolute_error(stated, slope(name, along_the_motion())), 32 * 10 * EPSILON, "rate of the matrix")  # 10 rad/s
    beyond(absolute_error(stated, slope(name, 1.001 * along_the_motion())), 1e-4, "rate at rates 0.1 % larger")


def test_A_of_4_turns_body_axes_into_fixed_axes_by_z_x_z_angles() -> None:
    y = states()
    angles = y[:, [PSI, THETA, PHI]]
    A = Paper(WHEEL, y).A
    within(absolute_error(A, Rotation.from_euler("ZXZ", angles).as_matrix()), 64 * EPSILON, "[A] off SciPy's rotation")
    beyond(absolute_error(A, Rotation.from_euler("zxz", angles).as_matrix()), 0.1, "[A] off the reversed order")


def test_Q_of_8_gives_the_angular_velocity_in_body_axes() -> None:
    paper = Paper(WHEEL, states())
    spin = transposed(paper.A) @ paper.A_dot
    within(absolute_error(spin, cross_matrix(paper.omega)), 32 * 10 * EPSILON, "angular velocity, rad/s")  # 10 rad/s
    spin_fixed_axes = paper.A_dot @ transposed(paper.A)
    beyond(absolute_error(spin_fixed_axes, cross_matrix(paper.omega)), 1, "angular velocity in fixed axes, rad/s")


def test_r_of_11_points_to_the_lowest_point_of_the_torus() -> None:
    paper, r_0, r = Paper(WHEEL, states()), WHEEL["r_0"], WHEEL["r"]
    within(absolute_error(paper.r, cross_matrix(paper.contact)), 64 * EPSILON, "[r] off the matrix of its vector, m")
    below = times(paper.A, paper.contact)[:, 2]
    around, along_tube = np.meshgrid(*2 * [np.linspace(0, 2 * np.pi, 100)])
    out = r_0 + r * np.cos(along_tube)
    surface = np.stack([out * np.cos(around), out * np.sin(around), r * np.sin(along_tube)], -1)
    lowest = (surface.reshape(-1, 3) @ paper.A[:, 2].T).min(0)
    assert (below <= lowest + 1e-12).all()  # no point of the torus lies lower
    within(absolute_error(below, lowest), 5e-4, "height of the point off the lowest, m")  # and it is one of them
    assert (0.98 * below > lowest).any()  # a point 2 % higher is not the lowest


def test_B_of_19_gives_the_velocity_of_the_material_point_at_the_contact() -> None:
    y = states()
    paper = Paper(WHEEL, y)
    velocity = y[:, 6:9] + times(paper.A, np.cross(paper.omega, paper.contact))
    within(absolute_error(times(paper.B, y[:, 6:]), velocity), 64 * EPSILON, "velocity of the contact, m/s")
    untransposed = y[:, 6:9] + times(paper.A @ paper.r @ paper.Q, y[:, 9:])
    beyond(absolute_error(untransposed, velocity), 0.5, "velocity with [r] as it is, m/s")


def test_omega_z_of_21_is_the_axle_component_of_the_angular_velocity() -> None:
    y = states()
    axle = Paper(WHEEL, y).omega[:, 2]
    within(absolute_error(Paper(WHEEL, y).omega_z, axle), 64 * EPSILON, "omega_z of (21), rad/s")
    scenes = eq.table(eq.Scene, len(y))
    scenes["wheel"] = WHEEL
    motions = eq.table(eq.Motion, len(y))
    for name, column in {"psi": 3, "theta": 4, "phi": 5, "psi_dot": 9, "theta_dot": 10, "phi_dot": 11}.items():
        motions[name] = y[:, column]
    k = eq.kinematics_each(eq.MULTIBODY, scenes, eq.start_each(eq.MULTIBODY, scenes, motions))
    within(absolute_error(k["omega_z"], axle), 64 * EPSILON, "omega_z of the product, rad/s")
    within(absolute_error(k["phi_dot"], y[:, 11]), 64 * EPSILON, "phi_dot of the product, rad/s")
    beyond(absolute_error(y[:, 11], axle), 0.6, "phi_dot off omega_z, rad/s")


def test_M_and_F_beta_of_16_18_are_eulers_equations_in_body_axes() -> None:
    y = states()
    paper = Paper(WHEEL, y)
    beta_ddot = np.random.default_rng(3).normal(size=(len(y), 3))
    omega_dot = times(paper.Q, beta_ddot) + times(paper.Q_dot, paper.beta_dot)
    spin = times(paper.J, paper.omega)
    euler = times(paper.J, omega_dot) + np.cross(paper.omega, spin)
    stated = times(paper.M, np.hstack([beta_ddot, beta_ddot]))[:, 3:] - paper.F_beta
    within(absolute_error(stated, euler), 16 * 100 * EPSILON, "rate of spin, N m")  # terms of 100 N m
    beyond(absolute_error(stated + np.cross(spin, paper.omega), euler), 2, "without the gyroscopic part, N m")


def test_B_tilde_of_22_23_turns_lambda_into_force_and_moment_on_the_wheel() -> None:
    paper = Paper(WHEEL, states())
    force = np.random.default_rng(4).normal(size=(len(states()), 3))
    moment = np.cross(paper.contact, times(transposed(paper.A), force))
    without_friction = np.hstack([force, moment])
    within(absolute_error(times(paper.B_tilde(0), force), without_friction), 64 * EPSILON, "force, N, and moment, N m")
    moment[:, 2] -= WHEEL["s"] * force[:, 2]
    with_friction = np.hstack([force, moment])
    within(absolute_error(times(paper.B_tilde(1), force), with_friction), 64 * EPSILON, "with friction, N, N m")
    beyond(absolute_error(with_friction, without_friction), 0.01, "change by friction, N m")


def test_constants_and_start_values_of_27_to_33_are_those_the_paper_prints() -> None:
    wheel = eq.paper_wheel(s=0.3 / 10)
    within(relative_error((wheel.J_x, wheel.J_y), (wheel.m * wheel.r_0**2 / 2,) * 2), 16 * EPSILON, "J_x, J_y")
    within(relative_error(wheel.J_z, wheel.m * wheel.r_0**2), 16 * EPSILON, "J_z")
    printed = [-0.07765, 0, 0.33978, 0, 0.69659, 0]
    for formulation in (eq.REDUCED, eq.MULTIBODY):
        k = eq.kinematics(formulation, wheel, eq.start(formulation, wheel, eq.PAPER_START))
        found = [k.X_O, k.Y_O, k.Z_O, k.X_O_dot, k.Y_O_dot, k.Z_O_dot]
        within(absolute_error(found, printed), 5e-6, "place, m, and velocity, m/s")  # five digits are printed
        thin = eq.paper_wheel(r=0)
        k = eq.kinematics(formulation, thin, eq.start(formulation, thin, eq.PAPER_START))
        beyond(abs(k.Y_O_dot - 0.69659), 0.05, "velocity of a disc, m/s")  # (33) needs the tube
