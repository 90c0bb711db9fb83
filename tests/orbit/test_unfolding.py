"""The free wheel unfolded from half a swing, against stepping through and against half after half laid end to end.

J_x = J_y, no friction, no load; scaled errors: angles 1 rad, rates the largest of the motion, lengths 1 m.
"""

import ctypes
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import cos, sin

import numpy as np
import pytest
from orbit.unfolded import Array, Halves, Orbit, energies, headline_of, stepped
from scipy.optimize import brentq
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.building import probe
from wheelfmu.truth.closed_forms import circle, circle_speed, critical_spin, tipping_inertia
from wheelfmu.truth.errors import over_range
from wheelfmu.truth.reference import Start, Wheel

PAPER = Start()
SLANTED = Start(psi=0.4, theta=1.2, psi_dot=0.5, theta_dot=0.3, phi_dot=-5.0, X_O=0.5, Y_O=-0.3)


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    return probe("orbit")


def error(got: Array, want: Array) -> float:
    scales = np.array([1, *np.abs(want[:, 1:4]).max(axis=0).clip(1), 1, 1, 1, 1])
    return float((np.abs(got - want) / scales).max())


def range_error(got: Array, want: Array) -> float:
    return over_range(headline_of(got), headline_of(want))


def test_after_1000_s_each_output_is_right_to_a_millionth_of_its_range(library: ctypes.CDLL) -> None:
    t = np.arange(0.05, 1000, 0.73)
    want = Halves(Wheel(), PAPER).read(t)
    orbit = Orbit(library)
    assert orbit.kind == "unfolded"
    within(range_error(orbit(t), want), 1e-6, "error / range")
    within(range_error(Orbit(library, tolerance=1e-12)(t), want), 1e-9, "error at a tight tolerance / range")
    few = t[::20]
    beyond(range_error(orbit(few), Halves(Wheel(), PAPER, mirrored=False).read(few)), 0.1, "error unmirrored / range")


@pytest.mark.parametrize("wheel", [Wheel(), Wheel(r=0.0), Wheel(J_z=1.2, r=0.12)], ids=["paper", "disc", "fat"])
@pytest.mark.parametrize("start", [PAPER, SLANTED], ids=["from rest", "slanted"])
def test_it_is_the_motion_that_the_reference_steps_through(library: ctypes.CDLL, wheel: Wheel, start: Start) -> None:
    t = np.linspace(0, 6, 61)
    want = stepped(wheel, start, t)
    orbit = Orbit(library, wheel, start, 1e-11)
    assert orbit.kind == "unfolded"
    within(error(orbit(t), want), 1e-10, "error, scaled")
    beyond(error(Orbit(library, wheel, start, 1e-5)(t), want), 1e-9, "error at a loose tolerance, scaled")


def random_starts(count: int) -> Iterator[Start]:
    random = np.random.default_rng(7)
    for _ in range(count):
        angles = {"psi": random.uniform(0, 6), "theta": random.uniform(0.3, np.pi - 0.3)}
        rates = dict(zip(("psi_dot", "theta_dot", "phi_dot"), random.normal(0, (3, 1.5, 6)), strict=True))
        yield Start(**angles, **rates)


def test_two_thousand_random_starts_end_in_their_first_nutation_or_fold(library: ctypes.CDLL) -> None:
    ended, differences = 0, []
    for start in random_starts(2000):
        orbit = Orbit(library, start=start)
        assert orbit.kind != "refused"
        if orbit.kind == "ended":
            ended += 1
            continue
        L = orbit.half_period
        y, N = orbit.read(np.linspace(0, 7 * L, 150))
        assert (N > -1e-6 * 196.2).all()  # never lifts off later
        again = orbit(np.linspace(2 * L, 9 * L, 150))
        differences.append(np.abs(again - y)[:, :4].max() / np.abs(y[:, :4]).max())
    beyond(min(ended, 2000 - ended), 100, "wheels of either kind")
    # One period later tilt and rates are the same, from the direct part to the unfolded one.
    within(np.percentile(differences, 99), 1e-9, "change of tilt and rates over a period, relative, of all but 1 %")
    within(max(differences), 1e-7, "largest such change")  # beside an unstable rest errors grow


