"""The paper's misprints, each proven by what it does: docs/errata.md lists them.

The numpy transcription of (1)-(24) keeps a misprint on request; the paper's free wheel (27)-(33) is set rolling with
SciPy. The mended matrices are judged by a complex step, Euler's equations, and as a whole by test_equations.py.
"""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.misprints import WHEEL, papers_start, rolled
from wheelfmu.truth.paper_transcription import PHI, PSI, THETA, Paper, paper_table, states, times, transposed

UNEQUAL = paper_table(J_x=0.8, J_y=1.1, s=0.03)
ALONG = {"psi": np.eye(12)[PSI], "theta": np.eye(12)[THETA], "phi": np.eye(12)[PHI]}
ALONG["dot"] = np.hstack([states()[:, 6:], np.zeros((1000, 6))])  # the motion
DERIVATIVES = ("A_psi", "A_theta", "A_phi", "Q_theta", "Q_phi", "r_theta", "r_phi", "A_dot", "Q_dot", "r_dot", "B_dot")


@pytest.mark.parametrize("name", DERIVATIVES)
def test_mended_the_derivatives_6_to_20_are_those_of_their_matrices(name: str) -> None:
    """By a complex step, which is exact to rounding."""
    of, along = name.split("_")
    stated = getattr(Paper(UNEQUAL, states()), name)
    slope = getattr(Paper(UNEQUAL, states() + 1e-40j * ALONG[along]), of).imag / 1e-40
    within(absolute_error(stated, slope), 320 * EPSILON, "derivative off the slope")  # of matrices times 10 rad/s
    beyond(absolute_error(stated, 1.001 * slope), 1e-5, "derivative off a slope 0.1 % larger")


def test_mended_M_and_F_beta_of_16_18_are_eulers_equations_in_body_axes() -> None:
    y = states()
    paper = Paper(UNEQUAL, y)
    beta_ddot = np.random.default_rng(3).normal(size=(len(y), 3))
    omega_dot = times(paper.Q, beta_ddot) + times(paper.Q_dot, paper.beta_dot)
    spin = times(paper.J, paper.omega)
    euler = times(paper.J, omega_dot) + np.cross(paper.omega, spin)
    stated = times(paper.M, np.hstack([beta_ddot, beta_ddot]))[:, 3:] - paper.F_beta
    within(absolute_error(stated, euler), 16 * 100 * EPSILON, "rate of spin, N m")  # terms of 100 N m
    beyond(absolute_error(stated + np.cross(spin, paper.omega), euler), 2, "without the gyroscopic part, N m")


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


# ---- each misprint ----

ENERGY = 75.1168064  # J, at the start of the free wheel


def test_mended_the_free_wheel_keeps_its_energy_and_stays_on_the_ground() -> None:
    t, y, energy = rolled(10.0)
    assert t[-1] == 10
    within(absolute_error(energy, ENERGY), 1e-6, "change of the energy, J")
    within(absolute_error(y[:, 2], 0.3 * np.sin(y[:, THETA]) + 0.05), 6e-9, "height off the contact, m")
    beyond(np.degrees(y[:, THETA].min()), 27, "least tilt, degrees")


def test_printed_U_theta_of_5_sinks_the_free_wheel_into_the_ground() -> None:
    t, y, energy = rolled(10.0, "U_theta")
    within(abs(t[-1] - 1.6), 0.02, "instant at which O reaches the ground, s")  # rows are 0.02 s apart
    beyond(absolute_error(y[:, 2], 0.3 * np.sin(y[:, THETA]) + 0.05), 0.2, "height off the contact, m")
    within(energy.min(), 20, "least energy, J")


def test_printed_Q_theta_of_9_lets_the_energy_of_the_free_wheel_wander() -> None:
    t, _, energy = rolled(10.0, "Q_theta")
    assert t[-1] == 10
    within(energy.min(), 0.8 * ENERGY, "least energy, J")
    beyond(energy.max(), 2.4 * ENERGY, "largest energy, J")


def test_printed_sign_of_F_beta_16_drives_the_free_wheel_through_the_ground() -> None:
    t, y, energy = rolled(0.7, "F_beta")
    flat = np.flatnonzero(y[:, THETA] < 0)[0]
    within(abs(t[flat] - 0.585), 0.015, "instant at which it lies flat, s")
    within(t[-1], 0.62, "instant at which O reaches the ground, s")
    beyond(energy.max(), 1.08 * ENERGY, "largest energy, J")


