"""Every method reaches the end of every scene at every tolerance, and what is tight is as exact as rounding allows.

Where a slip begins, or ends while its direction turns, where omega_z is zero at a start of CVODE, and near flat, where
psi_dot = omega_2 / sin(theta) magnifies rounding. SI.
"""

from math import pi

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.driver import OK
from wheelfmu.truth.cases import random_scene
from wheelfmu.truth.errors import range_errors
from wheelfmu.truth.motion import Library
from wheelfmu.truth.motion import run as attempt
from wheelfmu.truth.scenes import SCENES
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import SLIDES, random_slide

TOLERANCES = [10.0**-k for k in range(4, 14)]
ADAMS, BDF, RUNGE_KUTTA = 2, 3, 4
each_method = pytest.mark.parametrize("method", [ADAMS, BDF, RUNGE_KUTTA], ids=["adams", "bdf", "runge_kutta"])


def stopped(library: Library, times, tolerance: float, inputs: Schedule | None = None, **values) -> list[str]:
    """The message of a solver that gave up."""
    done = attempt(library, values, times, tolerance, inputs)
    return [] if done.status <= OK + 1 or done.end is not None else done.messages[-1:]


# ---- every method ----


@each_method
@pytest.mark.parametrize("name", [*SCENES, *(f"slide: {name}" for name in SLIDES)])
def test_every_scene_runs_to_its_end_by_every_method_at_every_tolerance(library, name: str, method: int) -> None:
    scene = SLIDES[name[7:]] if name.startswith("slide: ") else SCENES[name]
    times = np.linspace(0, scene.duration, 101)
    for tolerance in TOLERANCES:
        assert stopped(library, times, tolerance, scene.inputs, **{**scene.start, "method": method}) == []


@each_method
def test_random_wheels_with_friction_run_to_their_end_at_the_tightest_tolerances(library, method: int) -> None:
    random = np.random.default_rng(57)
    for _ in range(25):
        values = {**random_scene(random).start, "s": 10 ** random.uniform(-4, -1)}
        values |= {"formulation": int(random.choice([2, 3])), "method": method}
        assert stopped(library, [0.0, 2.0, 4.0], float(10 ** -random.uniform(11, 13)), **values) == []


# ---- the begin of a slip ----

GUIDED = {"guided": True, "theta_start": pi / 2}
DRIVEN = Schedule(((0.0, {}), (0.1, {"F_X": -26.0}), (0.2, {"F_X": -26.0, "M_3": 40.0})))
BEGINS = {  # on a wheel carrier: the motion amplifies no error
    "driven": ({"mu_max": 0.17, "mu_slide": 0.17, "s": 0.004, "phi_dot_start": -6.0}, DRIVEN),
    "thrown": (
        {"mu_max": 0.458, "mu_slide": 0.458, "s": 0.0081, "phi_dot_start": 1.364}
        | {"slip_x_start": -0.0318, "slip_y_start": 3.792},
        Schedule(),
    ),
}


@pytest.mark.parametrize("name", BEGINS)
def test_the_error_of_a_slide_falls_with_the_tolerance(library: Library, name: str, formulation: int) -> None:
    start, inputs = BEGINS[name]
    runs = [
        library.simulate(np.linspace(0, 1, 21), tolerance, inputs, **GUIDED, **start, formulation=formulation)
        for tolerance in (*TOLERANCES, 5e-10, 1e-13)
    ]
    assert (runs[0]["contact_mode"] == 1).any()
    for run, tolerance in zip(runs[:-1], (*TOLERANCES, 5e-10), strict=True):
        errors = range_errors(run.columns, runs[-1].columns, ("X_O", "phi"))
        within({name: error / tolerance for name, error in errors.items()}, 0.3, "error / range over the tolerance")


@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_a_locked_wheel_that_slides_exactly_upright_stays_so(library, tolerance: float, formulation: int) -> None:
    """Up to the rounding that the upright wheel's instability amplifies."""
    upright = {"theta_start": pi / 2, "phi_dot_start": -20.0, "mu_max": 0.5, "mu_slide": 0.4}
    lock = Schedule(((0.0, {"M_brake": 100.0}),))
    run = library.simulate([0, 0.05, 1.0], tolerance, lock, **upright, formulation=formulation)
    _, soon, later = np.abs(run["theta"] - pi / 2)
    within(soon, 32 * EPSILON, "lean soon, rad")
    within(later, 1e-10, "lean at 1 s, rad")
    assert (run["contact_mode"] == 1).any()


# ---- the end of a slip ----