@pytest.mark.parametrize(("tolerance", "share"), [(1e-9, 100), (1e-10, 100), (1e-12, 90)])
def test_the_energy_is_kept_to_half_the_tolerance_wherever_it_is_read(library, tolerance: float, share: float) -> None:
    """Between the steps too: interpolation over steps that lie close together would magnify what rounds. Of all random
    starts, or, next to rounding, which may refuse some, of nine in ten."""
    changes, tilted = [], []
    for start in random_starts(2000):
        orbit = Orbit(library, start=start, tolerance=tolerance)
        if orbit.kind == "refused":
            changes.append(np.inf)
        if orbit.kind != "unfolded":
            continue
        y = orbit(np.linspace(0, 2 * orbit.half_period, 300))
        for found, lean in ((changes, 0), (tilted, 100)):  # the partner: every second state leans by 100 tolerances
            y[::2, 0] += lean * tolerance
            E = energies(Wheel(), y)
            found.append(np.ptp(E) / E.max() / tolerance)
    within(np.percentile(changes, share), 0.5, "change of the energy, tolerances")
    beyond(np.percentile(tilted, share), 30, "change of the energy of a motion that leans, tolerances")


def test_in_whatever_order_its_instants_are_read_they_have_the_same_bits(library: ctypes.CDLL) -> None:
    """Also within the rounding of the ends of halves."""
    orbit = Orbit(library)
    ends = orbit.half_period * np.arange(1, 200)
    t = np.sort([*np.linspace(0, 125, 900), *np.nextafter(ends, 0), *ends, *np.nextafter(ends, np.inf)])
    order = np.random.default_rng(5).permutation(len(t))
    np.testing.assert_array_equal(orbit(t[order]), Orbit(library)(t)[order])


LEAPING = Start(theta=0.7, psi_dot=-4.0, theta_dot=3.0, phi_dot=-3.0)


# At its highest N is just above zero, a few ms before and after below it: the first fall lies right before a turn.
CREST = Start(psi=0.0, theta=0.78, psi_dot=5.1512, theta_dot=0.0, phi_dot=4.027)


@pytest.mark.parametrize("start", [LEAPING, CREST], ids=["leaping", "crest"])
def test_the_first_fall_of_the_normal_force_below_zero_is_found_at_its_instant(library: ctypes.CDLL, start) -> None:
    orbit = Orbit(library, start=start, keep_contact=True)
    assert orbit.kind == "unfolded"
    t = np.linspace(0, 2 * orbit.half_period, 40_001)
    N = orbit.read(t)[1]
    first = orbit.first_fall()
    within(abs(first - t[1:][(N[:-1] >= 0) & (N[1:] < 0)][0]), t[1], "instant off that of the samples, s")
    # Less than one part in 1e9 of the weight, 196 N, counts as zero.
    within(abs(orbit.read([first])[1][0]), 4e-7, "normal force at the fall, N")


def test_where_the_ground_pulls_from_the_start_it_is_observed_there_and_where_it_never_pulls_never(library) -> None:
    leaping = Orbit(library, start=LEAPING, keep_contact=True)
    low = leaping.first_fall() + 1e-3
    theta, theta_dot, omega_2, omega_3 = leaping([low])[0, :4]
    psi_dot = omega_2 / sin(theta)
    start = Start(theta=theta, psi_dot=psi_dot, theta_dot=theta_dot, phi_dot=omega_3 - psi_dot * cos(theta))
    assert Orbit(library, start=start, keep_contact=True).first_fall() == 0
    assert Orbit(library, keep_contact=True).first_fall() == np.inf


