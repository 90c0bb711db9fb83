"""A wheel that spins fast keeps its tolerance: the error in one second, at the lean of theta = 1.4 rad. One that whirls
fast costs no more than a slower one, turn by turn."""

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu.driver import Values
from wheelfmu.truth.errors import range_error
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.schedule import Schedule

STATES = ("X_O", "Y_O", "theta", "psi", "phi", "psi_dot", "theta_dot", "phi_dot")
SCENES: dict[str, tuple[Values, Schedule]] = {"free": ({}, Schedule()), "friction": ({"s": 0.03}, Schedule())}
SCENES |= {"loaded": ({}, Schedule(((0.0, {"F_Z": -30.0, "M_1": 1.0}),)))}
BOUND = 100  # tolerances of the range
KINDS = [(1, 1), (2, 2), (2, 3), (2, 4), (3, 1), (3, 2), (3, 3), (3, 4)]


@pytest.mark.parametrize("spin", [100.0, 1000.0])
@pytest.mark.parametrize("scene", SCENES)
def test_the_error_of_a_second_stays_below_a_hundred_tolerances_of_the_range(library: Library, scene: str, spin: float):
    start, inputs = SCENES[scene]

    def motion(kind: tuple[int, int], tolerance: float, lean: float = 1.4) -> Run:
        how = {"formulation": kind[0], "method": kind[1], "theta_start": lean, "phi_dot_start": -spin}
        return library.simulate(np.linspace(0, 1, 101), tolerance, inputs, **start, **how)

    def error(tolerance: float, found: Run) -> float:
        return range_error(found, true, STATES) / tolerance

    true = motion((2, 4), 1e-13)
    within(error(1e-8, motion((3, 4), 1e-13)), BOUND / 5, "rounding, tolerances of the range")  # grows with the spin
    for tolerance in (1e-8, 1e-5):
        for kind in KINDS:
            within(error(tolerance, motion(kind, tolerance)), BOUND, "error, tolerances of the range")
    beyond(error(1e-8, motion((2, 4), 1e-8, lean=1.4 + 1e-5)), 3000, "error at another lean, tolerances of the range")


@pytest.mark.parametrize("method", [2, 4])
def test_rates_a_hundred_times_as_large_cost_the_same_steps_in_a_hundredth_of_the_time(library: Library, method: int):
    """The weight hardly counts: the motion is the same in another unit of time. It whirls without spin at the start."""

    def steps(rate: float, duration: float) -> int:
        how = {"formulation": 2, "method": method, "keep_contact": True, "theta_start": 1.2}
        start = {"psi_dot_start": rate, "phi_dot_start": -rate * np.cos(1.2)}
        return library.simulate([0.0, duration], 1e-8, **how, **start).counters["n_steps"]

    slow, fast, long = steps(1e2, 0.1), steps(1e4, 1e-3), steps(1e4, 0.1)
    within(abs(fast / slow - 1), 0.4, "change of the number of steps")
    beyond(long / slow, 30, "steps of the fast wheel in the time of the slow one, over its own")