def test_a_sign_without_the_bracket_of_16_keeps_the_energy_but_not_the_motion() -> None:
    _, y, energy = rolled(0.8, "F_beta_bracket")
    within(absolute_error(energy, ENERGY), 1e-6, "change of the energy, J")  # the term at fault does no work
    within(np.degrees(y[:, THETA].min()), 1, "least tilt, degrees")
    _, y, _ = rolled(10.0)
    beyond(np.degrees(y[:, THETA].min()), 27, "least tilt, degrees")


def test_16_needs_its_bracket_for_both_terms_to_be_of_one_dimension() -> None:
    y, faster = states(), states()
    faster[:, 6:] *= 3  # a unit of time three times as long

    def terms(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        paper = Paper(WHEEL, y)
        gyroscopic = transposed(paper.A) @ paper.A_dot @ paper.J @ paper.Q
        return paper.J @ paper.Q_dot, times(gyroscopic, paper.beta_dot)

    (first, second), (first_faster, second_faster) = terms(y), terms(faster)
    assert first.shape[1:] == (3, 3)  # a matrix
    assert second.shape[1:] == (3,)  # plus a column
    within(absolute_error(first_faster, 3 * first), 512 * EPSILON, "matrix off three times itself")  # 1/s
    within(absolute_error(second_faster, 9 * second), 16384 * EPSILON, "column off nine times itself")  # plus 1/s2
    beyond(absolute_error(first_faster, 9 * first), 4, "matrix off nine times itself")


def test_24_taken_as_printed_for_q_dot_contradicts_the_constraint_19() -> None:
    t, y, _ = rolled(10.0)
    paper = Paper(WHEEL, y[t == 1][0])
    within(np.abs(times(paper.B, paper.q_dot)).max(), 1e-9, "[B]{q_dot}, m/s")  # the wheel rolls
    beyond(np.abs(times(paper.B_dot, paper.q_dot)).max(), 0.5, "[B_dot]{q_dot}, m/s2")  # not -[B]{q_dot}
    x = paper.solve()[:6]
    within(absolute_error(times(paper.B, x), -times(paper.B_dot, paper.q_dot)), 128 * EPSILON, "sum of the two, m/s2")
    beyond(absolute_error(x, paper.q_dot), 1, "solution of (24) off {q_dot}")


def test_24_yields_accelerations_by_their_dimension() -> None:
    y, wheel = states(), WHEEL.copy()
    slow = Paper(wheel, y).solve()
    y[:, 6:] *= 3  # a unit of time three times as long
    wheel["g_n"] *= 9
    fast = Paper(wheel, y).solve()
    size = np.abs(fast).max(axis=1, keepdims=True)
    within(absolute_error(fast / size, 9 * slow / size), 256 * EPSILON, "solution off nine times itself")  # 1/s2
    beyond(absolute_error(fast / size, 3 * slow / size), 0.1, "solution off three times itself")  # not 1/s


def test_the_minus_of_24_belongs_to_B_tilde_alone() -> None:
    paper = Paper(WHEEL, papers_start())
    assert paper.M.shape == (6, 6)
    assert paper.B_tilde(0).shape == (6, 3)  # a block beside [M]; no difference is defined
    K, column = paper.system(0)
    weight = 20 * 9.81
    assert 0.9 * weight < np.linalg.solve(K, column)[8] < weight  # the ground presses upwards
    K[:6, 6:] *= -1
    assert np.linalg.solve(K, column)[8] < -0.9 * weight


def test_22_says_nothing_at_omega_z_zero_where_the_held_moment_is_finite() -> None:
    y = papers_start()
    y[[9, 11]] = 0
    with np.errstate(invalid="ignore"):
        sign = Paper(WHEEL, y).omega_z / np.abs(Paper(WHEEL, y).omega_z)
    assert np.isnan(sign)
    assert np.isfinite(Paper(WHEEL, y).solve_held()).all()


def test_31_gives_the_inertia_of_the_ring_not_of_the_torus() -> None:
    edges = (np.arange(60) + 0.5) / 60
    a, b, u = np.meshgrid(0.05 * edges, 2 * np.pi * edges, 2 * np.pi * edges)
    out, z = 0.3 + a * np.cos(b), a * np.sin(b)
    mass = a * out / (a * out).sum() * 20  # equal density
    J_x = (mass * ((out * np.sin(u)) ** 2 + z**2)).sum()
    J_z = (mass * out**2).sum()
    within(relative_error(J_x, 20 * (0.3**2 / 2 + 5 / 8 * 0.05**2)), 1e-4, "J_x of the torus, relative")
    within(relative_error(J_z, 20 * (0.3**2 + 3 / 4 * 0.05**2)), 4e-5, "J_z of the torus, relative")
    within(abs(J_x / 0.9 - 1.035), 0.005, "J_x over that of the ring, off 1.035")
    within(abs(J_z / 1.8 - 1.025), 0.005, "J_z over that of the ring, off 1.025")
