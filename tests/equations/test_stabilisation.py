"""The multibody state and its stabilisation: omega_z is a state, and errors of the constraints decay.

(24) fixes the constraints as accelerations: alone it keeps an error of [B]{q_dot} and lets that of the height grow. The
product's derivative draws both to zero at the rate a = 5 sqrt(|g| / (r_0 + r) + |omega|^2): docs/decisions/
multibody_state.md. Integrated by SciPy, so that no solver of the product takes part. Fixed axes for O.
"""

import numpy as np
from equations import random_scenes
from equations.multibody_transcription import Stabilised, papers_state, products_state, solved, stabilised_rate
from equations.paper_transcription import Paper
from equations.pointwise import Table, relative
from scipy.integrate import solve_ivp
from support import equations as eq
from support.bounds import EPSILON, beyond, within

OFF_THE_CONSTRAINTS = np.array([0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0])  # m in Z_O, m/s in the velocity of O
PLANTED = np.array([0, 0, 2e-3, 0, 0, 0, 1e-2, -2e-2, 3e-2, 0, 0, 0])  # the same, of unlike sizes
GENERAL = {"J_x": 0.7, "J_y": 1.1, "s": 0.03}
SPIN = 11


def scene(law: int) -> eq.Scene:
    return eq.scene(eq.paper_wheel(**GENERAL), law, sigma=-1, omega_s=2, moment=(0.1, -0.2, 0.3))


def start(law: int) -> Table:
    y = eq.start(eq.MULTIBODY, scene(law).wheel, eq.Motion(np.pi / 2, 5 * np.pi / 12, 0, 0.5, 0, -2, 0, 0))
    if law == eq.HELD:
        eq.MULTIBODY.stop_spin(scene(law).wheel, y.ctypes.data_as(eq.DOUBLES))
    return y


def stabilised(now: eq.Scene, y: Table, times: Table, tolerance=1e-12, method="DOP853") -> tuple[Table, Table]:
    """The product's states along its own derivative, and the integral of the decay rate."""
    wheel = np.frombuffer(bytes(now.wheel), np.dtype(eq.Parameters))

    def rate(_t: float, y: Table) -> Table:
        q = papers_state(y[None, :-1])
        return np.append(eq.derivative(eq.MULTIBODY, now, y[:-1].copy()), Stabilised(wheel, q).decay_rate)

    run = solve_ivp(rate, times[[0, -1]], np.append(y, 0), method, times, rtol=tolerance, atol=tolerance)
    return run.y.T[:, :-1], run.y.T[:, -1]


def pure(now: eq.Scene, y: Table, times: Table, tolerance: float = 1e-12, method: str = "DOP853") -> Table:
    """The product's states along the transcription of (24), integrated in the paper's own q, q_dot."""
    scenes = np.frombuffer(bytes(now), np.dtype(eq.Scene))

    def rate(_t: float, q: Table) -> Table:
        return np.append(q[6:], solved(Paper(scenes["wheel"], q[None]), scenes)[0, :6])

    run = solve_ivp(rate, times[[0, -1]], papers_state(y), method, times, rtol=tolerance, atol=tolerance)
    return products_state(run.y.T)


def residuals(now: eq.Scene, y: Table) -> tuple[Table, Table]:
    """[B]{q_dot}, m/s, and the error of the height, m."""
    wheel = np.frombuffer(bytes(now.wheel), np.dtype(eq.Parameters))
    paper = Stabilised(wheel, papers_state(y))
    return paper.slip, paper.height_error


def test_the_multibody_derivative_is_24_with_slip_and_height_drawn_to_zero(law: int) -> None:
    random = np.random.default_rng(61)
    scenes = random_scenes.scenes(random, law, symmetric=False, rows=2000)
    rolling = eq.start_each(eq.MULTIBODY, scenes, random_scenes.motions(random, 2000))
    off = random.normal(size=rolling.shape) * OFF_THE_CONSTRAINTS
    y_dot, _ = eq.derivative_each(eq.MULTIBODY, scenes, rolling + off)
    # two solutions
    within(relative(y_dot, stabilised_rate(scenes, rolling + off)), 2048 * EPSILON, "relative difference")
    smaller = stabilised_rate(scenes, rolling + 0.999 * off)  # errors 0.1 % smaller
    beyond(relative(y_dot, smaller), 8e-4, "relative difference")


