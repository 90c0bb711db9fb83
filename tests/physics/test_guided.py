"""A wheel on its carrier (`guided`): closed forms, springs and inertias that rise towards it, power, formulations.

Along e1, with rho = r_0 + r sin(theta) and I = J_z + m rho^2: v = -rho omega_z, I omega_z' = M_3 + tau - rho F_1;
N = m g - F_Z. SI units.
"""

from math import atan, cos, pi, radians, sin, tan

import numpy as np
import pytest
from scipy.integrate import simpson, solve_ivp
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import ERROR, OK, STATES
from wheelfmu.truth.exchange import exchange
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.motion import run as attempt
from wheelfmu.truth.reference import Wheel
from wheelfmu.truth.scenes import GENERAL
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import LOCK, SLIDES, UPRIGHT, stopping

M, R_0, TUBE, J_Z, G = 20.0, 0.3, 0.05, 1.8, 9.81
CAMBER = radians(80)
FREE, STOPPED = {"guided": False}, {"phi_dot_start": 0.0}
formulations = pytest.mark.parametrize("formulation", [2, 3], ids=["reduced", "multibody"])
tilts = pytest.mark.parametrize("theta", [pi / 2, CAMBER, 2.3])


def rho(theta: float) -> float:
    return R_0 + TUBE * sin(theta)


def inertia(theta: float) -> float:
    return J_Z + M * rho(theta) ** 2


def guided(library: Library, times, inputs: dict | None = None, tolerance: float = 1e-10, **start) -> Run:
    """Heading along X, upright unless said."""
    load = Schedule(((0.0, inputs),)) if inputs else None
    return library.simulate(times, tolerance, load, **{**UPRIGHT, "guided": True, **start})


# ---- rolling ----


@pytest.mark.parametrize("spin", [10.0, 100.0, 500.0])
def test_a_fast_spin_costs_the_multibody_form_no_more_steps(library: Library, spin: float) -> None:
    """The motion is no faster, and neither are the constraints."""
    runs = [guided(library, [0, 2], None, 1e-8, s=0.003, phi_dot_start=-spin, method=4, formulation=f) for f in (2, 3)]
    costs = [run.counters["n_rhs"] for run in runs]
    within(costs[1] / costs[0], 1.5, "evaluations over those of the reduced form")
    within(abs(runs[1]["X_O"][-1] / runs[0]["X_O"][-1] - 1), 1e-11, "way of the formulations apart, relative")


@formulations
@tilts
def test_friction_and_brake_together_stop_it_and_hold_it(library: Library, formulation: int, theta: float) -> None:
    s, brake, spin = 0.02, 10.0, -8.0
    slowing = (s * M * G + brake) / inertia(theta)
    stop, way = -spin / slowing, rho(theta) * spin**2 / (2 * slowing)

    def error(judged: float) -> float:
        start = {"theta_start": theta, "phi_dot_start": spin, "s": s * judged, "formulation": formulation}
        run = guided(library, [0.0, stop / 2, stop + 1, stop + 60], {"M_brake": brake}, **start)
        assert not run["omega_z"][2:].any()
        return absolute_error([*run["omega_z"][1:2], *run["X_O"][2:]], [spin / 2, way, way])

    within(error(1.0), 1024 * 8 * EPSILON, "spin half-way, rad/s, and way, m")
    beyond(error(1.0001), 1e-5, "spin and way with 0.01 % more friction")


@formulations
@tilts
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


def test_it_leans_at_rest_on_the_moment_of_its_weight(library: Library) -> None:
    run = guided(library, [0.0, 60.0], theta_start=CAMBER, **STOPPED)
    within(absolute_error(run["M_guide_1"], M * G * R_0 * cos(CAMBER)), 64 * 10 * EPSILON, "M_guide_1, N m")
    assert not run["M_guide_2"].any() and not run["omega_z"].any()
    free = library.simulate([0.0, 0.5], theta_start=CAMBER, **STOPPED)
    assert not free["M_guide_1"].any() and not free["M_guide_2"].any()
    beyond(absolute_error(free["theta"], CAMBER), 0.1, "tilt of the wheel that is not guided, rad")


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


# ---- sliding ----


