"""Three formulations, one wheel: reduced, multibody (24), and two derivations that share no code.

Pointwise, at ten thousand random states each: wheels, motions and loads of pointwise.py. The numpy transcription
of the paper and the rotation-matrix reference under reference/ judge the product.
"""

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.paper_transcription import Paper, dynamics_of, set_rolling, solved
from wheelfmu.truth.pointwise import distance, draw, dynamics, referenced, relative


def test_the_random_states_include_both_signs_of_the_normal_force() -> None:
    scenes, motions = draw(1, eq.ROLLING)
    found = dynamics(eq.MULTIBODY, scenes, motions)
    pulls = found["lambda_"][:, 2] <= 0
    within(abs(pulls.mean() - 0.5), 0.3, "share of grounds that pull, off a half")
    braked = -scenes["friction"]["sigma"] * scenes["load"]["brake"]
    assert (found["tau"][pulls] == braked[pulls]).all()  # no pressure, no friction but the brake's
    assert (found["tau"][~pulls] != braked[~pulls]).all()
    within(abs((braked[pulls] != 0).mean() - 0.45), 0.15, "share of those under a brake, off 0.45")


def test_reduced_and_multibody_give_the_same_positions_and_velocities() -> None:
    scenes, motions = draw(2)
    reduced, multibody = (
        eq.kinematics_each(f, scenes, eq.start_each(f, scenes, motions)) for f in (eq.REDUCED, eq.MULTIBODY)
    )
    a, b = (eq.columns(k, *k.dtype.names) for k in (reduced, multibody))
    within(relative(a, b), 64 * EPSILON, "positions and velocities apart, relative")
    names = [name for name in motions.dtype.names if name not in ("slip_x", "slip_y")]
    given = eq.columns(motions, *names)
    within(relative(eq.columns(reduced, *names), given), 64 * EPSILON, "those given and read, relative")
    scenes["wheel"]["r"] += 1e-9
    moved = eq.kinematics_each(eq.REDUCED, scenes, eq.start_each(eq.REDUCED, scenes, motions))
    beyond(relative(eq.columns(moved, *moved.dtype.names), b), 1e-10, "those of a tube thicker by 1 nm apart, relative")


EULER = ("X_O", "Y_O", "psi", "theta", "phi", "theta_dot", "psi_dot", "omega_z")  # the states of model exchange


def test_the_states_of_model_exchange_are_read_back_to_the_bit_and_move_as_the_reduced_form_does(law: int) -> None:
    scenes, motions = draw(2, law)
    y = eq.start_each(eq.REDUCED, scenes, motions)
    k = eq.kinematics_each(eq.REDUCED, scenes, y)
    x = eq.columns(k, *EULER)
    x[:, 6] = motions["psi_dot"]
    within(relative(eq.filled(np.zeros_like(y), eq.LIBRARY.wheel_reduced_state, x), y), 2 * EPSILON, "y of x, relative")
    read = eq.filled(eq.table(eq.Kinematics, len(x)), eq.LIBRARY.wheel_euler_kinematics, scenes, x)
    assert (eq.columns(read, *EULER) == x).all()
    assert not (eq.columns(k, *EULER) == x).all()  # psi_dot is computed anew from y
    within(relative(eq.columns(read, *k.dtype.names), eq.columns(k, *k.dtype.names)), 16 * EPSILON, "kinematics")
    y_dot, _ = eq.derivative_each(eq.REDUCED, scenes, y)
    x_dot = eq.filled(np.zeros_like(x), eq.LIBRARY.wheel_euler_rates, x, y_dot)
    rates = rates_of(k, eq.dynamics_each(eq.REDUCED, scenes, y))
    stated = np.column_stack([rates[name] for name in EULER])
    within(relative(x_dot, stated), 256 * EPSILON, "rates of x, relative")
    beyond(relative(x_dot, stated * np.where(np.arange(8) == 6, 1.001, 1)), 8e-5, "with one 0.1 % larger")


def test_the_derivative_is_that_of_the_kinematics_and_returns_the_normal_force(law: int) -> None:
    scenes, motions = draw(3, law)
    for formulation, state in STATES:
        y = eq.start_each(formulation, scenes, motions)
        y_dot, normal = eq.derivative_each(formulation, scenes, y)
        found = eq.dynamics_each(formulation, scenes, y)
        rates = rates_of(eq.kinematics_each(formulation, scenes, y), found)
        stated = np.column_stack([rates[name] for name in state])
        within(relative(y_dot, stated), 256 * EPSILON, "rates of all states, relative")
        beyond(relative(y_dot, stated * np.where(np.arange(y.shape[1]) == 0, 1.001, 1)), 8e-5, "with one 0.1 % larger")
        assert (normal == found["lambda_"][:, 2]).all()


PLACES, ANGLES = ("X_O", "Y_O", "Z_O"), ("psi", "theta", "phi")
REDUCED = ("theta", "theta_dot", "omega_2", "omega_z", "psi", "phi", "X_O", "Y_O")
STATES = (
    (eq.REDUCED, REDUCED),
    (eq.MULTIBODY, REDUCED),
)


