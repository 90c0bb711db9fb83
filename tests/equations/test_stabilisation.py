"""The multibody state and its stabilisation: omega_z is a state, and errors of the constraints decay.

(24) fixes the constraints as accelerations: alone it keeps an error of [B]{q_dot} and lets that of the height grow. The
product's derivative draws both to zero at the rate a = 5 sqrt(|g| / (r_0 + r) + |omega|^2):
docs/decisions/solver.md. Fixed axes for O.
"""

import numpy as np
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.paper_transcription import stabilised_rate
from wheelfmu.truth.pointwise import Table, draw, relative

OFF_THE_CONSTRAINTS = np.array([0, 0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0])  # m in Z_O, m/s in the velocity of O
SPIN = 11


def rolling_and_off(law: int) -> tuple[Table, Table, Table]:
    """Scenes, states on the constraints, and what takes them off."""
    scenes, motions = draw(61, law, symmetric=False, rows=2000)
    rolling = eq.start_each(eq.MULTIBODY, scenes, motions)
    return scenes, rolling, np.random.default_rng(62).normal(size=rolling.shape) * OFF_THE_CONSTRAINTS


def test_the_multibody_derivative_is_24_with_slip_and_height_drawn_to_zero(law: int) -> None:
    scenes, rolling, off = rolling_and_off(law)
    y_dot, _ = eq.derivative_each(eq.MULTIBODY, scenes, rolling + off)
    # two solutions
    within(relative(y_dot, stabilised_rate(scenes, rolling + off)), 2048 * EPSILON, "rates, relative")
    smaller = stabilised_rate(scenes, rolling + 0.999 * off)  # errors 0.1 % smaller
    beyond(relative(y_dot, smaller), 8e-4, "rates of smaller errors, relative")
    assert (y_dot[:, SPIN] == 0).all() == (law == eq.HELD)


def test_24_itself_sees_neither_slip_nor_height(law: int) -> None:
    scenes, rolling, off = rolling_and_off(law)
    answers = [eq.dynamics_each(eq.MULTIBODY, scenes, y) for y in (rolling, rolling + off)]
    assert (answers[0] == answers[1]).all()
    rates = [eq.derivative_each(eq.MULTIBODY, scenes, y)[0][:, 6:] for y in (rolling, rolling + off)]
    beyond(relative(*rates), 0.6, "stabilised rates apart, relative")