@formulations
def test_locked_it_stops_after_v_squared_over_2_mu_g_and_stands_for_ever(library: Library, formulation: int) -> None:
    t, way = stopping(Wheel(), 0.4, 7.0)
    times = [0.0, t / 2, t - 1e-7, t + 1e-7, t + 60]
    road = {"mu_max": 0.45, "mu_slide": 0.4, "slip_x_start": 7.0, "formulation": formulation, **STOPPED}
    run = guided(library, times, {"M_brake": 1e3}, 1e-11, **road)
    assert run["contact_mode"].tolist() == [1, 1, 1, 0, 0]
    within(absolute_error(run["X_O"][[1, 4]], [0.75 * way, way]), 1e-11, "way, m")
    still = ("X_O_dot", "Y_O_dot", "omega_z", "theta_dot", "psi_dot", "slip_x", "slip_y")
    assert all(run[name][4] == 0 for name in still) and not run["psi"].any() and not np.ptp(run["theta"])
    free = library.simulate([0.0, t + 2], 1e-11, LOCK, **{**UPRIGHT, **road, "theta_start": pi / 2 + 1e-3})
    beyond(absolute_error(free["theta"], pi / 2), 0.1, "tilt of the wheel that is not guided, rad")


@tilts
def test_thrown_with_backspin_it_slides_grips_and_comes_back(library: Library, theta: float) -> None:
    mu, v, spin, R = 0.3, 2.0, 10.0, rho(theta)
    slip = v + R * spin
    t = slip / (mu * G * (1 + M * R**2 / J_Z))
    v_grip = v - mu * G * t

    def error(judged: float) -> float:
        start = {"theta_start": theta, "phi_dot_start": spin, "slip_x_start": slip}
        run = guided(library, [0.0, t / 2, t + 1], **start, mu_max=judged, mu_slide=judged)
        way = v * t - mu * G * t**2 / 2
        return absolute_error([run["X_O"][-1] - way - v_grip, run["X_O_dot"][-1]], [0.0, v_grip])

    within(error(mu), 1e-11, "way, m, and velocity, m/s")
    beyond(error(mu * 1.001), 1e-5, "way and velocity with a coefficient 0.1 % larger")


@tilts
def test_a_slip_across_the_heading_ends_in_a_straight_line(library: Library, theta: float) -> None:
    """Friction across the heading turns nothing."""
    times = np.linspace(0, 1, 11)
    road = {"theta_start": theta, "mu_max": 0.4, "mu_slide": 0.4, "slip_y_start": 2.0, **STOPPED}
    run = guided(library, times, **road)
    within(absolute_error(run["Y_O"], 2.0 * np.minimum(times, 2 / 3.924) - 1.962 * np.minimum(times, 2 / 3.924) ** 2),
           4096 * EPSILON, "way, m")  # fmt: skip
    within(absolute_error(run["slip_x"], 0.0), 2 * EPSILON, "slip along the heading, m/s")  # cos(90 deg)
    assert not run["psi_dot"].any() and not run["theta_dot"].any()


@tilts
@pytest.mark.parametrize("share", [0.999, 1.001])
def test_on_a_hill_it_rolls_up_to_a_slope_and_slides_above(library: Library, theta: float, share: float) -> None:
    mu, R = 0.3, rho(theta)
    limit = atan(mu * (1 + M * R**2 / J_Z))
    slope = limit * share
    rolling, sliding = G * sin(slope) / (1 + J_Z / (M * R**2)), G * cos(slope) * (tan(slope) - mu)
    a, spin = (rolling, rolling / R) if share < 1 else (sliding, mu * M * G * cos(slope) * R / J_Z)
    road = {"slope": slope, "slope_direction": 0.7 + pi, "psi_start": 0.7, "mu_max": mu, "mu_slide": mu}
    run = guided(library, [0.0, 0.5, 1.0], theta_start=theta, **road, **STOPPED)
    assert run["contact_mode"].tolist() == [int(share > 1)] * 3
    down = run["X_O"] * cos(0.7) + run["Y_O"] * sin(0.7)
    bound = 1e-11 if share > 1 else 1024 * EPSILON
    within(absolute_error(down, a / 2 * run.t**2), bound, "way, m")
    within(absolute_error(run["omega_z"], -spin * run.t), bound, "spin, rad/s")
    beyond(abs(rolling - sliding), 1e-3, "difference of the accelerations, m/s2")


@pytest.mark.parametrize("excess", [0.9999, 1.5])
def test_a_motor_spins_it_only_beyond_the_torque_that_the_road_holds(library: Library, excess: float) -> None:
    mu_max, mu, R = 0.45, 0.4, R_0 + TUBE
    torque = excess * mu_max * G * inertia(pi / 2) / R
    a = mu * G if excess > 1 else R * torque / inertia(pi / 2)
    spin = (torque - mu * M * G * R) / J_Z if excess > 1 else a / R
    run = guided(library, [0.0, 1.0], {"M_3": -torque}, mu_max=mu_max, mu_slide=mu, **STOPPED)
    bound = 3e-11 if excess > 1 else 1024 * EPSILON
    within(absolute_error([run["X_O_dot"][-1], run["omega_z"][-1]], [a, -spin]), bound, "speed, m/s, and spin, rad/s")


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