def test_where_a_period_turns_the_wheel_by_half_turns_it_walks_straight_on(library: ctypes.CDLL) -> None:
    """Resonance: the turn of psi in half a swing is a multiple of pi, and sin(n delta) / sin(delta) is n."""

    def turning(psi_dot: float) -> Orbit:
        return Orbit(library, start=Start(psi_dot=psi_dot, phi_dot=-6.0), tolerance=1e-12)

    def excess(psi_dot: float) -> float:
        orbit = turning(psi_dot)
        turn = np.diff(orbit([0, orbit.half_period])[:, 4])[0] if orbit.kind == "unfolded" else np.nan
        return float(turn - np.pi * np.round(turn / np.pi))

    def walked(psi_dot: float) -> Array:
        orbit = turning(psi_dot)
        return np.hypot(*(orbit(2 * orbit.half_period * periods)[:, 6:] - orbit([0])[0, 6:]).T)

    tried, periods = np.linspace(-4, 4, 161), np.array([1.0, 1000, 1_000_000])
    values = np.array([excess(x) for x in tried])
    close = np.flatnonzero((values[:-1] * values[1:] < 0) & (np.abs(np.diff(values)) < 1))[0]
    resonance = brentq(excess, *tried[close : close + 2], xtol=1e-16, rtol=4 * EPSILON)
    straight, beside = walked(resonance), walked(resonance + 0.01)
    within(np.abs(straight / (periods * straight[0]) - 1).max(), 64 * EPSILON, "way over the periods of it, off 1")
    within(beside[-1] / straight[-1], 0.003, "way of a wheel that circles over that way")


@pytest.mark.parametrize("theta_dot", [0.0, 1e-17])
@pytest.mark.parametrize("phi_dot", [-9.0, -1000.0])
def test_straight_rolling_above_the_critical_speed_needs_no_step(library, phi_dot: float, theta_dot: float) -> None:
    """A rate that is only rounding is none: theta stays."""
    orbit = Orbit(library, start=Start(theta=np.pi / 2, phi_dot=phi_dot, theta_dot=theta_dot))
    assert (orbit.kind, orbit.steps) == ("steady", 0)
    y = orbit([1e4])[0]
    assert y[0] == np.pi / 2 and y[1] == 0
    want = Start().X_O, -phi_dot * 0.35 * 1e4  # rolls along Y
    within(abs(y[7] / want[1] - 1), 64 * EPSILON, "way, relative")
    within(abs(y[6] - want[0]) / abs(want[1]), 16 * EPSILON, "way across over that along")


def test_below_the_critical_speed_and_next_to_it_straight_rolling_is_not_taken_for_steady(library: ctypes.CDLL) -> None:
    for phi_dot in (0.0, -0.3, -1.0, -2.0, *(-critical_spin(Wheel()) * (1 + above) for above in (1e-9, 1e-4))):
        orbit = Orbit(library, start=Start(theta=np.pi / 2, phi_dot=phi_dot))
        assert orbit.kind == "refused" or orbit.steps > 100  # a nutation that begins by rounding takes its time
    assert Orbit(library, start=Start(theta=np.pi / 2, phi_dot=0.0)).kind == "ended"  # it lies flat


@pytest.mark.parametrize("wheel", [Wheel(), Wheel(r=0.0), Wheel(J_z=1.2, r=0.12)], ids=["paper", "disc", "fat"])
def test_spinning_on_its_edge_is_steady_from_the_rate_on_at_which_a_wheel_falls_from_rest(
    library, wheel: Wheel
) -> None:
    """About the vertical. A small lean has the stiffness psi_dot^2 - m g r_0 / (J_x + m R^2): omega_3 follows it."""
    falling = (wheel.m * wheel.g * wheel.r_0 / tipping_inertia(wheel)) ** 0.5
    for share in (0.99, 1.01):
        start = Start(theta=np.pi / 2, psi_dot=share * falling, phi_dot=0.0)
        assert (Orbit(library, wheel, start).kind == "steady") == (share > 1)


