"""Tight tolerances where rounding counts: where a slip ends, at once and late, and near flat, where psi_dot =
omega_2 / sin(theta) magnifies it. SI. Of the usual scenes: test_scenes.py.
"""

from math import pi

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu.driver import OK
from wheelfmu.truth.motion import Library
from wheelfmu.truth.motion import run as attempt
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import random_slide

ADAMS, BDF = 2, 3


# ---- a slip ----


def test_slips_of_random_wheels_end_at_the_tightest_tolerances(library: Library, formulation: int) -> None:
    """3 s under loads that go on."""
    random, slides = np.random.default_rng(4), 0
    for _ in range(25):
        scene = random_slide(random)
        done = attempt(
            library, {**scene.start, "formulation": formulation, "method": int(random.choice([1, ADAMS, BDF]))},
            np.linspace(0, 3, 11), float(10 ** -random.uniform(11, 13)), scene.inputs,
        )  # fmt: skip
        assert done.status <= OK + 1 or done.end is not None, done.messages[-1:]
        slides += sum("starts to slide" in message for message in done.messages)
    beyond(slides, 25, "number of slides")


@pytest.mark.parametrize("late", [20.0, 128.0, 300.0])
def test_slips_end_however_late_they_begin(library: Library, late: float) -> None:
    """The rounding of time grows with it: a wheel that rolls upright on a good road is pushed about on a bad one."""
    random, slides = np.random.default_rng(128), 0
    for _ in range(12):
        mu, torque = random.uniform(0.1, 0.6), lambda: float(random.normal(0, 30))
        start = {"theta_start": pi / 2 - 1e-3, "phi_dot_start": -random.uniform(5, 9), "keep_contact": True}
        with library.wheel(logging=True) as wheel:
            wheel.start(tolerance=float(10 ** -random.uniform(9, 13)), mu_max=20.0, mu_slide=0.9 * mu, **start).to(late)
            wheel.put(mu_max=mu, s=float(random.choice([0.0, 0.02])))
            for k in range(20):
                if k % 3 == 0:
                    push = dict(zip(("F_X", "F_Y"), random.normal(0, 100, 2).tolist(), strict=True))
                    wheel.put(**push, M_3=torque(), M_brake=abs(torque()))
                if wheel.step_to(late + 0.1 * (k + 1)) != OK:
                    assert "lies flat" in wheel.sentences[-1], wheel.sentences[-1]
                    break
            slides += sum("starts to slide" in sentence for sentence in wheel.sentences)
    beyond(slides, 10, "number of slides")


# ---- near flat ----


FALLING = {"m": 9.67, "r_0": 0.539, "r": 0.213, "J_x": 0.751, "J_y": 0.555, "J_z": 0.818, "s": 0.00967}
FALLING |= {"mu_max": 0.2527, "mu_slide": 0.2396, "friction_law": 2, "omega_s": 0.01587}
TO_ZERO = {"psi_start": 1.84, "theta_start": 1.083, "phi_start": -2.817, "psi_dot_start": -1.158}
TO_ZERO |= {"theta_dot_start": 0.4337, "phi_dot_start": -2.528, "slip_x_start": -0.0955, "slip_y_start": -0.1726}
REVERSED = dict.fromkeys(("phi_start", "theta_dot_start", "phi_dot_start", "slip_x_start", "slip_y_start"), -1.0)
BRAKED = Schedule(((0.0, {}), (0.8, {"M_brake": 16.75})))


def from_the_other_side(start: dict[str, float]) -> dict[str, float]:
    """The same wheel, its axle named the other way round."""
    turned = {name: REVERSED.get(name, 1.0) * value for name, value in start.items()}
    return turned | {"theta_start": pi - start["theta_start"], "psi_start": start["psi_start"] + pi}


def falls(library: Library, tolerance: float, **values) -> tuple[float, int]:
    """The instant at which it lies flat, and the steps."""
    run = library.simulate(np.arange(0, 3.1, 0.05), tolerance, BRAKED, **FALLING, **values)
    assert run.end is not None and "flat" in str(run.ended)
    return run.end, run.counters["n_steps"]


def test_however_tight_the_tolerance_a_wheel_that_slides_74_times_lies_flat_at_the_same_instant(library) -> None:
    """Near theta = pi the rounding of theta is 4e-9 of the angle that is left, and tight steps are lost in it."""
    exact, _ = falls(library, 1e-13, **TO_ZERO)
    assert abs(falls(library, 1e-10, **{**TO_ZERO, "theta_dot_start": 0.4338})[0] - exact) > 1e-6
    for start, formulation, tolerance in ((TO_ZERO, 3, 1e-8), (from_the_other_side(TO_ZERO), 2, 1e-12)):
        instant, steps = falls(library, tolerance, **start, formulation=formulation)
        within(abs(instant - exact), 5e-9, "instant at which it lies flat, s")
        within(steps, 4e4, "number of steps")  # lost in the rounding, they would go on to the work limit


@pytest.mark.parametrize("tolerance", [1e-10, 1e-12, 1e-13])
@pytest.mark.parametrize(("theta", "psi_dot"), [(0.05, 0.1), (0.5, 1e-4)])
def test_the_multibody_form_rolls_past_flat_in_some_thousand_steps(library: Library, theta, psi_dot, tolerance) -> None:
    """Tight steps are lost in the rounding of accelerations in which psi_dot^2 cancels."""
    start = {"theta_start": theta, "psi_dot_start": psi_dot, "phi_dot_start": 0.0, "keep_contact": True}
    exact = library.simulate([0.0, 1.0], 1e-13, **start, formulation=2)

    def error(**other: float) -> float:
        run = library.simulate([0.0, 1.0], tolerance, **{**start, **other}, formulation=3)
        within(run.counters["n_steps"], 5e3, "steps")
        return max(abs(float(run[name][-1] - exact[name][-1])) for name in ("X_O", "theta", "psi", "phi_dot"))

    within(error(), 5e-8, "difference of the forms")
    beyond(error(theta_start=theta + 1e-6), 5e-8, "difference with another tilt")