# ---- the limits that it is ----


def rising(errors: list[float], factor: float) -> float:
    """The order of convergence between the last two of errors whose parameter rises by the factor."""
    return float(np.log(errors[-2] / errors[-1]) / np.log(factor))


DRIVE = {"M_3": -6.0, "F_Y": 20.0, "F_Z": -40.0}


def test_infinite_inertia_across_the_axle_is_its_limit(library: Library) -> None:
    times = np.linspace(0, 1, 11)
    names = ("X_O", "Y_O", "omega_z", "lambda_x", "lambda_y", "lambda_3", "slip_x", "slip_y")
    road = {"mu_max": 0.3, "mu_slide": 0.25, "slip_x_start": 2.0, "slip_y_start": 0.5, "theta_start": CAMBER}
    want = guided(library, times, DRIVE, **road)

    def error(times_J: float) -> float:
        heavy = dict.fromkeys(("J_x", "J_y"), 0.9 * times_J)
        free = guided(library, times, DRIVE, **road, **heavy, **FREE)
        return max(absolute_error(free[name], want[name]) for name in names)

    errors = [error(times_J) for times_J in (1e4, 1e5, 1e6)]
    within(errors[-1], 1e-3, "outputs of a million J_x, SI")
    within(abs(rising(errors, 10) - 1), 2e-3, "order of convergence less 1")
    beyond(error(1), 1.0, "outputs of the usual J_x, SI")


def sprung(library: Library, stiffness: float) -> np.ndarray:
    """X_O, omega_z and the springs' moments after 1 s of the free wheel held by damped springs on lean and yaw."""
    wheel = exchange(library, **{**UPRIGHT, "theta_start": CAMBER, "phi_dot_start": -10.0}, **DRIVE)
    index = {name: k for k, name in enumerate(STATES)}

    def moments(x: np.ndarray) -> tuple[float, float]:
        damping = 2 * stiffness**0.5
        lean, yaw = x[index["theta"]] - CAMBER, x[index["psi"]]
        M_1 = -stiffness * lean - damping * x[index["theta_dot"]]
        return M_1, -stiffness * yaw - damping * x[index["psi_dot"]]

    def rate(t: float, x: np.ndarray) -> np.ndarray:
        assert wheel.set(**dict(zip(("M_1", "M_2"), moments(x), strict=True))) == OK
        wheel.place(t, x)
        return wheel.derivatives()

    done = solve_ivp(rate, (0, 1), wheel.x(), "LSODA", rtol=1e-9, atol=1e-12)
    x = done.y[:, -1]
    return np.array([x[index["X_O"]], x[index["omega_z"]], *moments(x)])


def test_springs_on_lean_and_yaw_lead_to_it_as_they_stiffen(library: Library) -> None:
    names = ("X_O", "omega_z", "M_guide_1", "M_guide_2")
    run = guided(library, [0.0, 1.0], DRIVE, theta_start=CAMBER, phi_dot_start=-10.0)
    want = np.array([run[name][-1] for name in names])
    errors = [np.abs(sprung(library, stiffness) - want) for stiffness in (1e4, 1e5, 1e6)]
    for k, name in enumerate(names):
        within(abs(rising([error[k] for error in errors], 10) - 1), 0.2, f"order of {name} less 1")
    within(float(errors[-1].max()), 1e-2, "way, m, spin, rad/s, and moments at 1e6 N m/rad, N m")


# ---- power, rates, the other formulation, model exchange ----

PUSH = {"F_X": (3.0, 2.0), "F_Y": (-20.0, 30.0), "F_Z": (-40.0, 15.0), "M_1": (1.0, -2.0), "M_2": (0.3, 1.0)}
PUSH |= {"M_3": (-9.0, 4.0), "M_brake": (2.0, 1.0)}
ROUGH = {"theta_start": CAMBER, "psi_start": 0.4, "phi_dot_start": -6.0, "s": 0.01, **GENERAL}
ROUGH |= {"slope": 0.2, "slope_direction": 1.1}
SLIPPERY = {"mu_max": 0.2, "mu_slide": 0.15, "slip_x_start": 3.0, "slip_y_start": -2.0}
SURFACES = {"grips": ROUGH, "slides": ROUGH | SLIPPERY, "regularized": ROUGH | {"friction_law": 2, "omega_s": 0.5}}
surfaces = pytest.mark.parametrize("start", SURFACES.values(), ids=SURFACES)