@pytest.mark.parametrize("lean", [1e-13, 1e-10, 1e-8, 1e-4])
def test_next_to_a_steady_motion_the_nutation_is_kept_or_too_small_to_matter(library: ctypes.CDLL, lean: float):
    start = Start(theta=np.pi / 2 + lean, phi_dot=-9.0)
    orbit = Orbit(library, start=start)
    assert orbit.kind == ("steady" if lean < 1e-12 else "unfolded")
    t = np.linspace(0, 6, 31)
    within(error(orbit(t), stepped(Wheel(), start, t)), 1e-9, "error, scaled")


@pytest.mark.parametrize("theta", [0.05, 0.1, 0.35, 1.0])
@pytest.mark.parametrize("psi_dot", [10.0, -40.0])
def test_what_is_taken_for_steady_swings_by_a_thousandth_of_the_tolerance(library, theta: float, psi_dot: float):
    """In angle and rates alike: near flat the rates swing much further than theta."""
    tolerance = 1e-8

    def beside(lean: float) -> Start:
        return replace(circle(Wheel(), theta, psi_dot), theta=theta + lean)

    leans = np.geomspace(1e-13, 1e-9, 200)
    steady = [Orbit(library, start=beside(lean), tolerance=tolerance).steps == 0 for lean in leans]
    assert steady[0] and not steady[-1]
    swing = np.ptp(stepped(Wheel(), beside(leans[steady.index(False) - 1]), np.linspace(0, 2, 400)), axis=0)
    turn = max((9.81 / 0.35) ** 0.5, abs(psi_dot) * np.sin(theta))
    most = max(swing[0], swing[2] / turn, swing[3] / turn)
    within(most / tolerance, 2e-3, "swing of what is taken for steady, tolerances")
    beyond(most / tolerance, 1e-4, "swing of what is almost not taken for steady, tolerances")


@pytest.mark.parametrize(("theta", "psi_dot"), [(0.1, 10.0), (0.35, 10.0), (1.0, -40.0)])
def test_on_a_steady_circle_the_wheel_is_a_diameter_away_after_half_a_turn_and_back_after_a_whole_one(
    library: ctypes.CDLL, theta: float, psi_dot: float
) -> None:
    wheel = Wheel()
    start = circle(wheel, theta, psi_dot)
    orbit = Orbit(library, start=start)
    assert orbit.kind == "steady"
    turns = np.array([0, 0.5, 1, 1000, 1000.5])
    away = np.hypot(*(orbit(2 * np.pi / abs(psi_dot) * turns)[:, 6:] - [start.X_O, start.Y_O]).T)
    diameter = 2 * abs(circle_speed(wheel, theta, psi_dot) / psi_dot)
    within(np.abs(away / diameter - turns % 1 * 2).max(), 1e-11, "distance from the start over the diameter")
    beyond(diameter, 0.02, "diameter, m")


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
def test_a_long_nutation_beside_an_unstable_rest_folds(library: ctypes.CDLL, off: float) -> None:
    start = Start(theta=np.pi / 2 + off, phi_dot=-2.5)
    orbit = Orbit(library, start=start, tolerance=1e-11)
    assert orbit.kind == "unfolded"
    t = np.linspace(0, 2.5 * orbit.half_period, 41)
    bound = 1e-6 * (1e-2 / off) ** 0.5  # near the rest all errors grow, the reference's too
    within(error(orbit(t), stepped(Wheel(), start, t)), bound, "error, scaled")


@pytest.mark.parametrize("theta_dot", [0.0, 1e-17, -1e-17, 1e-9, -1e-9])
def test_a_start_at_a_turning_point_or_beside_it_is_the_same_motion(library: ctypes.CDLL, theta_dot: float) -> None:
    t = np.linspace(0, 20, 101)
    want = Orbit(library, start=Start(phi_dot=-5.0), tolerance=1e-12)(t)
    got = Orbit(library, start=Start(phi_dot=-5.0, theta_dot=theta_dot))(t)
    within(error(got, want) / (1e-8 + 3 * abs(theta_dot)), 1, "error over tolerance and that of the start")