@pytest.mark.parametrize("tolerance", TOLERANCES[4:])
def test_a_slip_that_falls_while_it_turns_ends(library: Library, tolerance: float) -> None:
    wheel = {"m": 12.9, "r_0": 0.228, "r": 0.134, "J_x": 0.408, "J_y": 0.557, "J_z": 0.375, "s": 0.0111}
    start = {"psi_start": 0.0, "theta_start": 2.24, "phi_start": 0.414, "psi_dot_start": -1.13}
    start |= {"theta_dot_start": 0.975, "phi_dot_start": -1.86, "mu_max": 0.211, "mu_slide": 0.159}
    run = library.simulate(np.arange(0, 3.01, 0.1), tolerance, **wheel, **start)
    ends = [message for message in run.messages if message.startswith("t = 2.4495") and "stops sliding" in message]
    assert len(ends) == 1


@pytest.mark.parametrize("tolerance", [1e-12, 1e-13])
def test_the_slips_of_a_light_body_that_fall_at_many_g_end(library: Library, tolerance: float) -> None:
    """A slip ends sooner where the rounding of the instant counts for more."""
    body = {"J_x": 1.17e-3, "J_y": 1.16e-3, "J_z": 7.4e-4, "s": 0.02, "mu_max": 0.111, "mu_slide": 0.1}
    start = {"theta_start": 1.11, "phi_start": 2.03, "theta_dot_start": -0.074, "phi_dot_start": 1.93}

    def lean(tolerance: float, psi_dot: float = -0.565) -> float:
        run = library.simulate([0.0, 0.6], tolerance, **body, **start, psi_dot_start=psi_dot)
        beyond(sum("direction" in message for message in run.messages), 10, "slips")
        return float(run["theta"][-1])

    within(abs(lean(tolerance) - lean(1e-10)), 1e-10, "lean, rad")
    beyond(abs(lean(tolerance, -0.566) - lean(1e-10)), 1e-8, "lean after another start, rad")


def test_slips_of_random_wheels_end_at_the_tightest_tolerances(library: Library, formulation: int) -> None:
    """3 s under loads that go on."""
    random, slides = np.random.default_rng(4), 0
    for _ in range(60):
        scene = random_slide(random)
        done = attempt(
            library, {**scene.start, "formulation": formulation, "method": int(random.choice([1, ADAMS, BDF]))},
            np.linspace(0, 3, 11), float(10 ** -random.uniform(11, 13)), scene.inputs,
        )  # fmt: skip
        assert done.status <= OK + 1 or done.end is not None, done.messages[-1:]
        slides += sum("starts to slide" in message for message in done.messages)
    beyond(slides, 60, "number of slides")


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
    for start, tolerances in ((TO_ZERO, (1e-8, 1e-12)), (from_the_other_side(TO_ZERO), (1e-10, 1e-12))):
        for formulation in (2, 3):
            for tolerance in tolerances:
                instant, steps = falls(library, tolerance, **start, formulation=formulation)
                within(abs(instant - exact), 5e-9, "instant at which it lies flat, s")
                within(steps, 4e4, "number of steps")  # lost in the rounding, they would go on to the work limit


def braked_wheel(random: np.random.Generator) -> tuple[dict[str, float], Schedule]:
    """Under a soft regularized law, thrown; a brake from 0.45 s on, under which most lie flat within 4 s."""
    a, b, c = random.uniform(0.2, 0.5, 3)
    mu = random.uniform(0.15, 0.4)
    start = {"r": random.uniform(0.1, 0.2), "J_x": b + c, "J_y": a + c, "J_z": a + b, "mu_max": mu}
    start |= {"mu_slide": mu * random.uniform(0.7, 1), "friction_law": 2, "omega_s": random.uniform(0.1, 0.3)}
    start |= {"theta_start": pi / 2 + random.choice([-1, 1]) * random.uniform(0.2, 0.6)}
    rates = ("psi_dot_start", "theta_dot_start", "phi_dot_start", "slip_x_start", "slip_y_start")
    start |= dict(zip(rates, random.normal(0, 1, 5), strict=True))
    return start, Schedule(((0.0, {}), (0.45, {"M_brake": float(random.uniform(10, 25))})))


def test_the_multibody_form_slides_and_lies_flat_as_the_reduced_one_in_hardly_more_steps(library: Library) -> None:
    """psi_dot grows as 1 / theta, and 1e-7 rad from flat accelerations of 1e8 g cancel in it."""
    random, ends = np.random.default_rng(61), []
    for k in range(6):
        start, brake = braked_wheel(random)
        tolerance, times = (1e-8, 1e-9)[k % 2], np.arange(0, 4, 0.05)
        runs = [library.simulate(times, tolerance, brake, **start, formulation=form) for form in (2, 3)]
        within(runs[1].counters["n_steps"] / runs[0].counters["n_steps"], 4, "steps over those of the reduced form")
        assert (runs[0].end is None) == (runs[1].end is None)
        if runs[0].end is not None and runs[1].end is not None:
            ends.append(abs(runs[1].end - runs[0].end))
    beyond(len(ends), 2, "wheels that lie flat")
    within(max(ends), 3e-6, "largest distance of the instants at which they lie flat, s")
    within(float(np.median(ends)), 3e-8, "middle distance of those instants, s")


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