@surfaces
def test_the_power_of_loads_slip_and_friction_changes_its_energy(library: Library, start: dict) -> None:
    """The carrier's is zero, and so is that of M_1 and M_2."""
    times = np.linspace(0, 0.4, 401)
    run = guided(library, times, PUSH, **start)
    force = {name: a + b * times for name, (a, b) in PUSH.items()}
    assert len(set(run["contact_mode"])) == 1

    def error(slips: float) -> float:
        power = force["F_X"] * run["X_O_dot"] + force["F_Y"] * run["Y_O_dot"] + force["M_3"] * run["omega_z"]
        power += run["tau"] * run["omega_z"]
        power += slips * (run["lambda_x"] * run["slip_x"] + run["lambda_y"] * run["slip_y"])
        return abs(float(simpson(power, x=times)) - (run["E"][-1] - run["E"][0]))

    within(error(1), 1e-8, "energy off the work, J")
    if "mu_max" in start:
        beyond(error(0), 1.0, "energy off the work without the slip's, J")


@surfaces
def test_the_rates_of_the_carriers_moment_are_those_of_its_course(library: Library, start: dict) -> None:
    h, names = 1e-4, ("M_guide_1", "M_guide_2")
    inputs = Schedule(((0.0, PUSH),))
    values = {**UPRIGHT, "guided": True, **start}
    run = attempt(library, values, [0.0, 0.2 - 2 * h, 0.2 - h, 0.2, 0.2 + h, 0.2 + 2 * h], 1e-12, inputs, names)
    for name in names:
        before_2, before, _, after, after_2 = run[name][1:]
        course = (8 * (after - before) - (after_2 - before_2)) / (12 * h)
        within(abs(run[f"{name}_dot"][3] - course), 1e-9, f"rate of {name}, N m/s")
        beyond(abs(course), 0.1, f"rate of {name} at all, N m/s")


@surfaces
def test_the_carriers_moment_answers_each_load_as_equilibrium_asks(library: Library, start: dict) -> None:
    """By a moment across the axle: its negative; by another load: the finite change of what is read."""
    loads = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3")
    with library.wheel() as w:
        w.start(tolerance=1e-10, **{**UPRIGHT, "guided": True, **start}, M_3=-2.0)
        slopes = w.jacobian(("M_guide_1", "M_guide_2"), loads)
        within(absolute_error(slopes[:, 3:5], -np.eye(2)), 64 * EPSILON, "derivative by M_1, M_2 off -1")
        before = np.array(w.get("M_guide_1", "M_guide_2"))
        for k, load in enumerate(loads):
            value = w.get(load)[0]
            assert w.set(**{load: value + 1.0}) == OK
            change = np.array(w.get("M_guide_1", "M_guide_2")) - before
            within(absolute_error(change, slopes[:, k]), 64 * 60 * EPSILON, f"moments by {load}, N m")
            assert w.set(**{load: value}) == OK
        at_start = library.wheel().initializing(**{**UPRIGHT, "guided": True, **start})
        assert not at_start.jacobian(("M_guide_1", "X_O_dot"), ("theta_dot_start", "psi_dot_start")).any()


@surfaces
def test_the_papers_system_with_two_constraints_more_agrees(library: Library, start: dict) -> None:
    times = np.linspace(0, 2, 41)
    names = ("X_O", "Y_O", "phi", "omega_z", "lambda_1", "lambda_2", "lambda_3", "tau", "M_guide_1", "M_guide_2")
    a, b, off = (
        guided(library, times, PUSH, 1e-11, **{**start, **change})
        for change in ({"formulation": 2}, {"formulation": 3}, {"J_z": 1.801})
    )
    bound = 1e-9 if start is SURFACES["slides"] else 64 * 200 * EPSILON  # N
    within({name: absolute_error(a[name], b[name]) for name in names}, bound, "formulations apart, SI")
    assert not b["theta_dot"].any() and not b["psi_dot"].any() and not np.ptp(b["psi"])
    beyond(absolute_error(off["omega_z"], a["omega_z"]), 1e-4, "omega_z with another J_z, rad/s")


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


@pytest.mark.parametrize("name", ["theta_dot_start", "psi_dot_start"])
def test_a_guided_wheel_whose_axle_turns_at_the_start_is_rejected(library: Library, name: str) -> None:
    done = attempt(library, {"guided": True, name: 0.1}, [0.0, 1.0])
    assert done.status == ERROR and done.messages[0].endswith("rad/s: a guided wheel needs 0 for both.")