def rates_of(k: np.ndarray, d: np.ndarray) -> dict[str, np.ndarray]:
    """Of each state, from velocities and accelerations; omega_2 = psi_dot sin(theta)."""
    rates = {name: k[f"{name}_dot"] for name in (*PLACES, *ANGLES)}
    rates |= {f"{name}_dot": d[f"{name}_ddot"] for name in (*PLACES, *ANGLES)}
    turning = k["psi_dot"] * k["theta_dot"] * np.cos(k["theta"])
    return rates | {"omega_z": d["omega_z_dot"], "omega_2": d["psi_ddot"] * np.sin(k["theta"]) + turning}


def test_a_spin_set_to_zero_leaves_a_rolling_wheel_that_holding_takes_no_energy_from(
    formulation: eq.Formulation,
) -> None:
    scenes, motions = draw(32, eq.HELD, symmetric=False)
    y = eq.start_each(formulation, scenes, motions)
    before = eq.kinematics_each(formulation, scenes, y)
    assert (before["omega_z"] != 0).all()
    y[:, eq.OMEGA_3] = 0
    after = eq.kinematics_each(formulation, scenes, y)
    kept = ("X_O", "Y_O", "Z_O", "psi", "theta", "phi", "psi_dot", "theta_dot")
    assert (after["omega_z"] == 0).all()
    within(np.abs(eq.columns(after, *kept) - eq.columns(before, *kept)).max(), 64 * EPSILON, "change of the kept, SI")
    rolling = eq.columns(after, *after.dtype.names[:12])
    within(np.abs(Paper(scenes["wheel"], rolling).slip).max(), 32 * 60 * EPSILON, "slip, m/s")  # speeds of 60 m/s
    slid = np.hstack([rolling[:, :11], eq.columns(before, "phi_dot")])
    beyond(np.abs(Paper(scenes["wheel"], slid).slip).max(), 6, "slip with phi_dot as it was, m/s")
    assert (eq.dynamics_each(formulation, scenes, y)["tau"] * after["omega_z"] == 0).all()


def transcribed(scenes: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """WheelDynamics from the numpy transcription of (24)."""
    paper = Paper(scenes["wheel"], set_rolling(scenes["wheel"], motions))
    return dynamics_of(paper, solved(paper, scenes), scenes)


def test_multibody_solves_the_papers_system_24_for_any_inertia(law: int) -> None:
    scenes, motions = draw(5, law, symmetric=False)
    multibody = dynamics(eq.MULTIBODY, scenes, motions)
    # two solutions for 9 unknowns
    within(distance(multibody, transcribed(scenes, motions), scenes), 32768 * EPSILON, "dynamics, relative")
    scenes["wheel"]["J_y"] *= 1 + 1e-9
    beyond(distance(multibody, transcribed(scenes, motions), scenes), 3e-9, "dynamics with another J_y, relative")


def test_both_formulations_agree_with_the_independent_reference(symmetric: bool) -> None:
    scenes, motions = draw(6, symmetric=symmetric)
    reference = referenced(scenes, motions)
    for formulation in (eq.REDUCED, eq.MULTIBODY):
        found = dynamics(formulation, scenes, motions)
        within(distance(found, reference, scenes), 16384 * EPSILON, "dynamics, relative")  # 1/sin(theta) is up to 20
        disturbed = scenes.copy()
        disturbed["wheel"]["J_z"] *= 1 + 1e-9
        found = dynamics(formulation, disturbed, motions)
        beyond(distance(found, reference, scenes), 5e-9, "dynamics with another J_z, relative")


@pytest.mark.parametrize(("lever", "change"), [(0.2, 0.03), (1.0, 0.15), (10.0, 1.4)])
def test_unequal_inertia_lets_friction_change_N_by_little_for_any_real_s(lever: float, change: float) -> None:
    scenes, motions = draw(1, eq.ROLLING, symmetric=False)
    scenes["wheel"]["s"] = lever * scenes["wheel"]["r_0"]
    paper = Paper(scenes["wheel"], set_rolling(scenes["wheel"], motions))
    free, rolling = (paper.solve(k, scenes["load"]) for k in (0, scenes["friction"]["sigma"]))
    ratio = free[:, 8] / rolling[:, 8]  # 1 + s sigma N_1
    within(np.abs(ratio - 1).max() / change, 1, "change of N over what is stated")
    beyond(np.abs(ratio - 1).max() / change, 0.8, "change of N over what is stated")
    assert (ratio.min() > 0) == (lever < 10)  # Painleve's paradox below 0


@pytest.mark.parametrize("rates", [(0, 0, 0), (1, 0, -2), (1, 0.5, -2)])
def test_a_wheel_that_lies_flat_has_no_finite_derivative(rates: tuple[float, float, float]) -> None:
    scene = eq.scene(eq.paper_wheel())
    for formulation in (eq.REDUCED, eq.MULTIBODY):
        flat, nearly = (
            eq.derivative(formulation, scene, eq.start(formulation, scene.wheel, eq.Motion(0, theta, 0.2, *rates)))
            for theta in (0, 1e-6)
        )
        assert not np.isfinite(flat).all()
        assert np.isfinite(nearly).all()
