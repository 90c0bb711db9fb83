"""Where a road with the coefficient of friction mu_max runs out of grip: closed forms, the independent reference, and
the same instant in every way of running.

mu_required = lambda_t / N. Upright and straight, with R = r_0 + r: a braked wheel has lambda_t = m R M_brake / (J_z +
m R^2) and N = m g; a wheel that is held on a slope alpha has tan(alpha); on a steady circle O accelerates by
psi_dot v_O, so mu_required = |psi_dot| v_O / g.
"""

from dataclasses import replace
from math import pi, tan

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.driver import ERROR, OK
from wheelfmu.truth.cases import random_scene
from wheelfmu.truth.closed_forms import circle, rolling_inertia
from wheelfmu.truth.exchange import INDICATORS, exchange, loaded, no_inputs
from wheelfmu.truth.exchange import Run as ExchangeRun
from wheelfmu.truth.motion import Library, start_values
from wheelfmu.truth.reference import Solution, Wheel, solve
from wheelfmu.truth.schedule import Schedule

PAPER = Wheel()
UPRIGHT = {"theta_start": pi / 2, "psi_start": 0.0, "phi_dot_start": -20.0}
RAMP = 40.0  # N m/s, of the brake
SOON = Schedule(((0.0, {"M_brake": (0.0, RAMP)}),))
MESSAGE = "The wheel needs a friction coefficient above mu_max = {} at t = {} s"


def braked_instant(mu: float) -> float:
    """M_brake R m / (J_z + m R^2) = mu m g on the ramp."""
    R = PAPER.r_0 + PAPER.r
    return mu * PAPER.g * rolling_inertia(PAPER) / R / RAMP


@pytest.mark.parametrize("formulation", [1, 2, 3])
@pytest.mark.parametrize("step", [0.01, 0.5, 3.0])
def test_a_braked_wheel_runs_out_of_grip_at_the_closed_forms_instant(library: Library, formulation: int, step: float):
    def end(mu: float) -> float:
        times = np.arange(0, 3 + step / 2, step)
        run = library.simulate(times, 1e-10, SOON, mu_max=mu, formulation=formulation, **UPRIGHT)
        assert run.ended is not None and run.ended.startswith(MESSAGE.format(mu, "")[:-3])
        return float(run.end or np.nan)

    within(abs(end(0.5) - braked_instant(0.5)), 3e-11, "instant, s")
    beyond(abs(end(0.501) - braked_instant(0.5)), 1e-4, "instant with another mu_max, s")


@pytest.mark.parametrize("mu", [1e-9, 1e-7, 1e-5, 1e-3, 0.3])
def test_a_slippery_road_ends_the_run_at_its_own_coefficient_however_small(library: Library, mu: float) -> None:
    """On a ramp of the brake in proportion to mu_max, so that the instant is the same."""
    ramp = Schedule(((0.0, {"M_brake": (0.0, RAMP * mu)}),))
    times = np.linspace(0, 2 * braked_instant(1.0), 5)
    ends = [library.simulate(times, 1e-10, ramp, mu_max=limit, **UPRIGHT).end or np.nan for limit in (mu, 1.00001 * mu)]
    within(abs(ends[0] / braked_instant(1.0) - 1), 2e-6, "instant, relative")
    beyond(abs(ends[1] / braked_instant(1.0) - 1), 2e-6, "instant with another mu_max, relative")


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


def margin(mu: float, run: Solution) -> np.ndarray:
    N = run["lambda_3"]
    return (mu * N) * np.abs(mu * N) - run["lambda_1"] ** 2 - run["lambda_2"] ** 2


def test_instants_in_random_scenes_are_those_of_the_reference(library: Library) -> None:
    """The limit is that needed at a random instant; the reference's margin changes sign around the FMU's."""
    random, lost, instant = np.random.default_rng(31), 0, 1e-8
    for k in range(40):
        scene, choice = random_scene(random), random.uniform(0.05, 1.0)
        wheel, start = scene.wheel, scene.motion
        if k % 4 == 0:
            wheel = replace(PAPER, r=wheel.r)  # free and symmetric: it can be unfolded
        force = {name: tuple(random.uniform(-9, 9, 2)) for name in ("F_X", "F_Y", "M_1", "M_3")}
        inputs = Schedule(((0.0, force),) if k % 2 else ())
        values = start_values(wheel, start)
        free = library.simulate(np.linspace(0, 1, 201), 1e-9, inputs, **values)
        mu = float(np.interp(choice, free.t, free["mu_required"]))
        if not np.isfinite(mu) or mu < 1e-3:
            continue
        run = library.simulate([0.0, 1.0], 1e-11, inputs, mu_max=mu, **values)
        end = run.end if run.end is not None else 1.0
        if run.end is None or "mu_max" not in str(run.ended) or end < 2 * instant:
            assert run.end is None or end == 0.0 or "mu_max" not in str(run.ended), (k, run.ended)
            continue
        times = [*np.linspace(0, end - instant, 30), end + instant, end + 1e-4]
        want = margin(mu, solve(wheel, start, times, inputs.for_reference(), rtol=1e-11, keep_contact=True))
        weight = (wheel.m * wheel.g) ** 2
        if (want[-1] - want[-3]) > -1e-4 * 1e-2 * weight:  # it only touches zero: no instant to compare
            continue
        assert (want[:-2] > 0).all() and want[-2] < 0 and want[-1] < 0, (k, mu, end, want[-4:] / weight)
        lost += 1
    assert lost >= 15, lost


