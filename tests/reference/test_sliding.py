"""The reference of the sliding wheel judged: closed forms, balances, conservation without friction, the limit of
regularized laws, and another derivation's numbers.

Every bound has a partner that breaks a law or a parameter, and must exceed the bound.
"""

from dataclasses import replace
from math import cos, hypot, pi, radians, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support import sliding as scenes
from support.bounds import beyond, within
from support.scenes import GENERAL
from support.sliding import LOCK, ROAD, UPRIGHT, Slide
from support.sliding import by_reference as run

from reference import Inputs, Start, Wheel
from reference.judge import carrier_axes, loads, momenta
from reference.sliding import SlidingSolution, solve_sliding, started
from reference.sliding_contact import resting_directions
from reference.sliding_modes import CHI, FREE, GRIPS, SLIDES, SPEED, TIME, Contacts, Mode, Options, Road

PAPER = Wheel()
R = PAPER.r_0 + PAPER.r
STRAIGHT = Start(psi=0.0, theta=pi / 2, phi_dot=0.0, X_O=0.0)
all_scenes = pytest.mark.parametrize("name", scenes.SLIDES)


def instants(got: SlidingSolution, mode: int) -> list[float]:
    return [t for t, entered in got.contacts if entered == mode]


# ---- balances ----


def balance(got: SlidingSolution, *works: str) -> float:
    """Change of energy less these works, relative to the largest energy."""
    gap = got["E"] - got["E"][0] - sum(got[work] for work in works)
    return float(np.abs(gap).max() / np.abs(got["E"]).max())


@all_scenes
def test_the_wheel_stays_on_the_ground_and_its_slip_is_that_of_its_velocities(name: str) -> None:
    got = run(name)
    within(max(got["residual_velocity"].max(), np.abs(got["residual_height"]).max()), 2e-11, "gap, m/s and m")


@all_scenes
def test_energy_changes_by_the_work_of_inputs_and_both_frictions(name: str) -> None:
    within(balance(run(name), "work_inputs", "work_friction", "work_sliding"), 5e-11, "energy gap")


def test_energy_does_not_balance_without_the_work_of_sliding() -> None:
    beyond(balance(run("thrown"), "work_inputs", "work_friction"), 0.05, "energy gap")


