"""A lift-off that lasts for less than a step of the solver and that no input tells: N grazes zero as the wheel rocks.

A constant F_Z carries so much of the weight that the least N of the first swing lies just below zero, or just above.
"""

import numpy as np
import pytest
from support.bounds import beyond, within
from support.driver import DISCARD, LAST_SUCCESSFUL_TIME, OK
from support.scenes import FORCED

SCENE = {"theta_start": 1.2, "psi_dot_start": 1.0, "phi_dot_start": -8.0}
STOP = 0.4  # s, with one dip; half a dozen steps of Runge-Kutta


def least_normal_force(wheel, force, s):
    """Of a wheel that is kept on the ground: the instant at which N is least, N there and its bend, N/s^2.

    By a parabola through three points of a fine grid.
    """
    w = wheel().start(tolerance=1e-10, keep_contact=True, F_Z=force, s=s, **SCENE)
    times, found = np.linspace(0, STOP, 401), []
    for t in times[1:]:
        w.to(t)
        found += w.get("lambda_3")
    w.close()
    k = int(np.argmin(found))
    left, mid, right = found[k - 1 : k + 2]
    bend = left - 2 * mid + right
    x = 0.5 * (left - right) / bend
    return times[k + 1] + x * times[1], mid - 0.25 * (left - right) * x, bend / times[1] ** 2


def grazing_force(wheel, least, s):
    """F_Z, N, for which the least N is `least`, by the secant method; its instant and the bend of N there."""
    a, b = 100.0, 120.0
    n_a = least_normal_force(wheel, a, s)[1] - least
    for _ in range(12):
        instant, n_b, bend = least_normal_force(wheel, b, s)
        n_b -= least
        if abs(n_b) < 1e-7:
            return b, instant, bend
        a, b, n_a = b, b - n_b * (b - a) / (n_b - n_a), n_b
    raise AssertionError("no force found")


@pytest.mark.parametrize("s", [0.0, 0.03])
@pytest.mark.parametrize("depth", [1e-1, 1e-3])
def test_a_dip_of_the_normal_force_inside_one_step_ends_the_run(wheel, depth, s):
    force, instant, bend = grazing_force(wheel, -depth, s)
    above, _, _ = grazing_force(wheel, depth, s)
    half = np.sqrt(2 * depth / bend)  # s, from the begin of the dip to its middle: 19 ms and 1.9 ms
    for forced in FORCED:
        kind = {**forced, "tolerance": 1e-8, "s": s}
        w = wheel().start(F_Z=force, **kind, **SCENE)
        assert w.step_to(STOP) == DISCARD and "lifted off" in w.sentences[-1], kind
        found = w.status(LAST_SUCCESSFUL_TIME)
        within(abs(found - (instant - half)) / half, 0.04, "difference")
        beyond(abs(found - instant) / half, 0.9, "difference")  # the partner
        w = wheel().start(F_Z=above, **kind, **SCENE)  # another: N stays as far above zero
        assert w.step_to(STOP) == OK, kind
