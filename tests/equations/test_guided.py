"""The equations on a wheel carrier against the paper's system (24) with the carrier's two moments as unknowns.

Random wheels whose axle turns as prescribed, under loads and each law; frames of wheel_equations.h.
"""

from ctypes import byref, c_double

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.bounds import absolute_error, beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.paper_transcription import Carried, dynamics_of, set_rolling, solved
from wheelfmu.truth.pointwise import ACCELERATIONS, Table, draw

FORMS, SLIDES = (eq.REDUCED, eq.MULTIBODY), (eq.SLIDING, eq.MULTIBODY_SLIDING)
BOUND = 1e-10


def guided(seed: int, law: int, rows: int = 3000) -> tuple[Table, Table]:
    """Scenes and motions."""
    scenes, motions = draw(seed, law, symmetric=False, rows=rows)
    random = np.random.default_rng(seed)
    still = random.random(rows) < 0.2
    motions["psi_dot"][still] = motions["theta_dot"][still] = 0
    if law == eq.HELD:
        motions["phi_dot"] = -motions["psi_dot"] * np.cos(motions["theta"])
    scenes["load"]["guide"] = np.where(still[:, None], 0, random.normal(0, 5, (rows, 2)))
    scenes["mu_slide"], scenes["contact"] = random.uniform(0, 1.2, rows), 1
    scenes["guided"] = 1
    for axis in ("slip_x", "slip_y"):
        motions[axis] = random.normal(size=rows)
    return scenes, motions


def transcribed(scenes: Table, motions: Table, slides: bool) -> tuple[Table, Table]:
    """WheelDynamics, and the carrier's moments about e1 and e2."""
    paper = Carried(scenes["wheel"], set_rolling(scenes["wheel"], motions))
    paper.turn = scenes["load"]["guide"]
    if slides:
        theta, theta_dot, theta_ddot = motions["theta"], motions["theta_dot"], scenes["load"]["guide"][:, 1]
        rise = scenes["wheel"]["r_0"] * (np.cos(theta) * theta_ddot - np.sin(theta) * theta_dot**2)
        N = scenes["wheel"]["m"] * (scenes["wheel"]["g_n"] + rise) - scenes["load"]["F"][:, 2]
        mu = np.where(N > 0, scenes["mu_slide"], 0)
        paper.slip_of = mu, motions["psi"] + np.arctan2(motions["slip_y"], motions["slip_x"])
    x = solved(paper, scenes)
    return dynamics_of(paper, x, scenes), x[:, 9:11]


def apart(found: Table, want: Table, scenes: Table) -> float:
    """Largest error over the rows, as a force over those that act: of a wheel that is held all else is zero."""
    wheel, load = scenes["wheel"], scenes["load"]
    size = wheel["m"] * 9.81 + np.abs(load["F"]).max(axis=1) + np.abs(load["M"]).max(axis=1) / wheel["r_0"]
    as_force = dict.fromkeys(ACCELERATIONS[:3], wheel["m"])
    as_force |= dict.fromkeys(("psi_ddot", "theta_ddot", "phi_ddot", "omega_z_dot"), wheel["J_z"] / wheel["r_0"])
    as_force |= {"lambda_": np.ones_like(size), "tau": 1 / wheel["r_0"]}
    errors = [np.abs(found[name] - want[name]).T * factor for name, factor in as_force.items()]
    return max(float((error / size).max()) for error in errors)


def moments(scenes: Table, k: Table, found: Table) -> Table:
    """wheel_guide_moment row by row."""
    out = np.zeros((len(k), 2))
    for row, *records in zip(out, scenes, k, found, strict=True):
        kinds = zip((eq.Scene, eq.Kinematics, eq.Dynamics), records, strict=True)
        scene, place, answer = (kind.from_buffer_copy(record) for kind, record in kinds)
        eq.LIBRARY.wheel_guide_moment(byref(scene), byref(place), byref(answer), row.ctypes.data_as(eq.DOUBLES))
    return out