def test_work_of_sliding_is_force_times_slip() -> None:
    """The quadrature against Gauss's rule on the rows of a slide, and against a coefficient 0.1 % larger."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    got = scenes.SLIDES["thrown"].solved([0, *(0.15 * (nodes + 1) / 2), 0.15])
    power = got["lambda_x"] * got["slip_x"] + got["lambda_y"] * got["slip_y"]
    work = weights @ power[1:-1] * 0.15 / 2
    within(abs(work / got["work_sliding"][-1] - 1), 1e-11, "work of sliding, relative")
    coulomb = -1.001 * 0.4 * got["lambda_3"] * np.hypot(got["slip_x"], got["slip_y"])
    beyond(abs(weights @ coulomb[1:-1] * 0.15 / 2 / got["work_sliding"][-1] - 1), 5e-4, "work, 0.1 % more friction")


def test_all_loads_account_for_momentum_and_angular_momentum_of_a_slide() -> None:
    """General inertia, inputs, rolling friction, over 0.2 s; the loads act at the contact, nothing else moves O."""
    inputs = Inputs(lambda t: (3 * sin(2 * t), 2 * cos(3 * t), -5.0), lambda t: (0.3, 0.2 * sin(2 * t), 0.5))
    wheel, road = Wheel(**GENERAL, s=0.02), Road(0.4, 0.35, (1.0, -1.5))
    nodes, weights = np.polynomial.legendre.leggauss(40)
    times = np.concatenate([[0], (nodes + 1) / 10, [0.2]])

    def gap(judged: Wheel) -> float:
        got = solve_sliding(wheel, Start(phi=0.3, psi_dot=0.4, theta_dot=0.3), road, times, inputs)
        assert (got["contact_mode"] == 1).all()
        gaps = []
        for held, load in zip(momenta(judged, got), loads(wheel, got, inputs), strict=True):
            gaps.append(held[-1] - held[0] - weights @ load[1:-1] / 10)
        return float(np.abs(gaps).max())

    within(gap(wheel), 4e-10, "impulse gap")
    beyond(gap(replace(wheel, J_x=1.2, J_y=0.7)), 0.1, "impulse gap with swapped inertia")


@all_scenes
def test_friction_opposes_the_slip_with_mu_N_and_grip_stays_within_its_limit(name: str) -> None:
    got, road = run(name), scenes.SLIDES[name].road
    slides = got["contact_mode"] == 1
    slip, force = (np.array([got[f"{what}_x"], got[f"{what}_y"]]) for what in ("slip", "lambda"))
    speed = np.hypot(*slip)
    ideal = -road.mu_slide * np.maximum(got["lambda_3"], 0) * slip / np.where(speed > 0, speed, 1)
    off = np.abs(force - ideal)[:, slides & (speed > 1e-6)] / np.abs(got["lambda_3"][slides & (speed > 1e-6)])
    within(off.max(initial=0.0), 1e-9, "force of sliding, over N")
    assert (got["mu_required"][~slides] <= road.mu_max).all()
    assert (speed[~slides] == 0).all()


# ---- closed forms, upright and straight ----


def test_a_locked_wheel_stops_after_v_squared_over_2_mu_g_and_stays() -> None:
    t, way = scenes.stopping(PAPER, 0.4, 7.0)
    got = Slide({**ROAD, **UPRIGHT, "slip_x_start": 7.0}, 2.0, LOCK).solved([0, t / 2, t + 1e-6, t + 0.5])
    assert got.contacts[1][1] == 0 and got["omega_z"].tolist() == [0.0] * 4 and way == pytest.approx(6.2436, abs=5e-5)
    error = [got.contacts[1][0] / t - 1, *(got["X_O"][1:] / way - (0.75, 1, 1))]
    within(np.abs(error).max(), 1e-12, "instant and way, relative")
    assert np.abs(got["X_O_dot"][-2:]).max() < 1e-12 and not got["slip_x"][-2:].any()
    rolling = solve_sliding(PAPER, STRAIGHT, Road(0.45, 0.4, (7.0, 0.0)), [0, t], Inputs())
    beyond(rolling["X_O"][-1] / way, 1.1, "way without the lock, relative")


def test_a_wheel_thrown_with_backspin_grips_at_its_instant_and_comes_back() -> None:
    t, v, way = scenes.backspin(PAPER, 0.3, 2.0, 10.0)
    assert (t, v) == pytest.approx((0.791509, -0.329412), abs=5e-7)
    road = Road(0.3, 0.3, (2 + R * 10.0, 0.0))  # O moves at -R omega_z + slip

    def errors(wheel: Wheel) -> float:
        got = solve_sliding(wheel, replace(STRAIGHT, phi_dot=10.0), road, [0, t + 1e-6, t + 1])
        assert [mode for _, mode in got.contacts] == [1, 0]
        ends = way + v * 1e-6, way + v
        return max(abs(got.contacts[1][0] - t), *np.abs(got["X_O_dot"][1:] - v), *np.abs(got["X_O"][1:] - ends))

    within(errors(PAPER), 1e-11, "instant, velocity and place")
    beyond(errors(replace(PAPER, J_z=1.801, J_x=0.9005, J_y=0.9005)), 1e-4, "with another inertia")


@pytest.mark.parametrize("excess", [1.001, 2.0])
def test_a_motor_beyond_the_gripping_torque_spins_the_wheel(excess: float) -> None:
    torque = excess * scenes.gripping_torque(PAPER, 0.45)
    a, spin = scenes.spinning(PAPER, 0.4, torque)

    def end(share: float) -> SlidingSolution:
        inputs = Inputs(moment=lambda t: (0.0, 0.0, -share * torque))
        return solve_sliding(PAPER, STRAIGHT, Road(0.45, 0.4), [0, 1], inputs)

    got = end(1.0)
    within(max(abs(got["X_O_dot"][-1] - a), abs(got["omega_z"][-1] - spin)), 1e-11, "velocity and spin after 1 s")
    assert got.contacts == [(0.0, 1)]
    rolls = end(0.999 / excess)
    assert rolls.contacts == [(0.0, 0)]
    beyond(abs(rolls["omega_z"][-1] - spin), 1, "spin below the limit")


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_a_wheel_let_go_on_a_slope_rolls_up_to_its_limit_and_slides_above(share: float) -> None:
    slope, slides = share * scenes.gripping_slope(PAPER, 0.2), share > 1
    wheel = replace(PAPER, slope=slope, slope_direction=pi)  # downhill is +X

    def error(judged: bool) -> float:
        a, spin = scenes.downhill(wheel, 0.18, slope, judged)
        got = solve_sliding(wheel, STRAIGHT, Road(0.2, 0.18), [0, 1])
        assert got.contacts == [(0.0, int(slides))]
        return max(abs(got["X_O_dot"][-1] - a), abs(got["omega_z"][-1] + spin))

    within(error(slides), 1e-11, "velocity and spin after 1 s")
    beyond(error(not slides), 0.1, "by the other closed form")


# ---- without friction: O'Reilly (1996) ----


@pytest.mark.parametrize("mu", [0.0, 1e-7])
@pytest.mark.parametrize("r", [0.0, 0.05])
def test_without_friction_the_sliding_disc_keeps_its_momenta(mu: float, r: float) -> None:
    """Vertical and axle angular momentum, horizontal momentum, energy; with mu all change by mu times the weight."""
    wheel = Wheel(r=r)

    def change(coefficient: float, wheel: Wheel = wheel) -> float:
        road = Road(coefficient, coefficient, (1.0, 2.0))
        got = solve_sliding(wheel, Start(psi_dot=1.5, phi_dot=-3.0), road, np.linspace(0, 1, 11))
        p, L = momenta(wheel, got)
        _, _, e3 = carrier_axes(got["psi"], got["theta"])
        kept = np.column_stack([p[:, :2], L[:, 2], np.sum(L * e3, axis=1), got["E"]])
        return float(np.abs(kept - kept[0]).max())

    within(change(mu), 1e-10 + mu * 1e3, "change of the conserved quantities")
    beyond(change(1e-3), 1e-2, "change with a coefficient of 1e-3")
    if mu == 0:
        beyond(change(mu, Wheel(r=r, J_x=0.7, J_y=1.2)), 1e-2, "change of the axle's with J_x != J_y")


# ---- the layer near |u| = 0 ----


def lost(road: Road, wheel: Wheel = PAPER, start: Start | None = None) -> float:
    got = solve_sliding(wheel, start or Start(), road, [0.0, 1.0])
    return instants(got, 1)[0]


def test_the_slip_starts_in_the_direction_of_its_own_acceleration() -> None:
    """One-sided sixth-order differences of the slip after the loss, along X and Y."""
    road, h = Road(0.45, 0.4), 1e-4
    t = lost(road)
    got = solve_sliding(PAPER, Start(), road, [0.0, *(t + h * np.arange(1, 7))])
    c, s = np.cos(got["psi"]), np.sin(got["psi"])
    u = np.array([got["slip_x"] * c - got["slip_y"] * s, got["slip_x"] * s + got["slip_y"] * c])[:, 1:]
    acceleration = u @ np.array([6, -15 / 2, 20 / 3, -15 / 4, 6 / 5, -1 / 6]) / h
    y = at_loss(road, t)
    contacts = Contacts(PAPER, road, Inputs(), Options())
    (mode, chi) = contacts.choose(y, gone=GRIPS)  # type: ignore[misc]
    push = contacts.sliding_at(mode, y).push(0.4, chi)
    within(abs(hypot(*acceleration) - push.grow), 1e-9, "acceleration, m/s2")
    within(abs(np.arctan2(acceleration[1], acceleration[0]) - chi), 1e-9, "direction, rad")
    X, Y = contacts.sliding_at(mode, y).grip()
    beyond(abs(np.arctan2(-Y, -X) - chi), 5e-3, "direction off the one against the grip's force, rad")


def at_loss(road: Road, t: float) -> np.ndarray:
    """The state of the paper's wheel at the loss of grip, from its columns."""
    got = solve_sliding(PAPER, Start(), replace(road, mu_max=np.inf), [0.0, t])
    at = {name: float(column[-1]) for name, column in got.columns.items()}
    names = ("psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "X_O", "Y_O")
    y = started(PAPER, Start(**{name: at[name] for name in names}), road)
    y[TIME] = t
    return y


@pytest.mark.parametrize(("mu_slide", "power"), [(0.4, 2), (0.36, 1)])
def test_slip_grows_with_time_or_where_the_coefficients_are_equal_with_its_square(mu_slide: float, power: int) -> None:
    road = Road(0.4, mu_slide)
    t = lost(road)
    got = solve_sliding(PAPER, Start(), road, [0.0, t + 1e-5, t + 2e-5])
    slip = np.hypot(got["slip_x"], got["slip_y"])
    within(abs(np.log2(slip[2] / slip[1]) - power), 1e-3, "power of the slip's growth")
    beyond(abs(np.log2(slip[2] / slip[1]) - (3 - power)), 0.9, "the other power")


def regularized(road: Road, start: Start, width: float, stop: float) -> np.ndarray:
    """X_O and Y_O under friction mu N u / sqrt(u^2 + width^2): no event, no grip."""
    contacts, mode = Contacts(PAPER, road, Inputs(), Options()), Mode(FREE, -1, 1)

    def rate(_t: float, y: np.ndarray) -> np.ndarray:
        found, u = contacts.sliding_at(mode, y), hypot(y[SPEED], y[CHI])
        force = found.push(road.mu_slide * u / hypot(u, width), float(np.arctan2(y[CHI], y[SPEED]))).force
        found = found._replace(base=found.at(*force), free=found.slip_rate(*force))
        return np.array((*contacts.rates(mode, y, found)[0], *found.free, 1.0))

    y_0 = started(PAPER, start, replace(road, mu_max=0.0))  # u_X and u_Y
    return solve_ivp(rate, (0, stop), y_0, "LSODA", rtol=1e-10, atol=1e-12).y[7:9, -1]


def test_slide_and_grip_are_the_limit_of_regularized_laws() -> None:
    """Their error is of first order in the width, their extrapolation small."""
    road, start = Road(0.4, 0.4, (-1.5, 0.8)), Start(phi_dot=-6.0)
    exact = solve_sliding(PAPER, start, road, [0.0, 0.3])
    assert [mode for _, mode in exact.contacts] == [1, 0]
    truth = np.array([exact["X_O"][-1], exact["Y_O"][-1]])
    wide, narrow = (regularized(road, start, width, 0.3) for width in (1e-3, 5e-4))
    errors = [float(np.abs(x - truth).max()) for x in (wide, narrow, 2 * narrow - wide)]
    within(abs(errors[0] / errors[1] - 2), 0.05, "ratio of the errors, less 2")
    within(errors[2], errors[1] / 50, "error of the extrapolation, m")
    beyond(errors[1], 1e-5, "error at the smaller width, m")


def test_a_wheel_that_cannot_grip_slides_on_in_another_direction() -> None:
    """A long roller: the slip reaches zero where grip needs more than mu_max, and grows again from there."""
    scene = scenes.SLIDES["turns at once"]
    got = run("turns at once")
    (t, first), (again, second) = got.contacts
    assert (t, first, second) == (0.0, 1, 1) and 0 < again < 0.01
    near = scene.solved([0.0, again - 1e-7, again + 1e-7])
    speed = np.hypot(near["slip_x"], near["slip_y"])[1:]
    turned = np.arctan2(near["slip_y"], near["slip_x"])[1:]
    within(speed.max(), 1e-5, "slip within 1e-7 s of its zero, m/s")
    beyond(abs(np.angle(np.exp(1j * (turned[1] - turned[0])))), 0.5, "turn of the slip, rad")
    able = replace(scene, start={**scene.start, "mu_max": 5.0})
    assert able.solved([0.0, 0.05]).contacts[1][1] == 0


# ---- jam, lift-off ----


def test_friction_jams_a_wheel_that_it_rights_where_no_normal_force_is_left() -> None:
    got, wheel = run("jams"), scenes.SLIDES["jams"].wheel
    assert got.ended and got.ended.kind == "jams"
    across = -got["lambda_y"][-1] / got["lambda_3"][-1]  # of mu: the slip turns, too
    within(abs(-across / scenes.jamming(wheel, got["theta"][-1]) - 1), 1e-6, "coefficient across, relative")
    beyond(got["lambda_3"][-1] / (wheel.m * wheel.g), 1e6, "normal force over the weight")
    least = 2 * sqrt(0.05 * 1.05)  # of a thin wheel with J_x = 0.05 m r_0^2
    below = replace(scenes.SLIDES["jams"], start={**scenes.SLIDES["jams"].start, "mu_max": least, "mu_slide": least})
    assert below.solved([0.0, 0.2]).ended is None


def test_a_wheel_on_the_upright_side_of_the_jam_is_pushed_back() -> None:
    scene = scenes.SLIDES["jams"]
    fall = {"theta_start": radians(88.0), "theta_dot_start": -2.0, "slip_x_start": 0.0}
    got = replace(scene, start={**scene.start, **fall}).solved(np.linspace(0, 0.2, 21))
    assert got.ended is None
    beyond(np.degrees(got["theta"][-1]), 90, "lean after 0.2 s, degrees")
    free = replace(scene, start={**scene.start, **fall, "mu_max": 0.1, "mu_slide": 0.1}).solved([0.0, 0.2])
    within(np.degrees(free["theta"][-1]), 90, "lean with little friction, degrees")


def test_usual_wheels_have_one_direction_to_start_in() -> None:
    """J_x = J_y <= J_z: no state with mu |dN/df| < 1 has two roots that draw neighbours in and let the slip grow."""
    random, counts = np.random.default_rng(5), []
    for _ in range(200):
        J_z = random.uniform(0.4, 1.8)
        J = J_z * random.uniform(0.5, 1)
        wheel = Wheel(r=random.uniform(0, 0.1), J_x=J, J_y=J, J_z=J_z)
        motion = dict(zip(("psi_dot", "theta_dot", "phi_dot"), random.normal(0, 3, 3), strict=True))
        mu = random.uniform(0.1, 0.8)
        y = started(wheel, Start(theta=random.uniform(0.5, 2.6), **motion), Road(mu, mu))
        found = Contacts(wheel, Road(mu, mu), Inputs(), Options()).sliding_at(Mode(SLIDES, 1, 1), y)
        X, Y = found.grip()
        N = found.at(X, Y)[6]
        if N <= 0 or found.base[6] <= 0 or mu * hypot(found.by_X[6], found.by_Y[6]) >= 1 or hypot(X, Y) < mu * N:
            continue
        roots = resting_directions(found, mu)
        grows = [chi for chi in roots if found.push(mu, chi).grow > 0]
        counts.append((len(grows), sum(found.turning(mu, chi) < 0 for chi in grows), len(roots)))
    assert len(counts) > 40 and {count[:2] for count in counts} == {(1, 1)}
    assert max(count[2] for count in counts) == 4  # others arrive


def test_a_wheel_that_swings_up_lifts_off_while_it_slides() -> None:
    start, road = Start(theta=0.4, theta_dot=7.0, phi_dot=0.0), Road(0.3, 0.3, (0.0, 3.0))
    got = solve_sliding(PAPER, start, road, [0.0, 2.0])
    assert got.ended and got.ended.kind == "lift-off" and got["contact_mode"][-1] == 1
    within(abs(got["lambda_3"][-1]) / (PAPER.m * PAPER.g), 1e-10, "normal force over the weight")
    held = solve_sliding(PAPER, start, road, [0.0, got.ended.time + 0.01], keep_contact=True)
    assert held.ended is None and held["lambda_3"][-1] < 0
    assert held["lambda_1"][-1] == held["lambda_2"][-1] == 0  # the ground that pulls has no friction


# ---- another derivation ----


def test_the_papers_wheel_slides_when_another_derivation_has_it_slide() -> None:
    got = run("paper's wheel")
    assert [mode for _, mode in got.contacts] == [0, 1, 0, 1, 0]
    found = [t for t, _ in got.contacts[1:]]
    within(float(np.abs(np.subtract(found, (0.57083, 0.955, 1.87418, 2.19016))).max()), 6e-6, "instants, s")
    within(abs(got["E"][-1] - 66.557), 6e-4, "energy that is left, J")
    other = solve_sliding(PAPER, Start(), Road(0.451, 0.4), [0.0, 1.0])
    beyond(abs(instants(other, 1)[0] - 0.57083), 1e-4, "instant with another mu_max, s")
