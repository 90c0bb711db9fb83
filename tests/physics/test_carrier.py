"""A wheel on its carrier (`guided`), which holds heading and tilt, or steers and leans it: closed forms, its own
reference, jumps of the rates, inertias that rise towards it, model exchange.

R = r_0 + r, rho = r_0 + r sin(theta), eta = r cos(theta), I = J_z + m rho^2. Along e1 v = -rho omega_z and
I omega_z' = M_3 + tau - rho F_1 while it grips and theta stands; N = m g - F_Z then. Straight motions that friction
stops, or in which it slides: test_straight.py. SI units.
"""

from collections.abc import Callable, Sequence
from math import cos, pi, radians, sin

import numpy as np
import pytest
from scipy.integrate import simpson, solve_ivp
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import STATES, Value, shifted
from wheelfmu.truth.exchange import exchange
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.reference.carried import Piece
from wheelfmu.truth.scenes import GENERAL, carried
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import SLIDES, UPRIGHT

M, R_0, TUBE, J_X, J_Z, G = 20.0, 0.3, 0.05, 0.9, 1.8, 9.81
R = R_0 + TUBE
V = 10.0  # m/s
ROLLS = {**UPRIGHT, "guided": True, "phi_dot_start": -V / R}
CAMBER = radians(75)
FREE, STOPPED = {"guided": False}, {"phi_dot_start": 0.0}
READ = ("X_O", "Y_O", "Z_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "omega_z", "omega_z_dot", "v_x", "v_y")
READ += ("lambda_3", "lambda_x", "lambda_y", "tau", "M_guide_1", "M_guide_2", "slip_x", "slip_y")


def rho(theta: float) -> float:
    return R_0 + TUBE * sin(theta)


def inertia(theta: float) -> float:
    return J_Z + M * rho(theta) ** 2


def schedule(pieces: Sequence[Piece]) -> Schedule:
    rows = []
    for piece in pieces:
        inputs = {"psi_dot_guide": piece.psi_dot, "theta_dot_guide": piece.theta_dot, **piece.loads}
        rows.append((piece.begin, {name: shifted(row, -piece.begin) for name, row in inputs.items()}))
    return Schedule(tuple(rows))


def driven(library: Library, pieces: Sequence[Piece], times: Sequence[float], tolerance=1e-12, **start: Value) -> Run:
    return library.simulate(times, tolerance, schedule(pieces), **{**UPRIGHT, "guided": True, **start})


def guided(library: Library, times, inputs: dict | None = None, tolerance: float = 1e-10, **start) -> Run:
    """Its axle keeps its direction: along X and upright unless said."""
    load = Schedule(((0.0, inputs),)) if inputs else None
    return library.simulate(times, tolerance, load, **{**UPRIGHT, "guided": True, **start})


def held(psi_dot: float, theta_dot: float = 0.0, end: float = 1.0, **loads: float) -> Piece:
    return Piece(0.0, end, (psi_dot,), (theta_dot,), {name: (value,) for name, value in loads.items()})


# ---- closed forms: the axle keeps its direction ----


@pytest.mark.parametrize("theta", [pi / 2, CAMBER, 2.3])
def test_loads_move_it_along_its_heading_and_the_carrier_takes_the_rest(
    library: Library, formulation: int, theta: float
) -> None:
    """Moments about O of ground, load and carrier balance across the axle; none is gyroscopic."""
    load = {"F_X": 8.0, "F_Y": -7.0, "F_Z": -30.0, "M_1": 2.0, "M_2": 0.5, "M_3": -3.0}
    spun = -3.0 - rho(theta) * 8.0
    N, along = M * G + 30.0, -8.0 - M * rho(theta) * spun / inertia(theta)
    want = {"omega_z_dot": spun / inertia(theta), "lambda_3": N, "lambda_y": 7.0, "lambda_x": along}
    want |= {"M_guide_1": N * R_0 * cos(theta) - 7.0 * (R_0 * sin(theta) + TUBE) - 2.0}
    want |= {"M_guide_2": along * TUBE * cos(theta) - 0.5, "theta": theta, "psi": 0.0, "theta_dot": 0.0, "psi_dot": 0.0}
    times = [0.0, 0.7, 2.0]

    def error(**change) -> float:
        start = {"theta_start": theta, "phi_dot_start": -30.0, "formulation": formulation, **GENERAL, **change}
        run = guided(library, times, load, **start)
        spin = absolute_error(run["omega_z"], -30.0 + want["omega_z_dot"] * np.array(times))
        return max(spin, *(absolute_error(run[name], value) for name, value in want.items()))

    within(error(), 1e-9, "reactions, N, N m, angles, rad, and rates")
    beyond(error(**FREE), 1.0, "reactions and angles of the wheel that is not guided")


@pytest.mark.parametrize("method", [1, 4], ids=["unfolded", "stepped"])
def test_free_of_friction_it_rolls_straight_for_ever(library: Library, method: int) -> None:
    """Unfolded: nothing is integrated, whatever J_x and J_y are, and also where it may slide."""
    times = [0.0, 1.0, 1e6 if method == 1 else 100.0]
    start = {"theta_start": CAMBER, "psi_start": 0.7, "phi_dot_start": -10.0, "mu_max": 0.5, "mu_slide": 0.4}
    run = guided(library, times, method=method, **start, **GENERAL)
    way = 10.0 * rho(CAMBER) * run.t
    found = [run["X_O"] * cos(0.7) + run["Y_O"] * sin(0.7), -run["phi"] * rho(CAMBER), way]
    within(absolute_error(found, [way, way, way]) / way[-1], 1024 * EPSILON, "place, relative")  # a thousand steps
    assert (run.counters["n_steps"] == 0) == (method == 1)
    if method == 1:
        beyond(guided(library, [0.0, 1.0], s=1e-9, **start).counters["n_steps"], 0, "steps with friction")


def test_a_guided_wheel_does_not_jam_where_a_tilting_one_does(library: Library) -> None:
    scene = SLIDES["jams"]
    start = {**scene.start, "theta_dot_start": 0.0}
    on_carrier = library.simulate([0.0, scene.duration], 1e-10, **start, guided=True)
    assert on_carrier.end is None and on_carrier["lambda_3"] == pytest.approx(M * G, abs=1e-12)
    free = library.simulate([0.0, scene.duration], 1e-10, **scene.start)
    assert free.ended is not None and "jams" in free.ended


def test_a_load_lifts_it_off_and_a_ground_that_pulls_keeps_it_without_friction(library: Library) -> None:
    lift = {"F_Z": (0.0, M * G)}  # the weight at 1 s
    start = {"theta_start": CAMBER, "phi_dot_start": -10.0, "s": 0.02}
    ended = guided(library, [0.0, 2.0], lift, **start)
    assert ended.ended is not None and "lifted off" in ended.ended
    within(abs(ended.t[-1] - 1.0), 1e-8, "instant at which it lifts off, s")
    kept = guided(library, [0.0, 1.0, 2.0], lift, **start, keep_contact=True)
    lost = 0.02 * M * G * 0.5 / inertia(CAMBER)
    within(absolute_error(kept["omega_z"][1:], -10.0 + lost), 64 * 10 * EPSILON, "spin, rad/s")
    within(absolute_error(kept["lambda_3"], M * G * (1 - kept.t)), 16 * M * G * EPSILON, "normal force, N")


# ---- closed forms: it steers and leans ----


def test_in_a_steady_turn_the_road_gives_m_v_psi_dot_and_the_carrier_turns_the_angular_momentum(
    library: Library, formulation: int
) -> None:
    turn, times = 0.5, np.linspace(0, 4, 9)

    def error(judged: float) -> float:
        run = driven(library, [held(turn * judged, end=4.0)], times, **ROLLS, formulation=formulation)
        want = {"lambda_x": 0.0, "lambda_y": M * V * turn, "lambda_3": M * G, "mu_required": V * turn / G, "v_x": V}
        want |= {"v_y": 0.0, "M_guide_1": -(J_Z + M * R**2) * V / R * turn, "M_guide_2": 0.0, "psi": turn * times}
        want |= {"X_O": V / turn * np.sin(turn * times), "Y_O": V / turn * (1 - np.cos(turn * times))}
        return max(absolute_error(run[name], value) for name, value in want.items())

    within(error(1.0), 1e-10, "forces, N, moments, N m, path, m")
    beyond(error(1.001), 1e-2, "the same with 0.1 % more")


def test_a_turn_slides_out_where_it_needs_more_than_the_road_gives(library: Library) -> None:
    """At m v psi_dot = mu_max N, sideways and to the right of a left turn."""
    road = {"mu_max": 0.3, "mu_slide": 0.25}
    grows = Piece(0.0, 1.0, (0.0, 0.5), (0.0,))
    limit = 0.3 * G / V / 0.5  # s
    times = np.array([0.0, limit - 1e-6, limit + 1e-6, limit + 0.1])
    run = driven(library, [grows], times, **ROLLS, **road)
    assert run["contact_mode"].tolist() == [0, 0, 1, 1] and run["slip_y"][-1] < -0.01
    within(absolute_error(np.hypot(run["lambda_x"], run["lambda_y"])[2:], 0.25 * M * G), 1e-9, "friction, N")
    wide = driven(library, [grows], times, **ROLLS, mu_max=0.31, mu_slide=0.25)
    assert wide["contact_mode"].tolist() == [0, 0, 0, 1]


def test_after_many_turns_the_path_has_all_its_digits(library: Library, formulation: int) -> None:
    """A hundred circles, from a heading of a million turns."""
    turn = 2 * pi
    start = {**ROLLS, "psi_start": 2e6 * pi + 0.3, "formulation": formulation}
    run = driven(library, [held(turn, end=100.25)], [*np.arange(0.0, 101.0, 2.0), 100.25], 1e-10, **start)
    heading = start["psi_start"] % (2 * pi)
    radius = V / turn
    want = [radius * (sin(heading + pi / 2) - sin(heading)), radius * (cos(heading) - cos(heading + pi / 2))]
    within(absolute_error([run["X_O"][-2], run["Y_O"][-2]], 0.0), 1e-7, "place after whole circles, m")
    within(absolute_error([run["X_O"][-1], run["Y_O"][-1]], want), 1e-7, "place a quarter on, m")
    within(absolute_error(run["omega_z"], -V / R), 1e-10, "spin, rad/s")


# ---- the reference ----

STEER, LEAN = (0.5, 0.8, -0.6, 0.3), (-0.3, 0.9, -0.4, -0.2)
PUSH = {"F_X": (3.0, 2.0), "F_Y": (-20.0, 30.0), "F_Z": (-40.0, 15.0), "M_1": (1.0, -2.0), "M_2": (0.3, 1.0)}
PUSH |= {"M_3": (-9.0, 4.0)}
BRAKED = PUSH | {"M_brake": (2.0, 1.0)}
ROUGH = {**GENERAL, "theta_start": 1.3, "psi_start": 0.4, "phi_start": 0.2, "phi_dot_start": -8.0}
SLIPPERY = {"mu_max": 0.3, "mu_slide": 0.25, "slip_x_start": 3.0, "slip_y_start": -2.0}
SURFACES: dict[str, tuple[dict[str, float], dict]] = {
    "rolls": (ROUGH, PUSH),
    "rubs on a slope": (ROUGH | {"s": 0.02, "slope": 0.2, "slope_direction": 1.1}, BRAKED),
    "slides": (ROUGH | {"s": 0.02} | SLIPPERY, BRAKED),
    "regularized": (ROUGH | {"s": 0.02, "friction_law": 2, "omega_s": 0.5}, BRAKED),
}
surfaces = pytest.mark.parametrize(("start", "loads"), SURFACES.values(), ids=SURFACES)
courses = pytest.mark.parametrize("course", [((0.0,), (0.0,)), (STEER, LEAN)], ids=["held", "steers and leans"])


@courses
@surfaces
def test_it_moves_as_a_rotation_matrix_in_fixed_axes_by_both_formulations(library: Library, course, start, loads):
    times, pieces = np.linspace(0, 1, 6), [Piece(0.0, 1.0, *course, loads)]
    want, _ = carried({**UPRIGHT, **start}, pieces, times)

    def apart(found: Run, expected: dict[str, np.ndarray] | Run) -> dict[str, float]:
        return {name: absolute_error(found[name], expected[name]) for name in READ}

    runs = [driven(library, pieces, times, **start, formulation=formulation) for formulation in (2, 3)]
    for run in runs:
        within(apart(run, want), 1e-9, "apart, SI")
    if not any(course[0]):  # the multibody form has two constraints more
        bound = 1e-9 if "mu_slide" in start else 64 * 200 * EPSILON  # N
        within(apart(*runs), bound, "formulations apart, SI")
        assert not any(run[name].any() for run in runs for name in ("theta_dot", "psi_dot"))
    beyond(
        max(apart(driven(library, pieces, times, **{**start, "J_z": 1.8002}), want).values()),
        1e-5,
        "with another J_z, SI",
    )


def test_it_slides_out_grips_and_stands_as_the_reference_does(library: Library) -> None:
    start = {**GENERAL, "s": 0.02, "theta_start": 1.5, "phi_dot_start": -28.0, "mu_max": 0.3, "mu_slide": 0.25}
    turn = {"M_brake": (0.0,)}
    pieces = [Piece(0.0, 0.8, (0.0, 0.5), (0.0, 0.2), turn), Piece(0.8, 2.0, (0.4, -0.4), (0.16, -0.15), turn)]
    times = [0.0, 0.5, 0.7, 0.9, 1.5, 2.0]
    want, transitions = carried({**UPRIGHT, **start}, pieces, times)
    assert [name for _, name in transitions] == ["grip", "slip"]
    slide, end = (t for t, _ in transitions)
    for formulation in (2, 3):
        run = driven(library, pieces, times, **start, formulation=formulation)
        within({name: absolute_error(run[name], want[name]) for name in READ}, 2e-7, "apart, SI")  # a slip begins
        assert run["contact_mode"].tolist() == [int(slide < t < end) for t in times]


# ---- jumps ----

RISES = {**GENERAL, "theta_start": 1.2, "phi_dot_start": -8.0}
JUMPS: dict[str, tuple[dict[str, float], tuple[float, float], dict[str, float]]] = {
    "rolls": (RISES, (1.5, 0.7), {}),
    "pressed": (RISES | {"s": 0.03}, (1.5, 1.7), {}),
    "relieved": (RISES | {"s": 0.03}, (-1.5, -0.7), {}),
    "friction stops it": (RISES | {"s": 0.03, "phi_dot_start": -0.01}, (0.0, 2.0), {}),
    "held": (RISES | {"s": 0.03, "phi_dot_start": 0.0}, (0.1, 2.0), {}),
    "held, relieved": (RISES | {"s": 0.03, "phi_dot_start": 0.0}, (0.1, -2.0), {}),
    "released by the brake": (RISES | {"phi_dot_start": 0.0}, (3.0, 2.0), {"M_brake": 30.0}),
    "through zero": (RISES | {"s": 0.03, "phi_dot_start": 0.02}, (-3.0, 2.0), {}),
    "slides and steers": (RISES | {"s": 0.03} | SLIPPERY, (-1.5, 0.0), {}),
    "slides and leans": (RISES | {"s": 0.03} | SLIPPERY, (-1.5, 1.5), {}),
    "slides, little slip": (
        RISES | {"s": 0.03} | SLIPPERY | {"slip_x_start": 0.01, "slip_y_start": 0.02},
        (1.0, -1.7),
        {},
    ),
    "regularized": (RISES | {"s": 0.03, "friction_law": 2, "omega_s": 0.5, "phi_dot_start": -0.3}, (0.5, 1.7), {}),
    "into the layer": (
        RISES | {"s": 0.6, "friction_law": 2, "omega_s": 0.01, "phi_dot_start": -0.3},
        (-15.0, 3.7),
        {},
    ),
}
AFTER = 2e-3  # s


def after_jump(library: Library, jump: str, formulation: int, ramp: float) -> dict[str, float]:
    """State a little later, reached through a ramp of this duration, s; 0: a jump."""
    start, (psi_dot, theta_dot), loads = JUMPS[jump]
    brake = {name: (value,) for name, value in loads.items()}
    first = [Piece(0.0, 1e-3, (0.0,), (0.0,), brake)]
    if ramp:
        first += [Piece(1e-3, 1e-3 + ramp, (0.0, psi_dot / ramp), (0.0, theta_dot / ramp), brake)]
    last = Piece(1e-3 + ramp, AFTER, (psi_dot,), (theta_dot,), brake)
    run = driven(library, [*first, last], [0.0, AFTER], **start, formulation=formulation, keep_contact=True)
    return {
        name: float(run[name][-1]) for name in ("omega_z", "v_x", "v_y", "slip_x", "slip_y", "psi_dot", "theta_dot")
    }


@pytest.mark.parametrize("jump", JUMPS)
def test_a_jump_of_the_rates_is_the_limit_of_ever_steeper_ramps(library: Library, jump: str, formulation: int) -> None:
    """Their errors fall with their duration, to what the solver leaves. A ramp that relieves the ground below a spin is
    looked at as if the ground went on pressing: in the tests of the reference."""
    start, (_, theta_dot), _ = JUMPS[jump]
    want = after_jump(library, jump, formulation, 0.0)
    if theta_dot < 0 and start["phi_dot_start"]:
        pieces = [Piece(0.0, 1e-3, (0.0,), (0.0,))]
        pieces += [Piece(1e-3, 1e-3 + 1e-7, (0.0, JUMPS[jump][1][0] / 1e-7), (0.0, theta_dot / 1e-7))]
        pieces += [Piece(1e-3 + 1e-7, AFTER, (JUMPS[jump][1][0],), (theta_dot,))]
        found, _ = carried({**UPRIGHT, **start}, pieces, [0.0, AFTER])
        within({name: abs(found[name][-1] - value) for name, value in want.items()}, 2e-5, "apart, SI")
        return

    def error(ramp: float) -> float:
        found = after_jump(library, jump, formulation, ramp)
        return max(abs(found[name] - value) for name, value in want.items())

    errors = [error(ramp) for ramp in (1e-4, 1e-5, 1e-6)]
    within(errors[-1], 1e-5, "rates and speeds apart after the shortest ramp, SI")
    within(max(errors[1] / errors[0], errors[2] / errors[1]), 0.2, "errors of ten times shorter ramps")


@pytest.mark.parametrize(("s", "M_brake"), [(0.004, 200.0), (0.03, 0.0)], ids=["by its brake", "by rolling resistance"])
@pytest.mark.parametrize("width", [0.0, 1e-6], ids=["exact", "narrow"])
def test_a_held_wheel_stays_held_while_its_carrier_swings(
    library: Library, formulation: int, s: float, M_brake: float, width: float
) -> None:
    """As over ramps: the outputs read after each jump show no spin, or a creep below the width of a narrow law, and a
    moment far below the capacity."""
    lean = {"guided": True, "theta_start": CAMBER, "phi_dot_start": 0.0, "formulation": formulation}
    lean |= {"friction_law": 2, "omega_s": width} if width else {}
    capacity = s * M * G + M_brake
    for part, check in ((1.0, within), (0.001, beyond)):
        w, spins, taus = library.wheel().start(**lean, s=part * s).put(M_brake=part * M_brake), [], []
        for i in range(100):
            w.by(0.004).put(psi_dot_guide=0.02 * sin(0.3 * i), theta_dot_guide=0.02 * cos(0.3 * i))
            omega_z, tau = w.get("omega_z", "tau")
            spins.append(abs(omega_z))
            taus.append(abs(tau))
        check(max(spins), max(width, 1e-15), "largest spin after a jump, rad/s")
        if part == 1:
            within(max(taus), 0.1 * capacity, "largest moment about the axle, N m")


@pytest.mark.parametrize("M_brake", [200.0, 50.0])
def test_a_jump_that_relieves_the_ground_takes_nothing_from_the_brake_that_holds_the_wheel(library, M_brake) -> None:
    """Over a millisecond 50 N m take up 0.05 N m s, which is more than the jump gives the wheel."""
    lean = {"guided": True, "theta_start": 1.2, "phi_dot_start": 0.0, "s": 0.1}
    spins = []
    for brake in (M_brake, 2.0):
        w = library.wheel().start(**lean).put(M_brake=brake).by(0.004)
        spins += w.put(psi_dot_guide=0.2, theta_dot_guide=-3.0).get("omega_z")
    assert spins[0] == 0.0
    beyond(spins[1], 5e-3, "spin after the same jump under a brake of 2 N m, rad/s")


@pytest.mark.parametrize(("theta", "psi_dot", "theta_dot"), [(pi / 2, 0.8, 0.5), (1.1, 0.8, 0.0), (2.1, -0.8, 0.0)])
def test_a_jump_that_presses_nothing_on_the_ground_turns_the_contact_of_a_wheel_that_slides_about_its_center(
    library: Library, theta: float, psi_dot: float, theta_dot: float
) -> None:
    """Without friction in the jump v_O stays; the contact lies R below O, and r cos(theta) along the axle."""
    slides = {"mu_max": 0.3, "mu_slide": 0.25, "slip_x_start": 3.0, "slip_y_start": -1.0}
    w = library.wheel().start(**{**UPRIGHT, **slides, "guided": True, "theta_start": theta})
    speeds = ("slip_x", "slip_y", "X_O_dot", "Y_O_dot")
    before = np.array(w.get(*speeds))
    after = w.put(psi_dot_guide=psi_dot, theta_dot_guide=theta_dot).get(*speeds)
    turned = [-TUBE * cos(theta) * psi_dot * sin(theta), (R_0 * sin(theta) + TUBE) * theta_dot, 0, 0]
    within(np.abs(after - before - turned).max(), 1e-14, "speeds apart, m/s")
    beyond(np.abs(turned).max(), 1e-2, "change of the slip, m/s")


@pytest.mark.parametrize("slip", [1.0, -1.0])
def test_friction_of_a_jump_stops_the_spin_of_a_wheel_that_slides_to_the_bit_or_leaves_its_side(library, slip) -> None:
    """Across its heading, so that the road hardly turns it: the pressure of the swing takes some 0.07 rad/s."""
    lean = {"guided": True, "theta_start": 1.2, "s": 0.03, "mu_max": 0.3, "mu_slide": 0.25, "slip_y_start": slip}
    for spin, mode in ((-0.01, 0), (0.02, 0), (-0.1, -1)):
        w = library.wheel().start(**lean, phi_dot_start=spin).put(theta_dot_guide=2.0)
        omega_z, *modes = w.get("omega_z", "friction_mode", "contact_mode")
        assert modes == [mode, 1] and (omega_z == 0.0) == (mode == 0)


def test_a_jump_lets_go_of_a_wheel_that_slides_once_the_road_turns_it_more_than_its_brake_can_hold(library) -> None:
    """It slips across its heading at first, where the road does not turn it, and is steered: the later, the less."""
    lean = {"guided": True, "psi_start": 0.0, "theta_start": 0.9, "phi_dot_start": 0.0, "keep_contact": True}
    lean |= {"r": 0.2, "mu_max": 0.5, "mu_slide": 0.4, "slip_y_start": 2.0}
    spins = []
    for brake in (0.0, 30.0, 60.0, 300.0):
        w = library.wheel().start(**lean).put(M_brake=brake)
        spins += w.put(psi_dot_guide=3.0, theta_dot_guide=1.0).get("omega_z")
    assert spins[0] > spins[1] > spins[2] > spins[3] == 0.0


def test_rates_that_are_held_never_break_the_grip_and_their_derivatives_do(library: Library) -> None:
    """Leaned by 20 rad/s2, which needs a friction coefficient of 0.7, in steps of 0.1 to 10 ms."""
    for h in (1e-4, 1e-3, 1e-2):
        for order, slides in ((0, 0), (1, 1)):
            w = library.wheel().start(**UPRIGHT | {"guided": True, "mu_max": 0.3, "mu_slide": 0.25})
            for k in range(round(0.05 / h)):
                w.give({"theta_dot_guide": (20 * k * h, 20.0)[: 1 + order]}).by(h)
                assert w.get("contact_mode") == [slides], (h, order, k)
            beyond(w.get("theta_dot")[0], 0.7, "rate reached, rad/s")


@pytest.mark.parametrize("order", [0, 1])
def test_a_course_in_steps_comes_near_to_the_whole_with_its_order(library: Library, order: int) -> None:
    """Held at the rate that leads to the heading asked for next, or with its first derivative."""
    start = {**ROUGH, "s": 0.02}
    whole = driven(library, [Piece(0.0, 1.0, STEER, LEAN, BRAKED)], [0.0, 1.0], **start)

    def rate(row: Sequence[float], t: float) -> float:
        return float(np.polynomial.polynomial.polyval(t, row))

    def piece(t: float, h: float) -> Piece:
        loads = {name: shifted(row, t)[: 1 + order] for name, row in BRAKED.items()}
        if order:
            return Piece(t, t + h, shifted(STEER, t)[:2], shifted(LEAN, t)[:2], loads)
        angles = [np.polynomial.polynomial.polyint(row) for row in (STEER, LEAN)]
        psi, theta = ((rate(row, t + h) - rate(row, t)) / h for row in angles)
        return Piece(t, t + h, (psi,), (theta,), loads)

    def errors(count: int) -> list[float]:
        h = 1 / count
        run = driven(library, [piece(k * h, h) for k in range(count)], [0.0, 1.0], **start)
        return [abs(run[name][-1] - whole[name][-1]) for name in ("psi", "omega_z", "X_O", "Y_O")]

    coarse, fine = errors(100), errors(200)
    orders = [np.log2(a / b) for a, b in zip(coarse, fine, strict=True) if b > 1e-11]
    within(max(abs(found - (1 + order)) for found in orders), 0.25, f"order less {1 + order}")
    within(max(fine), 0.05 if order == 0 else 1e-4, "apart at 200 steps, SI")
    assert order or fine[0] < 1e-11  # the heading is met exactly


# What is passed at t, as (value, slope), from the heading, its rate and the rate's slope, psi and the step; the orders
# of the heading, None where it is exact, of the path and of lambda_y.
PASSED: dict[str, tuple[Callable[[float, float, float], tuple[float, float]], tuple[int | None, int, int]]] = {
    "the next heading": (lambda t, psi, h: ((heading(t + h) - psi) / h, 0.0), (None, 2, 1)),
    "middle": (lambda t, _psi, h: (heading(t + h / 2, 1), 0.0), (2, 2, 1)),
    "with its slope": (lambda t, _psi, _h: (heading(t, 1), heading(t, 2)), (2, 2, 2)),
    "held": (lambda t, _psi, _h: (heading(t, 1), 0.0), (1, 1, 1)),
}


def heading(t: float, order: int = 0) -> float:
    return [0.3 * sin(2 * t) + 0.05 * t, 0.6 * cos(2 * t) + 0.05, -1.2 * sin(2 * t)][order]


@pytest.mark.parametrize("way", PASSED)
def test_a_heading_is_held_without_drift_by_the_rate_that_leads_to_the_next(library: Library, way: str) -> None:
    passed, orders = PASSED[way]
    times = np.linspace(0, 1, 2001)
    path = [simpson(V * np.array([f(heading(t)) for t in times]), x=times) for f in (cos, sin)]

    def errors(h: float) -> tuple[float, float, float]:
        with library.wheel() as w:
            w.start(**ROLLS, tolerance=1e-12)
            off = 0.0
            for k in range(round(1 / h)):
                value, slope = passed(k * h, w.get("psi")[0], h)
                w.give({"psi_dot_guide": (value, slope)}).to((k + 1) * h)
                off = max(off, abs(w.get("psi")[0] - heading((k + 1) * h)))
            X, Y, left = w.get("X_O", "Y_O", "lambda_y")
        return off, float(np.hypot(X - path[0], Y - path[1])), abs(left - M * V * heading(1.0, 1))

    coarse, fine = errors(0.02), errors(0.01)
    for a, b, order in zip(coarse, fine, orders, strict=True):
        if order is None:
            within(b, 1e-14, "heading, rad")
        else:
            within(abs(np.log2(a / b) - order), 0.1, f"order less {order}")
            beyond(b, 1e-6, "error, SI")


# ---- the limit that it is, and model exchange ----


def test_infinite_inertia_across_the_axle_is_its_limit(library: Library) -> None:
    times, load = np.linspace(0, 1, 11), {"M_3": -6.0, "F_Y": 20.0, "F_Z": -40.0}
    names = ("X_O", "Y_O", "omega_z", "lambda_x", "lambda_y", "lambda_3", "slip_x", "slip_y")
    road = {"mu_max": 0.3, "mu_slide": 0.25, "slip_x_start": 2.0, "slip_y_start": 0.5, "theta_start": CAMBER}
    want = guided(library, times, load, **road)

    def error(times_J: float) -> float:
        heavy = dict.fromkeys(("J_x", "J_y"), 0.9 * times_J)
        free = guided(library, times, load, **road, **heavy, **FREE)
        return max(absolute_error(free[name], want[name]) for name in names)

    errors = [error(times_J) for times_J in (1e4, 1e5, 1e6)]
    within(errors[-1], 1e-3, "outputs of a million J_x, SI")
    within(abs(np.log10(errors[-2] / errors[-1]) - 1), 2e-3, "order of convergence less 1")
    beyond(error(1), 1.0, "outputs of the usual J_x, SI")


def test_a_solver_of_another_tool_moves_the_same_eight_states(library: Library) -> None:
    start = {**UPRIGHT, "theta_start": CAMBER, "phi_dot_start": -10.0, "guided": True, "F_X": 3.0, "F_Y": 20.0}
    wheel = exchange(library, **start)

    def rate(t: float, x: np.ndarray) -> np.ndarray:
        wheel.place(t, x)
        return wheel.derivatives()

    done = solve_ivp(rate, (0, 1), wheel.x(), "DOP853", rtol=1e-11, atol=1e-11)
    run = guided(library, [0.0, 1.0], {"F_X": 3.0, "F_Y": 20.0}, theta_start=CAMBER, phi_dot_start=-10.0)
    within(absolute_error(done.y[:, -1], [run[name][-1] for name in STATES]), 64 * 10 * EPSILON, "states, SI")
    assert [bool(np.ptp(row)) for row in done.y] == [name in ("X_O", "phi", "omega_z") for name in STATES]
    wheel.place(1.0, done.y[:, -1])
    want = [run[name][-1] for name in ("M_guide_1", "M_guide_2")]
    within(absolute_error(wheel.get("M_guide_1", "M_guide_2"), want), 64 * 10 * EPSILON, "carrier's moment, N m")