@pytest.mark.parametrize("slides", [False, True], ids=["grips", "slides"])
def test_accelerations_reactions_and_the_carriers_moments_are_those_of_24(law: int, slides: bool) -> None:
    scenes, motions = guided(12, law)
    want, carried = transcribed(scenes, motions, slides)
    pulls = want["lambda_"][:, 2] <= 0
    within(abs(pulls.mean() - 0.37), 0.1, "share of wheels that the ground pulls, less 0.37")
    arm = scenes["wheel"]["r_0"] * (np.abs(want["lambda_"]).max(axis=1) + scenes["wheel"]["m"] * 9.81)
    for form in SLIDES if slides else FORMS:
        y = eq.start_each(form, scenes, motions)
        found = eq.dynamics_each(form, scenes, y)
        within(apart(found, want, scenes), BOUND, "distance")
        held = moments(scenes, eq.kinematics_each(form, scenes, y), found)
        within(float((np.abs(held - carried).max(axis=1) / arm).max()), BOUND, "moment over r_0 times the force")
        y_dot, normal = eq.derivative_each(form, scenes, y)
        answer = found.copy()
        answer["lambda_"][:, 2], answer["omega_z_dot"] = normal, y_dot[:, eq.OMEGA_3]
        within(apart(answer, want, scenes), BOUND, "derivative")
        wrong = scenes.copy()
        wrong["wheel"]["J_z"] *= 1 + 1e-7
        wrong["mu_slide"] *= 1 + 1e-7
        other = apart(eq.dynamics_each(form, wrong, y), want, scenes)
        if law != eq.HELD or slides:
            beyond(other, 1e-9, "distance with another inertia and coefficient")


def jump(scene: eq.Scene, psi_dot: float, theta_dot: float, motion: eq.Motion, hold: float = 0.0) -> None:
    eq.LIBRARY.wheel_jump(byref(scene), c_double(hold), c_double(psi_dot), c_double(theta_dot), byref(motion))


def ramp_followed(scene: eq.Scene, before: eq.Motion, psi_dot: float, theta_dot: float) -> list[float]:
    """Newton and Euler of a sliding wheel on a ramp so steep that nothing else counts: slip and omega_z behind it."""
    w, sine, cosine = scene.wheel, np.sin(before.theta), np.cos(before.theta)
    d_1, d_2 = theta_dot - before.theta_dot, (psi_dot - before.psi_dot) * sine
    rho, eta, N = w.r_0 + w.r * sine, w.r * cosine, w.m * w.r_0 * cosine * d_1
    spin = before.phi_dot + before.psi_dot * cosine

    def friction(y: np.ndarray) -> np.ndarray:
        return -scene.mu_slide * N * y[:2] / np.hypot(*y[:2])

    def rates(_: float, y: np.ndarray, side: float) -> list[float]:
        f_x, f_y = friction(y)
        omega_dot = (rho * f_x - w.s * N * side) / w.J_z if side else 0.0
        return [f_x / w.m - eta * d_2 + rho * omega_dot, f_y / w.m + (w.r_0 * sine + w.r) * d_1, omega_dot]

    def hold(_: float, y: np.ndarray, side: float) -> float:
        return 1.0 if side else w.s * N - abs(rho * friction(y)[0])

    hold.terminal = True
    part, y, side = 0.0, np.array([before.slip_x, before.slip_y, spin]), np.sign(spin)
    while part < 1:
        run = solve_ivp(rates, (part, 1), y, "DOP853", events=hold, args=(side,), rtol=1e-12, atol=1e-14)
        part, y = run.t[-1], run.y[:, -1]
        side = side or np.sign(friction(y)[0])
    return y.tolist()


