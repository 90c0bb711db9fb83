"""A lift-off inside one step by a varying input, of which neither of its ends shows anything.

The wheel rolls upright, F_Z only carries it, N = m g - F_Z; the lift-off is at the first root of a polynomial.
test_stability_sweep.py has the lift-off without an input, where N grazes zero.
"""

from math import pi

import numpy as np
import pytest
from scipy.optimize import brentq
from support.bounds import EPSILON, within
from support.playing import play

from wheelfmu.fmu.driver import DISCARD, LAST_SUCCESSFUL_TIME, OK
from wheelfmu.truth.scenes import FORCED, PAPER

WEIGHT = PAPER.m * PAPER.g  # N
BEGIN, STEP = 0.3, 0.02  # s
INSTANT = 1e-8  # s


def parabola(ends, peak):
    """In weights, over the step: `ends` at both its ends, `peak` in the middle."""
    rise = 4 * (peak - ends) / STEP
    return [ends, rise, -rise / STEP]


def cubic(size, offset=0.0):
    """size x (x - 1/2) (x - 1): zero at the ends of the step and in the middle, 0.048 of `size` between them."""
    return [offset, 0.5 * size / STEP, -1.5 * size / STEP**2, size / STEP**3]


SHAPES = {f"{peak:g} weights": parabola(0, peak) for peak in (1.0001, 1.1, 3, 300)}
SHAPES |= {"pressed at both ends": parabola(-20, 1.001), "pressed hard at both ends": parabola(-1000, 1.1)}
SHAPES |= {"cubic": cubic(21.0), "steep cubic": cubic(400.0), "cubic, falling first": cubic(-40.0)}
SHAPES |= {"pressed cubic": cubic(1000.0, -40.0)}


def first_root(shape):
    """The first instant in the step at which the force is the weight; None: never."""
    roots = np.roots([*shape[::-1][:-1], shape[0] - 1])
    inside = [x.real for x in roots if abs(x.imag) < 1e-12 and 0 < x.real < STEP]
    return min(inside, default=None)


def lift_off(wheel, kind, inputs, **values):
    """One step with these inputs, N or N m; the instant in it at which the wheel lifted off, None: it did not."""
    w = wheel().start(**{"theta_start": pi / 2, "phi_dot_start": -8.0, **kind, **values}).to(BEGIN)
    status = w.give(inputs).step_to(BEGIN + STEP)
    if status == OK:
        return None
    assert status == DISCARD and "lifted off" in w.sentences[-1]
    return w.status(LAST_SUCCESSFUL_TIME) - BEGIN


@pytest.mark.parametrize("s", [0.0, 0.03])
@pytest.mark.parametrize("name", SHAPES)
def test_a_peak_of_the_load_inside_one_step_lifts_the_wheel_at_its_instant(wheel, kind, name, s):
    shape = SHAPES[name]
    found = lift_off(wheel, kind, {"F_Z": [WEIGHT * c for c in shape]}, s=s)
    assert found is not None
    within(abs(found - first_root(shape)), INSTANT, "instant of the lift-off, s")


@pytest.mark.parametrize("s", [0.0, 0.03])
def test_a_peak_that_stays_below_the_weight_does_not(wheel, kind, s):
    """The partner: a ten-thousandth of the weight less."""
    for shape in (parabola(0, 0.9999), parabola(-20, 0.9999), cubic(0.9999 / 0.0481126)):
        assert first_root(shape) is None
        assert lift_off(wheel, kind, {"F_Z": [WEIGHT * c for c in shape]}, s=s) is None


def test_a_wheel_of_next_to_no_mass_lifts_off_at_the_same_instant(wheel, kind):
    """A billionth of all masses and of the load: the unit of force has no meaning."""
    light = {name: 1e-9 * getattr(PAPER, name) for name in ("m", "J_x", "J_y", "J_z")}
    found = lift_off(wheel, kind, {"F_Z": [1e-9 * WEIGHT * c for c in SHAPES["cubic"]]}, **light)
    within(abs(found - first_root(SHAPES["cubic"])), 5e-10, "instant of the lift-off, s")