def test_24_itself_sees_neither_slip_nor_height(law: int) -> None:
    random = np.random.default_rng(62)
    scenes = random_scenes.scenes(random, law, symmetric=False, rows=2000)
    rolling = eq.start_each(eq.MULTIBODY, scenes, random_scenes.motions(random, 2000))
    slipping = rolling + random.normal(size=rolling.shape) * OFF_THE_CONSTRAINTS
    answers = [eq.dynamics_each(eq.MULTIBODY, scenes, y) for y in (rolling, slipping)]
    assert (answers[0] == answers[1]).all()
    rates = [eq.derivative_each(eq.MULTIBODY, scenes, y)[0][:, 6:] for y in (rolling, slipping)]
    beyond(relative(*rates), 0.6, "relative difference")  # the stabilised derivative does


def test_errors_of_the_constraints_decay_at_the_stated_rate(law: int) -> None:
    times = np.linspace(0, 0.25, 26)
    y, decay = stabilised(scene(law), start(law) + PLANTED, times)
    slip, height = residuals(scene(law), y)

    def gap(decay: Table) -> float:
        """slip = planted exp(-decay); the height follows, driven by the vertical slip."""
        expected = PLANTED[2] + PLANTED[8] * times
        grown = np.column_stack([slip, height]) * np.exp(decay)[:, None]
        return float(np.abs(grown - np.column_stack([np.tile(PLANTED[6:9], (len(times), 1)), expected])).max())

    assert decay[-1] > 5  # 6.7 to 7.1
    within(gap(decay), 2e-8, "gap")  # m, m/s
    beyond(gap(1.001 * decay), 1e-5, "gap")  # a rate 0.1 % larger


def test_24_alone_keeps_the_slip_and_lets_the_height_run_away(law: int) -> None:
    times = np.linspace(0, 0.25, 26)
    slip, height = residuals(scene(law), pure(scene(law), start(law) + PLANTED, times))
    within(np.abs(slip - PLANTED[6:9]).max(), 2e-11, "slip")  # m/s, at a tolerance of 1e-12
    within(np.abs(height - PLANTED[2] - PLANTED[8] * times).max(), 5e-12, "height")  # m
    y, _ = stabilised(scene(law), start(law) + PLANTED, times)
    drawn_slip, drawn_height = residuals(scene(law), y)
    within(np.abs(drawn_slip[-1]).max() / np.abs(slip[-1]).max(), 1e-2, "drawn slip")
    within(np.abs(drawn_height[-1]) / height[-1], 1e-2, "drawn height")


def test_on_the_constraints_the_stabilised_motion_is_that_of_24(law: int) -> None:
    times = np.linspace(0, 1, 11)
    alone = pure(scene(law), start(law), times)
    drawn, _ = stabilised(scene(law), start(law), times)
    disturbed, _ = stabilised(scene(law), start(law) + 1e-6 * PLANTED, times)
    within(np.abs(drawn - alone).max(), 2e-10, "drawn")
    beyond(np.abs(disturbed - alone).max(), 5e-8, "disturbed")  # a slip of 30 nm/s at the start


def test_a_held_wheel_keeps_omega_z_at_exactly_zero() -> None:
    times = np.linspace(0, 1, 101)
    y, _ = stabilised(scene(eq.HELD), start(eq.HELD), times, 1e-6)
    assert (y[:, SPIN] == 0).all()
    in_phi_dot = pure(scene(eq.HELD), start(eq.HELD), times, 1e-6)
    beyond(np.abs(in_phi_dot[:, SPIN]).max(), 8e-8, "in phi dot")  # rad/s; phi_dot as a state lets it drift