def first_peak(library: Library, start: dict[str, float]) -> tuple[float, float] | None:
    """The instant and the size of the largest coefficient that is needed in the first swing, read closer and closer."""
    swing = library.simulate(np.linspace(0, 1, 401), 1e-4, method=4, **start)
    mu, width = swing["mu_required"], 1 / 400
    rises = [k for k in range(2, len(mu) - 2) if mu[k - 1] < mu[k] >= mu[k + 1] and mu[k] >= mu[:k].max()]
    if swing.end is not None or not rises:
        return None
    instant = swing.t[rises[0]]
    for _ in range(3):
        close = library.simulate([0.0, *np.linspace(instant - width, instant + width, 201)], 1e-4, method=4, **start)
        instant, width = close.t[1 + np.argmax(close["mu_required"][1:])], width / 50
    return instant, float(close["mu_required"][1:].max())


def test_a_loss_of_grip_however_brief_is_found_inside_one_long_step(library: Library) -> None:
    """mu_max lies below the largest coefficient that is needed by a millionth and less: the loss would be over within a
    thousandth of the step. The partner: as much above it nothing ends. The limit changes no step of the motion."""

    def end(stop: float, mu: float) -> float | None:
        return library.simulate([0.0, stop], 1e-4, method=4, mu_max=mu, **start).end

    random, found, rates = np.random.default_rng(3), 0, ("psi_dot_start", "theta_dot_start", "phi_dot_start")
    while found < 40:
        start = dict(zip(rates, random.normal(0, (2, 1, 5)), strict=True)) | {"theta_start": random.uniform(0.7, 2.4)}
        peak = first_peak(library, start)
        if peak is None or not 0.02 < peak[1] < 3:
            continue
        for off in (1e-3, 1e-6, 1e-7):
            lost = end(peak[0] + 1e-6, peak[1] * (1 - off))
            assert lost is not None and lost <= peak[0] + 1e-6, (start, off)
            assert end(peak[0] + 0.01, peak[1] * (1 + off)) is None, (start, off)
        found += 1


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


@pytest.mark.parametrize("seed", range(5))
def test_model_exchange_refuses_a_start_that_its_first_event_mode_would_end(library: Library, seed: int) -> None:
    """Events that lie ahead by less than 1e-7 of the wheel's own time, here 0.2 s, have occurred for it."""
    random = np.random.default_rng(seed)
    rates = {"psi_dot_start": random.uniform(0.2, 2), "phi_dot_start": random.uniform(-8, -3)}
    start = {"theta_start": random.uniform(0.9, 1.4), "theta_dot_start": random.choice((-1, 1)), **rates}
    mu = library.simulate([0.0, 1e-4], 1e-12, **start)["mu_required"]
    rise = abs(mu[1] - mu[0]) / 1e-4
    if mu[1] < mu[0]:  # the mirror image of the motion in time
        start |= {name: -rate for name, rate in start.items() if "dot" in name}
    for ahead, taken in ((1e-9, False), (1e-5, True)):
        with loaded(library).new() as wheel:
            assert wheel.set(mu_max=mu[0] + rise * ahead, **start) == OK
            assert wheel.initialise() == (OK if taken else ERROR)
            assert not taken or not wheel.decide().terminateSimulation


@pytest.mark.parametrize("alpha", [0.01, 0.2, 0.7, 1.2])
def test_a_wheel_held_on_a_slope_starts_where_mu_max_is_the_slopes_tangent_and_not_below(library, alpha: float):
    """To a billionth, by both kinds of run alike; in model exchange the first event mode does not end it either."""
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


def test_the_indicator_of_grip_is_positive_and_constant_where_grip_is_not_checked(library: Library) -> None:
    with exchange(library, **FAST) as free, exchange(library, mu_max=5.0, **FAST) as checked:
        assert free.indicator("lost_grip") == 1.0 and INDICATORS.index("lost_grip") == 1
        needed = checked.get("mu_required")[0]
        N, weight = checked.get("lambda_3")[0], PAPER.m * PAPER.g
        expected = (1 - (needed / 5.0) ** 2) * (N / weight) ** 2
        within(abs(checked.indicator("lost_grip") - expected), 1e-10, "indicator of grip")