@pytest.mark.parametrize("seed", range(40))
def test_a_jump_of_a_sliding_wheel_is_the_ramp_of_newton_and_euler(seed: int) -> None:
    """To twelve digits; pressed and relieved, while it spins and slides on, also on ice or without s."""
    random = np.random.default_rng(seed)
    scene = eq.scene(eq.paper_wheel(s=random.uniform(0, 0.03)), kind=eq.ROLLING, sigma=1)
    scene.guided, scene.contact, scene.mu_slide = 1, 1, random.uniform(0.1, 0.8)
    scene.mu_slide *= seed % 4 != 1
    scene.wheel.s *= seed % 4 != 2
    slip, theta = random.uniform(0.7, 2, 2) * random.choice([-1, 1], 2), random.uniform(0.9, 2.2)
    before = eq.Motion(0.3, theta, 0, *random.uniform(-0.3, 0.3, 2), random.uniform(12, 20), 0, 0, *slip)
    psi_dot, theta_dot = random.uniform(-0.8, 0.8, 2)
    after = eq.Motion.from_buffer_copy(before)
    jump(scene, psi_dot, theta_dot, after)
    want = ramp_followed(scene, before, psi_dot, theta_dot)
    found = [after.slip_x, after.slip_y, after.phi_dot + psi_dot * np.cos(theta)]
    within(absolute_error(found, want), 2e-11, "slip, m/s, and spin, rad/s, apart")
    scene.mu_slide, scene.wheel.s = 1.001 * scene.mu_slide, 1.001 * scene.wheel.s
    other = ramp_followed(scene, before, psi_dot, theta_dot)
    beyond(absolute_error(found, other), 1e-7, "with a thousandth more friction")


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_ramp_that_relieves_the_ground_gives_back_to_a_spin_until_it_stands_and_no_further(side: float) -> None:
    """Sliding so fast that the force keeps its direction, against the spin. Friction of the axle drives nothing."""
    scene = eq.scene(eq.paper_wheel(s=0.03), kind=eq.ROLLING, sigma=side)
    scene.guided, scene.contact, scene.mu_slide = 1, 1, 0.5
    w, theta, theta_dot, spin = scene.wheel, 1.2, -1.0, 0.05
    after = eq.Motion(0.3, theta, 0, 0, 0, side * spin, 0, 0, -side * 1e4, 0)
    jump(scene, 0.0, theta_dot, after)
    relief = -w.m * w.r_0 * np.cos(theta) * theta_dot
    driven, given = (w.r_0 + w.r * np.sin(theta)) * scene.mu_slide * relief / w.J_z, w.s * relief / w.J_z
    want = -(1 - spin / (driven - given)) * driven
    within(abs(side * after.phi_dot - want), 1e-6, "spin apart, rad/s")
    beyond(given * (1 - spin / driven), 0.01, "by the axle's friction, rad/s")


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_held_wheel_that_slides_is_released_within_a_jump_where_the_slip_has_turned_along_it(side: float) -> None:
    """Held as long as friction along the wheel turns it by less than s N: with ten times s, to the end."""
    for s, held in ((0.03, False), (0.3, True)):
        scene = eq.scene(eq.paper_wheel(s=s), kind=eq.HELD)
        scene.guided, scene.contact, scene.mu_slide = 1, 1, 0.4
        before = eq.Motion(0.3, 1.2, 0, 0, 0, 0, 0, 0, 0.02 * side, -0.6)
        after = eq.Motion.from_buffer_copy(before)
        jump(scene, 3.0 * side, 1.5, after)
        spin = after.phi_dot + 3.0 * side * np.cos(1.2)
        want = ramp_followed(scene, before, 3.0 * side, 1.5)
        within(absolute_error([after.slip_x, after.slip_y, spin], want), 2e-11, "slip, m/s, and spin, rad/s, apart")
        assert (spin == 0) == held


@pytest.mark.parametrize("slides", [0, 1], ids=["rolls", "slides"])
@pytest.mark.parametrize("theta_dot", [1.5, -1.0], ids=["pressed", "relieved"])
@pytest.mark.parametrize("phi_dot", [0.0, 0.02, -0.02, -8.0])
@pytest.mark.parametrize("theta", [1.2, 1.9])
def test_a_jump_under_a_narrow_law_is_that_under_the_exact_one(theta, phi_dot, theta_dot, slides) -> None:
    """Also where it releases a standing wheel, stops a spin or turns it round."""
    found = []
    for law in ({"kind": eq.ROLLING, "sigma": 1}, {"kind": eq.REGULARIZED, "omega_s": 1e-9}):
        scene = eq.scene(eq.paper_wheel(s=0.01), **law)
        scene.guided, scene.contact, scene.mu_slide = 1, slides, 0.4
        motion = eq.Motion(0.3, theta, 0, 0, 0, phi_dot, 0, 0, 0.5 * slides, -0.3 * slides)
        jump(scene, 0.5, theta_dot, motion)
        found.append([motion.phi_dot, motion.slip_x, motion.slip_y])
    within(absolute_error(*found), 3e-8, "apart, SI")
    beyond(abs(found[0][0] - phi_dot), 1e-3, "change of phi_dot by the jump, rad/s")