@pytest.mark.parametrize("name", ["psi_start", "phi_start", "X_O_start", "Y_O_start"])
def test_a_wheel_that_was_only_moved_keeps_its_orbit(library: ctypes.CDLL, name: str) -> None:
    used, fresh = Orbit(library), Orbit(library)
    assert used.run(name, 1.0, 70.0)[0] > 0
    steps, moved = used.run(name, -2.5, 70.0)
    steps_of_fresh, expected = fresh.run(name, -2.5, 70.0)
    assert steps == 0 < steps_of_fresh
    np.testing.assert_array_equal(moved, expected)
    assert used.run("theta_start", 1.2, 70.0)[0] > 0


# A place in the state, and what is added to its rate: forces by heading, place, roll angle, time and rate; a wind; psi,
# phi and Y_O alone, with the rate of theta.
DISTURBANCES = {"towards north": (2, lambda t, y: cos(y[4])), "towards east": (2, lambda t, y: sin(y[4]))}
DISTURBANCES |= {"beside a line": (2, lambda t, y: y[6]), "unbalanced": (3, lambda t, y: cos(y[5]))}
DISTURBANCES |= {"growing": (3, lambda t, y: t), "drag": (3, lambda t, y: -y[3]), "wind": (6, lambda t, y: 1)}
DISTURBANCES |= {name: (place, lambda t, y: y[1]) for name, place in (("turning", 4), ("rolling", 5), ("drifting", 7))}
WATCHED = 8  # the place after the last of the state: added to what is watched for an event
LIMITS = {"heading": lambda t, y: cos(y[4]), "place": lambda t, y: y[6], "roll angle": lambda t, y: cos(y[5])}
LIMITS |= {"time": lambda t, y: t}
STEADY = Start(psi=0.4, theta=np.pi / 2, phi_dot=-9.0, X_O=2.0)  # a steady wind keeps straight rolling straight
BROKEN = [(name, PAPER) for name in DISTURBANCES]
BROKEN += [(name, STEADY) for name, (place, _) in DISTURBANCES.items() if place < 4]


def built_with(library: ctypes.CDLL, start: Start, place: int, added: Callable, sizes: tuple[float, ...]) -> list[str]:
    """What comes of the orbit under disturbances of these sizes, the last below what the tolerance resolves."""
    orbit = Orbit(library, start=start)
    assert orbit.kind == ("steady" if start is STEADY else "unfolded")
    kinds = [orbit.build(place, size, added) for size in sizes]
    return ["kept" if kind == orbit.kind else kind for kind in kinds]


@pytest.mark.parametrize(("name", "start"), BROKEN)
def test_what_breaks_the_symmetry_is_noticed_whatever_it_is(library: ctypes.CDLL, name: str, start: Start) -> None:
    """The orbit has no list of what acts on the wheel: a force that such a list forgets must not be lost."""
    found = built_with(library, start, *DISTURBANCES[name], (1e-2, 1e-5, 1e-7, 1e-12))
    assert found == ["refused"] * 3 + ["kept"]


@pytest.mark.parametrize("by", LIMITS)
@pytest.mark.parametrize("start", [PAPER, STEADY], ids=["swinging", "steady"])
def test_an_event_whose_limit_breaks_the_symmetry_is_noticed_too(library: ctypes.CDLL, by: str, start: Start) -> None:
    """The motion repeats, the event does not: what happens in the first nutation shows nothing of later ones."""
    found = built_with(library, start, WATCHED, LIMITS[by], (0.1, 1e-2, 1e-3, 1e-12))
    assert found == ["refused"] * 3 + ["kept"]
