"""Where a road with the coefficient of friction mu_max runs out of grip: closed forms, and the same instant in every
way of running. The reference's instants: test_sliding.py; a brief loss inside a step: tests/solver/test_search.py.

mu_required = lambda_t / N. Upright and straight, with R = r_0 + r: a braked wheel has lambda_t = m R M_brake / (J_z +
m R^2) and N = m g; a wheel that is held on a slope alpha has tan(alpha); on a steady circle O accelerates by
psi_dot v_O, so mu_required = |psi_dot| v_O / g.
"""

from math import pi, tan

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.driver import ERROR, OK
from wheelfmu.truth.closed_forms import circle, rolling_inertia
from wheelfmu.truth.exchange import Run as ExchangeRun
from wheelfmu.truth.exchange import exchange, loaded, no_inputs
from wheelfmu.truth.motion import Library, start_values
from wheelfmu.truth.reference import Wheel
from wheelfmu.truth.schedule import Schedule

PAPER = Wheel()
UPRIGHT = {"theta_start": pi / 2, "psi_start": 0.0, "phi_dot_start": -60.0}
RAMP = 40.0  # N m/s, of the brake where mu_max is 1
R = PAPER.r_0 + PAPER.r
INSTANT = PAPER.g * rolling_inertia(PAPER) / R / RAMP  # M_brake R m / (J_z + m R^2) = mu m g
MESSAGE = "The wheel needs a friction coefficient above mu_max = {} at t = {} s"


@pytest.mark.parametrize("step", [0.01, 1.3, 6.0])
@pytest.mark.parametrize(("mu", "formulation"), [(1e-9, 1), (1e-9, 2), (1e-7, 3), (0.5, 1), (0.5, 2), (0.5, 3)])
def test_a_braked_wheel_runs_out_of_grip_at_the_closed_forms_instant(library, step, mu, formulation) -> None:
    """On a ramp in proportion to mu_max, however small: the instant is the same."""
    ramp = Schedule(((0.0, {"M_brake": (0.0, RAMP * mu)}),))

    def end(limit: float) -> float:
        times = np.arange(0, 6 + step / 2, step)
        run = library.simulate(times, 1e-10, ramp, mu_max=limit, formulation=formulation, **UPRIGHT)
        assert run.ended is not None and run.ended.startswith(MESSAGE.format(limit, "")[:-3])
        return float(run.end or np.nan)

    within(abs(end(mu) / INSTANT - 1), 2e-6 if mu < 1e-3 else 3e-11, "instant, relative")
    beyond(abs(end(1.00001 * mu) / INSTANT - 1), 2e-6, "instant with another mu_max, relative")


@pytest.mark.parametrize(("theta", "psi_dot"), [(1.2, 1.5), (1.0, -2.0), (2.1, 3.0)])
def test_a_steady_circle_needs_its_centripetal_acceleration_over_g(library: Library, theta: float, psi_dot: float):
    start = start_values(PAPER, circle(PAPER, theta, psi_dot))
    at = library.simulate([0.0], **start)
    speed = float(np.hypot(at["X_O_dot"], at["Y_O_dot"])[0])
    needed = abs(psi_dot) * speed / PAPER.g
    within(abs(at["mu_required"][0] - needed), 16 * EPSILON, "coefficient of friction")
    times = np.linspace(0, 1e4, 11)
    safe = library.simulate(times, mu_max=needed * (1 + 1e-6), **start)
    assert safe.end is None and safe.counters["n_rhs"] < 100  # unfolded: nothing is stepped through
    assert library.simulate(times, mu_max=needed * (1 - 1e-6), **start).end == 0.0


FAST = {"theta_start": 1.2, "psi_dot_start": 0.3, "phi_dot_start": -6.0}  # free, symmetric: it can be unfolded


def test_every_way_of_running_ends_at_the_same_instant(library: Library) -> None:
    """Unfolded, stepped, under a friction that is nearly none, multibody, and by another solver."""
    free = library.simulate(np.linspace(0, 3, 301), 1e-10, **FAST)
    mu = 0.5 * float(free["mu_required"].max() + free["mu_required"][0])
    ways = ({}, {"method": 2}, {"method": 4}, {"formulation": 3})
    ends = [library.simulate([0.0, 3.0], 1e-12, mu_max=mu, **FAST, **how).end for how in ways]
    with exchange(library, logging=True, mu_max=mu, **FAST) as wheel:
        run = ExchangeRun(wheel, 1e-11, no_inputs)
        run.to(3.0)
        assert MESSAGE.split("{")[0] in wheel.sentences[-1]
        ends.append(run.ended)
    within(float(np.ptp(np.array(ends, dtype=float))), 3e-10, "spread of the instants, s")
    with exchange(library, mu_max=1.01 * mu, **FAST) as wheel:  # the partner
        later = ExchangeRun(wheel, 1e-11, no_inputs)
        later.to(3.0)
        beyond(abs((later.ended or 3.0) - ends[0]), 1e-4, "instant with another mu_max, s")


@pytest.mark.parametrize("alpha", [0.01, 0.2, 0.7, 1.2])
def test_a_wheel_held_on_a_slope_starts_where_mu_max_is_the_slopes_tangent_and_not_below(library, alpha: float):
    """To a billionth, by both kinds of run alike; in model exchange the first event mode, for which an event that lies
    ahead by less than 1e-7 of the wheel's own time has occurred, does not end it either."""
    held = {"slope": alpha, "theta_start": pi / 2, "psi_start": 0.0, "phi_dot_start": 0.0, "s": 2.0}
    for off, taken in ((1e-9, True), (-1e-9, False)):
        mu_max = tan(alpha) * (1 + off)
        assert library.simulate([0.0, 1.0], mu_max=mu_max, **held).end == (None if taken else 0.0)
        with loaded(library).new() as wheel:
            assert wheel.set(mu_max=mu_max, **held) == OK
            assert wheel.initialise() == (OK if taken else ERROR)
            assert not taken or not wheel.decide().terminateSimulation


def test_a_ground_that_pulls_gives_no_grip_however_little_of_it_is_needed(library: Library) -> None:
    """Upright and straight nothing acts along the road: N = m g - F_Z alone decides, and the run ends where it
    vanishes, or at once where it is below zero already."""
    weight, vanishes = PAPER.m * PAPER.g, 0.5
    ramp, jump = (Schedule(((0.0, {"F_Z": shape}),)) for shape in ((0.0, weight / vanishes), (2 * weight,)))
    rolling = {"theta_start": pi / 2, "phi_dot_start": -3.0, "keep_contact": True}
    for inputs, end in ((ramp, vanishes), (jump, 0.0)):
        run = library.simulate([0.0, 0.3, 1.0], 1e-10, inputs, mu_max=0.5, **rolling)
        assert run.end is not None and "mu_max = 0.5" in str(run.ended)
        within(abs(run.end - end), 64 * EPSILON, "instant at which N vanishes, s")
        free = library.simulate([0.0, 0.3, 1.0], 1e-10, inputs, **rolling)  # the partner: grip is not checked
        assert free.end is None and any("the road pulls" in message for message in free.messages)
    with loaded(library).new() as wheel:
        assert wheel.set(mu_max=0.5, F_Z=2 * weight, **rolling) == OK
        assert wheel.initialise() == ERROR and "mu_max = 0.5" in wheel.said()