@pytest.mark.parametrize("s", [0.0, 0.03])
@pytest.mark.parametrize("ramp", [100.0, 1e4])
def test_two_inputs_that_nearly_cancel_hide_nothing(wheel, ramp, s):
    """At theta = 1.2 rad a moment M_1 presses as well. Every kind of run sees the lift-off that 400 short steps see."""
    start = {"theta_start": 1.2, "phi_dot_start": -8.0, "s": s}
    ((by_force, by_moment),) = wheel().start(**start).to(BEGIN).jacobian(["lambda_3"], ["F_Z", "M_1"])
    force = [WEIGHT * c for c in cubic(60.0)]
    slope = ramp * WEIGHT / STEP
    inputs = {"F_Z": [force[0], force[1] + slope, *force[2:]], "M_1": [0.0, -slope * by_force / by_moment]}
    w = wheel().start(formulation=2, method=4, **start).to(BEGIN)
    assert play(w, [(BEGIN, inputs)], BEGIN + STEP, BEGIN + STEP * np.arange(400) / 400) == DISCARD
    true = w.status(LAST_SUCCESSFUL_TIME) - BEGIN
    assert 0 < true < STEP / 2
    for kind in FORCED:
        within(abs(lift_off(wheel, kind, inputs, **start) - true), 2e-9, "instant of the lift-off, s")
    assert lift_off(wheel, FORCED[0], {"F_Z": [0.1 * c for c in force]}, **start) is None


def test_a_brake_that_gives_way_inside_one_step_lets_the_wheel_turn_at_its_instant(wheel, kind):
    """A parabola of M_brake that sinks below the torque and comes back: the wheel is held at both ends of the step."""
    w, held = (wheel(logging=True).start(theta_start=pi / 2, phi_dot_start=0.0, **kind) for _ in range(2))
    inputs = {"M_3": [2.0], "M_brake": [5.0, -4 * 4 / STEP, 4 * 4 / STEP**2]}
    w.give(inputs).to(STEP)
    logged = [m for m in w.sentences if "release" in m]
    x = 0.5 * (1 - np.sqrt(0.25))  # 5 - 16 x (1 - x) = 2
    assert len(logged) == 1
    within(abs(float(logged[0].split()[2]) - x * STEP), 64 * EPSILON, "instant of the release, s")
    assert w.get("phi")[0] != 0
    inputs["M_brake"][0] = 6.1  # the partner: it sinks to 2.1
    assert held.give(inputs).to(STEP).get("phi") == [0.0]


def dip_of_acceleration(ends, depth):
    """The rate whose slope over the step is `ends` at both its ends and `depth` in the middle, rad/s2; zero there."""
    rate = np.polynomial.Polynomial(parabola(ends, depth)).integ()
    return [*(rate - rate(STEP / 2)).coef]


def first_lift_off(rate, theta):
    """The first instant in the step at which N = m (g + Z_O_ddot) is zero, Z_O = r + r_0 sin(theta); None: never."""
    theta_dot = np.polynomial.Polynomial(rate)
    angle, theta_ddot = theta + theta_dot.integ(), theta_dot.deriv()

    def N(t):
        return PAPER.g + PAPER.r_0 * (np.cos(angle(t)) * theta_ddot(t) - np.sin(angle(t)) * theta_dot(t) ** 2)

    t = np.linspace(0, STEP, 200_001)
    below = np.flatnonzero(N(t) < 0)
    return brentq(N, t[below[0] - 1], t[below[0]], xtol=1e-15) if below.size else None


@pytest.mark.parametrize("s", [0.0, 0.03])
@pytest.mark.parametrize("ends", [0.0, 300.0, 3e3, 1e4])
def test_a_dip_of_the_carriers_acceleration_inside_one_step_lifts_the_wheel_at_its_instant(wheel, ends, s):
    theta = 1.2
    limit = PAPER.g / PAPER.r_0 / np.cos(theta)
    for share, lifts in ((1.1, True), (1.02, True), (0.7, False)):
        rate = dip_of_acceleration(ends, -share * limit)
        w = wheel().start(guided=True, psi_start=0.0, theta_start=theta, phi_dot_start=-8.0, s=s).to(BEGIN)
        status = w.give({"theta_dot_guide": rate}).step_to(BEGIN + STEP)
        true = first_lift_off(rate, theta)
        assert (status == DISCARD, true is not None) == (lifts, lifts), (
            f"{ends} rad/s2 at the ends, {share} of the limit"
        )
        if lifts:
            found = w.status(LAST_SUCCESSFUL_TIME) - BEGIN
            within(abs(found - true), INSTANT, "instant of the lift-off, s")