def braked_over_a_millisecond(free: float, hold: float, J: float, omega_s: float) -> float:
    """omega_z of a wheel that stood, behind a ramp of 1 ms that alone would turn it by `free`."""

    def rate(_: float, spin: np.ndarray) -> np.ndarray:
        return 1e3 * free - hold / J * np.tanh(spin / omega_s)

    return solve_ivp(rate, (0, 1e-3), [0.0], method="Radau", rtol=1e-9, atol=1e-9 * omega_s).y[0, -1]


@pytest.mark.parametrize("part", [0.9, 1.1], ids=["its brake holds", "its brake yields"])
def test_a_jump_of_a_standing_wheel_under_a_narrow_law_tends_to_that_of_a_held_one(part: float) -> None:
    """Where the brake would hold it over a ramp of 1 ms it stays. In a wide law no brake stops a spin so soon."""
    theta, psi_dot, wheel = 1.2, 0.02, eq.paper_wheel(s=0.0)
    J = wheel.J_z + wheel.m * (wheel.r_0 + wheel.r * np.sin(theta)) ** 2

    def turned(hold: float, **law: float) -> float:
        scene = eq.scene(eq.paper_wheel(s=0.0), brake=hold, **law)
        scene.guided = 1
        motion = eq.Motion(0.3, theta)
        jump(scene, psi_dot, 0.0, motion, hold)
        return motion.phi_dot + psi_dot * np.cos(theta)

    free = turned(0.0, kind=eq.ROLLING, sigma=1)
    hold = 1e3 * abs(free) * J / part
    exact = turned(hold, kind=eq.HELD)
    assert (exact == 0) == (part < 1)
    for omega_s in abs(free) * np.array([1e-3, 1e-6]):
        within(abs(turned(hold, kind=eq.REGULARIZED, omega_s=omega_s) - exact), 1e-15, "spin apart, rad/s")
        if part < 1:
            braked = braked_over_a_millisecond(free, hold, J, omega_s)
            within(abs(braked - exact), 2 * omega_s, "spin behind the ramp itself, rad/s")
    wide = turned(hold, kind=eq.REGULARIZED, omega_s=10 * abs(free))
    braked = braked_over_a_millisecond(free, hold, J, 10 * abs(free))
    within(abs(wide - braked) / abs(free), 0.1, "spin apart in a wide law, over that of the jump")
    beyond(abs(braked) / abs(free), 0.9, "spin behind the ramp in a wide law, over that of the jump")


@pytest.mark.parametrize("hold", [10.0, 1e5])
def test_a_jump_of_a_standing_wheel_that_slides_is_alike_in_a_narrow_law_and_held(hold: float) -> None:
    """Released by the friction of its slip, or not."""
    found = []
    for law in ({"kind": eq.HELD}, {"kind": eq.REGULARIZED, "omega_s": 1e-10}):
        scene = eq.scene(eq.paper_wheel(s=0.01), brake=hold, **law)
        scene.guided, scene.contact, scene.mu_slide = 1, 1, 0.4
        motion = eq.Motion(0.3, 1.2, 0, 0, 0, 0, 0, 0, 0.5, -0.3)
        jump(scene, 0.0, 1.5, motion, hold)
        found.append([motion.phi_dot, motion.slip_x, motion.slip_y])
    within(absolute_error(*found), 1e-8, "apart, SI")
    assert (abs(found[0][0]) > 1e-3) == (hold == 10.0)


@pytest.mark.parametrize("push", [0.0, 0.2, -0.2])
def test_a_slip_that_a_jump_stops_stays_stopped_where_friction_holds_it(push: float) -> None:
    scene = eq.scene(eq.paper_wheel(s=0.01), kind=eq.ROLLING, sigma=-1)
    scene.guided, scene.contact, scene.mu_slide = 1, 1, 6.0
    motion = eq.Motion(0, 1.2, 0, 0, 0, -8.0, 0, 0, 0.02, -0.3)
    jump(scene, push, 1.5, motion)
    assert (motion.slip_x, motion.slip_y) == (0, 0)
    motion.slip_y, scene.mu_slide = -0.3, 0.3
    jump(scene, push, 3.0, motion)
    beyond(motion.slip_y, 0.1, "slip with less friction, m/s")
